# The page: the tracer compiled to WebAssembly, and all it shows, in one file.
#   make page                   build/page/index.html, for a browser; it needs no server and no network
# Debian's clang, with the headers of its libc++ and what is used of wasi-libc: arithmetic, numbers to text and back.
WASM_INCLUDE := -nostdinc++ $(addprefix -isystem ,$(wildcard /usr/include/wasm32-wasi/c++/v1 \
    /usr/lib/llvm-*/include/wasm32-wasi/c++/v1) /usr/include/wasm32-wasi)
WASM_CXX  = clang++ --target=wasm32-wasi $(WASM_LEVEL) -msimd128 $(COMMON) $(PROGRAM) -fno-threadsafe-statics \
    $(WASM_INCLUDE)
WASM_LEVEL := -O2
build/page/obj/cli/observe.o: private WASM_LEVEL := -O1 # draws one pixel
WASM_LIBS = $(firstword $(wildcard /usr/lib/wasm32-wasi/libc++.a /usr/lib/llvm-*/lib/wasm32-wasi/libc++.a)) \
    $(addprefix /usr/lib/wasm32-wasi/,libc-printscan-long-double.a libc.a) \
    $(shell clang --print-resource-dir)/lib/wasi/libclang_rt.builtins-wasm32.a
# Number systems are those that the command has. The name of a type of C++ begins with a capital there.
PAGE_NUMBERS := $(patsubst src/cli/kernel_%.cpp,%,$(wildcard src/cli/kernel_*.cpp))
PAGE_OBJECTS := $(patsubst src/%.cpp,build/page/obj/%.o,$(wildcard src/scene/*.cpp) \
    src/cli/explain.cpp src/cli/observe.cpp src/page/page.cpp) $(PAGE_NUMBERS:%=build/page/obj/kernel_%.o)

page: build/page/index.html
build/page/index.html: build/page/qray.wasm build/qray $(wildcard src/page/page.* src/page/worker.js scenes/*) \
    src/study/README.md src/study/cycles.py
	@$(PYTHON) src/page/page.py $@
	@echo "build/page/index.html, $$(wc -c < $@) bytes: open it with a browser"
build/page/qray.wasm: $(PAGE_OBJECTS) src/page/page.mk
	@echo "  link $@"
	@wasm-ld --no-entry --strip-all --gc-sections -z stack-size=262144 --stack-first $(PAGE_OBJECTS) $(WASM_LIBS) -o $@
build/page/obj/%.o: src/%.cpp build/obj/flags
	@echo "  compile $< for WebAssembly"
	@mkdir -p $(@D)
	@$(WASM_CXX) -include src/page/from_chars.hpp -DPAGE_KERNELS='$(foreach n,$(PAGE_NUMBERS),PAGE_ONE($n))' -c $< -o $@
build/page/obj/kernel_%.o: src/page/kernel.cpp build/obj/flags
	@echo "  compile $< for WebAssembly: $*"
	@mkdir -p $(@D)
	@$(WASM_CXX) -DPAGE_TYPE=$(subst float,Float,$(subst double,Double,$*)) -DPAGE_NAME='"$*"' \
	    -DPAGE_KERNEL=kernel_$* -c $< -o $@
PACKAGES += lld libc++-14-dev-wasm32 libclang-rt-14-dev-wasm32 wasi-libc chromium chromium-driver python3-selenium
# Where these cannot be installed, its test is skipped.
TEST_NEEDS += $(if $(and $(shell command -v wasm-ld),$(wildcard /usr/lib/wasm32-wasi/libc.a)),build/page/index.html)
.PHONY: page
-include $(shell find build/page -name '*.d' 2> /dev/null)
