# Measurements; see README.md here.
#   make report                 measure again what README.md's tables between markers say, and write them
STUDY := src/study

# The desktop's part: the command's own kernels.
MEASURE := build/study/measure
$(MEASURE): build/obj/$(STUDY)/measure.o $(LIBRARY) $(filter-out %/main.o,$(COMMAND))
	@mkdir -p $(@D)
	@$(CXX) $(OPTIMISE) $(STATIC) $(sort $^) -pthread -o $@

report: build/qray $(MEASURE)
	@$(PYTHON) $(STUDY)/report.py $(REPORT)
.PHONY: report
