# qray draws scenes with integer or floating arithmetic, on a desktop and without an operating system.
#   make                 build/qray, the command
#   make render          draw scenes/showcase.nff (or SCENE=...) into build/; needs only g++ and make
#   make deps            install the Debian packages that the tests need
#   make test            build and run every test; the last line counts them
#   make clean           remove build/
#   make help            this list
# Switches: NATIVE=1 for this very processor, LANES= without AVX2; CXX=clang++; STATIC= where there is no static C library.
# A folder's own .mk file below adds its commands, with a comment like these, and may add to:
#   TESTS       programs for `make test` to run, TEST_NEEDS  files that it builds before.

CXX      := $(if $(filter default,$(origin CXX)),g++,$(CXX))
OPTIMISE ?= -O2
STATIC   ?= -static
# Debian's own, which sees Debian's packages.
PYTHON   := $(or $(wildcard /usr/bin/python3),python3) -B
WARNINGS := -Wall -Wextra -Wconversion -Wsign-conversion -Wshadow -Wdouble-promotion -Werror
COMMON   := -std=c++20 $(WARNINGS) -ffp-contract=off -fno-math-errno -Iinclude -Isrc -MMD -MP
PROGRAM  := -fno-exceptions -fno-rtti
FLAGS     = $(COMMON) $(OPTIMISE) $(if $(NATIVE),-march=native -DQRAY_LANES=0)
SANITIZE := $(COMMON) -g1 -Wno-maybe-uninitialized -fsanitize=address,undefined -fno-sanitize-recover=all

all: build/qray
.DELETE_ON_ERROR .SUFFIXES:

