# qray as a part of other projects; see README.md here.
#   make package                build/package: one header, for CMake, PlatformIO, ESP-IDF, Zephyr and Arduino
package: build/qray
	@$(PYTHON) src/package/package.py build/package
.PHONY: package
