# Tests of the boards that are too long for `make test`, which runs a part of them.
#   make boards                 every scene on every board, in q16, q24, q32 and float: the desktop's bytes (7 minutes)
boards: build/qray
	@$(PYTHON) tests/firmware/test_scenes.py --all
.PHONY: boards
