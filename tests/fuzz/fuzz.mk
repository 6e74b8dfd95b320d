#   make fuzz SECONDS=600   feed mutated scenes, from tests/fuzz/corpus, to parser, builders and tracers (in lanes)
FUZZ_CXX := clang++
SECONDS  ?= 60
FUZZ_FLAGS := -std=c++20 -O1 -g1 -ffp-contract=off -fno-math-errno -Iinclude -Isrc \
    -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=all $(filter-out -fno-gnu-unique,$(LANES))

build/fuzz_scene: tests/fuzz/fuzz_scene.cpp tests/tracer.cpp \
    $(wildcard src/scene/*.?pp src/scene/*/*.hpp include/qray/*/*.hpp)
	@echo "  compile $<"
	@mkdir -p $(@D)
	@$(FUZZ_CXX) $(FUZZ_FLAGS) $(filter %.cpp,$^) -o $@

# New inputs stay in build/fuzz; one that fails is left there as crash-*.
fuzz: build/fuzz_scene
	@mkdir -p build/fuzz
	@build/fuzz_scene -max_total_time=$(SECONDS) -max_len=4096 -timeout=20 -rss_limit_mb=4096 -print_final_stats=1 \
	    -dict=tests/fuzz/scene.dict -artifact_prefix=build/fuzz/ build/fuzz tests/fuzz/corpus
.PHONY: fuzz
