# Measurements; see README.md here.
#   make report                 measure again what README.md's tables between markers say, and write them
STUDY := src/study

report: build/qray
	@$(PYTHON) $(STUDY)/report.py $(REPORT)
.PHONY: report
