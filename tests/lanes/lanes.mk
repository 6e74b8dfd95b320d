# Tests of vectors in registers: of each function, and of vectors and shapes as a whole, where this processor has them;
# with sanitizers, hostile scenes too.
LANE_TESTS := $(addprefix build/lanes/,test_lanes test_vec test_hostile test_tree) \
    $(addprefix build/sanitized/lanes/,test_lanes test_hard_bounds test_fuzz_corpus)
# First: the longest would run alone at the end.
TESTS := $(if $(HAS_LANES),$(LANE_TESTS)) $(TESTS)

build/lanes/%: build/obj/lanes/%.o build/obj/lanes/tracer.o $(LIBRARY)
	@mkdir -p $(@D)
	@$(CXX) $(OPTIMISE) $^ $(TEST_LIBS) -o $@
build/sanitized/lanes/%: build/sanitized/obj/lanes/%.o build/sanitized/obj/lanes/tracer.o $(SANITIZED)
	@mkdir -p $(@D)
	@$(CXX) -fsanitize=address,undefined $^ $(TEST_LIBS) -o $@
build/obj/lanes/tracer.o build/sanitized/obj/lanes/tracer.o: tests/tracer.cpp
build/obj/lanes/test_lanes.o build/sanitized/obj/lanes/test_lanes.o: tests/lanes/test_lanes.cpp
build/obj/lanes/test_vec.o: tests/test_vec.cpp
build/obj/lanes/test_hostile.o: tests/test_hostile.cpp
build/obj/lanes/test_tree.o: tests/test_tree.cpp
build/sanitized/obj/lanes/test_hard_bounds.o: tests/test_hard_bounds.cpp
build/sanitized/obj/lanes/test_fuzz_corpus.o: tests/test_fuzz_corpus.cpp
build/obj/lanes/%.o: build/obj/flags
	@echo "  compile $*.cpp in lanes"
	@mkdir -p $(@D)
	@$(CXX) $(FLAGS) $(LANES) -DQRAY_LANES_ALONE -c $(firstword $(filter %.cpp,$^)) -o $@
build/sanitized/obj/lanes/%.o: build/obj/flags
	@echo "  compile $*.cpp in lanes with sanitizers"
	@mkdir -p $(@D)
	@$(CXX) $(SANITIZE) $(LANES) -DQRAY_LANES_ALONE -Og -c $(firstword $(filter %.cpp,$^)) -o $@
