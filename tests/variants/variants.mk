# The same command with its fixed point made in other ways, for the test that their bytes are the same.
VARIANTS := g++_-O0 g++_-O3_native clang++_-O0 clang++_-O3_native # '=' in a target is none to make
FIXED    := $(patsubst src/cli/%.cpp,%.o,$(wildcard src/cli/kernel_q*.cpp))
build/variants/%/qray: $(addprefix build/variants/%/,$(FIXED)) $(filter-out $(addprefix %/,$(FIXED)),$(PLAIN))
	@$(CXX) $(STATIC) $^ -pthread -o $@
build/variants/%.o: build/obj/flags
	@echo "  compile src/cli/$(*F).cpp with $(subst _, ,$(*D))"
	@mkdir -p $(@D)
	@$(subst native,-march=native,$(subst _, ,$(*D))) $(COMMON) $(PROGRAM) -c src/cli/$(*F).cpp -o $@
TEST_NEEDS += $(VARIANTS:%=build/variants/%/qray)
