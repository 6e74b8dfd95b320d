# Tests of vectors in registers: of each function, and of vectors and shapes as a whole, where this processor has them.
LANE_TESTS := build/lanes/test_lanes build/lanes/test_vec build/lanes/test_hostile
TESTS += $(if $(LANES),$(if $(shell grep -m1 -w avx2 /proc/cpuinfo 2> /dev/null),$(LANE_TESTS)))

build/lanes/%: build/obj/lanes/%.o $(LIBRARY)
	@mkdir -p $(@D)
	@$(CXX) $(OPTIMISE) $^ $(TEST_LIBS) -o $@
build/obj/lanes/test_lanes.o: tests/lanes/test_lanes.cpp
build/obj/lanes/test_vec.o: tests/test_vec.cpp
build/obj/lanes/test_hostile.o: tests/test_hostile.cpp
build/obj/lanes/%.o: build/obj/flags
	@echo "  compile $*.cpp in lanes"
	@mkdir -p $(@D)
	@$(CXX) $(FLAGS) $(LANES) -c $(filter %.cpp,$^) -o $@
