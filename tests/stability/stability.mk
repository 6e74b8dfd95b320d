#   make stability              robust forms beside textbook ones: README's tables (4 minutes); RAYS=N SEED=N
build/stability/stability: build/obj/tests/stability/stability.o $(LIBRARY)
	@mkdir -p $(@D)
	@$(CXX) $(OPTIMISE) $^ -pthread -o $@
build/obj/tests/stability/%.o: tests/stability/%.cpp build/obj/flags
	@echo "  compile $<"
	@mkdir -p $(@D)
	@$(CXX) $(FLAGS) -c $< -o $@

stability: build/stability/stability
	@$(PYTHON) tests/stability/stability.py $(if $(RAYS),--rays $(RAYS)) $(if $(SEED),--seed $(SEED))
.PHONY: stability
#   make robustness             what robust forms cost in a picture, on boards: README's table (5 minutes)
robustness: build/qray
	@$(PYTHON) tests/stability/lean.py $(SCENE) $(SIZE)
.PHONY: robustness
