# Random hostile rays without end; `make test` throws a million at each shape in each number system.
#   make soak                   10^8 rays a shape and number system (60 CPU-minutes); RAYS=N SEED=N
#   make soak-scenes            10^6 random scenes, sanitized, in lanes (5 CPU-minutes); SCENES=N of each kind, SEED=N
#   make soak-trees             10^7 rays, 3000 random scenes, with trees and without (10 minutes); RAYS, SCENES, SEED
build/hostile/hostile: build/obj/tests/hostile/hostile.o $(LIBRARY)
	@mkdir -p $(@D)
	@$(CXX) $(OPTIMISE) $^ -pthread -o $@
build/obj/tests/hostile/%.o: tests/hostile/%.cpp build/obj/flags
	@echo "  compile $<"
	@mkdir -p $(@D)
	@$(CXX) $(FLAGS) -c $< -o $@

soak: build/hostile/hostile
	@build/hostile/hostile --rays $(or $(RAYS),100000000) --seed $(or $(SEED),2) --threads $(shell nproc)

build/hostile/scenes: tests/hostile/scenes.cpp tests/tracer.cpp $(SANITIZED)
	@echo "  compile $< with sanitizers"
	@mkdir -p $(@D)
	@$(CXX) $(SANITIZE) $(LANES) -O1 $^ -o $@
soak-scenes: build/hostile/scenes
	@build/hostile/scenes --scenes $(or $(SCENES),125000) --seed $(or $(SEED),3)
soak-trees: build/tests/test_tree
	@RAYS=$(or $(RAYS),10000000) SCENES=$(or $(SCENES),3000) SEED=$(or $(SEED),0) build/tests/test_tree
.PHONY: soak soak-scenes soak-trees