# The command. Linked statically, it starts in 40 thousand instructions instead of two million.
LIBRARY := $(patsubst %.cpp,build/obj/%.o,$(wildcard src/scene/*.cpp))
LANED   := $(patsubst %.cpp,build/obj/%.o,$(wildcard src/cli/lanes_*.cpp))
PLAIN   := $(filter-out $(LANED),$(patsubst %.cpp,build/obj/%.o,$(wildcard src/cli/*.cpp))) $(LIBRARY)
# On x86-64, float and q32 also with vectors in AVX2's registers, taken where the processor has them. What headers define
# inline is compiled in two ways then, so all of it but the renderer is made local.
ifneq ($(filter x86_64-linux% x86_64-pc-linux%,$(shell $(CXX) -dumpmachine)),)
LANES := -UQRAY_LANES $(if $(NATIVE),,-mavx2 -mfma -mbmi -mbmi2 -mlzcnt) $(if $(findstring clang,$(CXX)),,-fno-gnu-unique)
endif
COMMAND := $(PLAIN) $(if $(LANES),$(LANED))

build/qray: $(COMMAND)
	@echo "  link $@"
	@$(CXX) $(OPTIMISE) $(STATIC) $^ -pthread -o $@
build/obj/src/%.o: src/%.cpp build/obj/flags
	@echo "  compile $<"
	@mkdir -p $(@D)
	@$(CXX) $(FLAGS) $(PROGRAM) -c $< -o $@
define IN_LANES
	@echo "  compile $< in lanes"
	@mkdir -p $(@D)
	@$(CXX) $(USED) $(LANES) -MT $@ -c $< -o $(@:.o=.whole)
	@$(CXX) -r -nostdlib -Wl,--force-group-allocation $(@:.o=.whole) -o $@
	@objcopy --wildcard --keep-global-symbol='*_lanes_renderer*' $@
endef
$(LANED): private OPTIMISE := $(OPTIMISE:-O2=-O3)
$(LANED): USED = $(FLAGS) $(PROGRAM)
$(LANED): build/obj/%.o: %.cpp build/obj/flags; $(IN_LANES)
$(LANED:build/%=build/sanitized/%): USED = $(SANITIZE) $(HASTE)
$(LANED:build/%=build/sanitized/%): build/sanitized/obj/%.o: %.cpp build/obj/flags; $(IN_LANES)
build/obj/src/cli/observe.o: private OPTIMISE := $(OPTIMISE:-O2=-O1) # draws one pixel
# Rewritten when the flags change, so that everything is compiled again.
build/obj/flags: FORCE
	@mkdir -p $(@D)
	@echo '$(CXX) $(FLAGS) $(LANES) $(STATIC)' | cmp -s - $@ || echo '$(CXX) $(FLAGS) $(LANES) $(STATIC)' > $@
FORCE:

RENDER  := $(or $(SCENE),scenes/showcase.nff)
PICTURE := build/$(basename $(notdir $(RENDER))).ppm
render: build/qray
	@build/qray $(RENDER) -o $(PICTURE) $(if $(SIZE),-s $(SIZE)) $(if $(SAMPLES),-r $(SAMPLES))
	@echo "$(PICTURE) is drawn. Look at it with any viewer of pictures (xdg-open, feh, gimp, ...), or make a PNG:"
	@echo "    pnmtopng $(PICTURE) > $(PICTURE:.ppm=.png)"

# Tests: each tests/test_*.cpp is a program of its own, built with sanitizers; and those that ask more of a fast program
# (a million rays instead of 20,000) once more as users would build it.
UNIT    := $(patsubst tests/%.cpp,%,$(wildcard tests/test_*.cpp))
FAST    := test_hostile test_math test_meshes
SCRIPTS := $(wildcard tests/test_*.py tests/test_*.sh tests/*/test_*.py tests/*/test_*.sh)
TESTS      = $(SCRIPTS) $(addprefix build/tests/,$(FAST)) $(addprefix build/sanitized/tests/,$(UNIT))
TEST_NEEDS = build/qray build/sanitized/qray build/oracle
TEST_LIBS := -lgtest -lgtest_main -lquadmath -pthread

build/tests/%: build/obj/tests/%.o build/obj/tests/tracer.o $(LIBRARY)
	@mkdir -p $(@D)
	@$(CXX) $(OPTIMISE) $^ $(TEST_LIBS) -o $@
build/obj/tests/tracer.o: private OPTIMISE := $(OPTIMISE:-O2=-O1) # builds scenes there
build/obj/tests/%.o: tests/%.cpp build/obj/gtest.hpp.gch
	@echo "  compile $<"
	@mkdir -p $(@D)
	@$(CXX) $(FLAGS) -include build/obj/gtest.hpp -c $< -o $@

SANITIZED := $(patsubst build/%,build/sanitized/%,$(LIBRARY))
# Where this processor takes what is in lanes, nothing runs the kernels beside: those are linked as they are, behind all
# else, so that what several files hold is taken with sanitizers.
HAS_LANES := $(if $(LANES),$(shell grep -m1 -w avx2 /proc/cpuinfo 2> /dev/null))
BESIDE    := $(if $(HAS_LANES),$(subst lanes_,kernel_,$(LANED)))
build/sanitized/qray: $(patsubst build/%,build/sanitized/%,$(filter-out $(BESIDE),$(COMMAND))) $(BESIDE)
	@$(CXX) -fsanitize=address,undefined $^ -pthread -o $@
build/sanitized/tests/%: build/sanitized/obj/tests/%.o build/sanitized/tests.a
	@mkdir -p $(@D)
	@$(CXX) -fsanitize=address,undefined $^ $(TEST_LIBS) -o $@
build/sanitized/tests.a: $(patsubst %,build/sanitized/obj/tests/%.o,tracer tracer_flat) $(SANITIZED)
	@rm -f $@ && ar rcsT $@ $^
build/sanitized/obj/src/%.o: src/%.cpp build/obj/flags
	@echo "  compile $< with sanitizers"
	@mkdir -p $(@D)
	@$(CXX) $(SANITIZE) $(SANITIZED_LEVEL) -c $< -o $@
SANITIZED_LEVEL := -Og
build/sanitized/obj/src/cli/%.o: SANITIZED_LEVEL = $(HASTE)
# To compile is what takes time, but for these and src/scene. Memory checked by calls takes a quarter less, and pointers
# that are not checked themselves a third: whether they are null is seen with memory, whether aligned in the others.
LONG  := test_hard_bounds test_math test_meshes test_parser test_reject test_tree tracer
CHECK := $(if $(findstring clang,$(CXX)),-mllvm -,--param )asan-instrumentation-with-call-threshold=0
HASTE := -O0 -fno-sanitize=null,alignment $(CHECK)
build/sanitized/obj/tests/%.o: tests/%.cpp build/sanitized/obj/gtest.hpp.gch
	@echo "  compile $< with sanitizers"
	@mkdir -p $(@D)
	@$(CXX) $(SANITIZE) $(if $(filter $*,$(LONG)),-Og,$(HASTE) -include build/sanitized/obj/gtest.hpp) -c $< -o $@
build/obj/gtest.hpp.gch: USED = $(FLAGS) # GoogleTest's header, compiled once
build/sanitized/obj/gtest.hpp.gch: USED = $(SANITIZE) $(HASTE)
%/gtest.hpp.gch: build/obj/flags
	@mkdir -p $(@D)
	@echo '#include <gtest/gtest.h>' > $(@:.gch=)
	@$(CXX) $(USED) -x c++-header $(@:.gch=) -o $@

build/oracle: tests/oracle/oracle.cpp
	@echo "  compile $<"
	@mkdir -p $(@D)
	@$(CXX) -std=gnu++20 -O2 -pthread $< -o $@

# On all processors, unless make was told how many.
JOBS = $(if $(filter -j% --jobserver%,$(MAKEFLAGS)),,-j$(shell nproc))
test: | $(filter deps,$(MAKECMDGOALS))
	@$(MAKE) $(JOBS) -k --no-print-directory test-programs; built=$$?; \
	    $(PYTHON) tests/run.py $(TESTS) && exit $$built

PACKAGES := g++ libgtest-dev cmake clang libclang-rt-14-dev gcc-arm-none-eabi libnewlib-arm-none-eabi qemu-system-arm \
    gcc-riscv64-unknown-elf qemu-system-misc valgrind python3 python3-matplotlib netpbm
deps:
	@dpkg -s $(PACKAGES) > /dev/null 2>&1 || { \
	    root=$$([ $$(id -u) = 0 ] || echo sudo); $$root apt-get -qq update && $$root env DEBIAN_FRONTEND=noninteractive \
	        apt-get -qq -y install --no-install-recommends $(PACKAGES) > /dev/null; }

clean:; @rm -rf build
help:; @sed -n 's/^#   make/make/p' $(MAKEFILE_LIST)

# Firmware, measurements and long tests; what tests need is known only after these.
include $(sort $(wildcard src/*/*.mk tests/*/*.mk))
test-programs: $(TEST_NEEDS) $(filter build/%,$(TESTS))

.PHONY: all render test test-programs deps clean help FORCE
.SECONDARY:
-include $(shell find build/obj build/sanitized/obj build/variants -name '*.d' 2> /dev/null)
