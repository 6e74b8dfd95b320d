# Measurements; see README.md here.
#   make study [QUICK=1]        what accuracy costs, here and on the boards: CSV and plots in build/study
#   make plan SCENE=... BOARD=... [MHZ=... WAITS=... SECONDS=... | ERROR=35dB]   which number system, samples, depth
#   make report                 measure again what README.md's tables between markers say, and write them
#   make peers PEERS=folder     the desktop beside POV-Ray and Embree, into README.md here
STUDY := src/study

# The desktop's part.
MEASURE := build/study/measure build/study/flip
build/study/%: build/obj/$(STUDY)/%.o $(filter-out %/main.o,$(COMMAND))
	@mkdir -p $(@D)
	@$(CXX) $(OPTIMISE) $(STATIC) $^ -pthread -o $@

BITS    := build/study/bits

TEST_NEEDS += $(MEASURE) $(BITS)

report: build/qray build/oracle $(MEASURE) $(BITS)
	@$(PYTHON) $(STUDY)/report.py $(REPORT)
study: build/qray $(MEASURE) $(BITS)
	@$(PYTHON) $(STUDY)/study.py $(if $(QUICK),quick)
plan: build/qray $(MEASURE)
	@$(PYTHON) $(STUDY)/plan.py SCENE='$(SCENE)' BOARD='$(BOARD)' SIZE='$(SIZE)' CUTOFF='$(CUTOFF)' MHZ='$(MHZ)' \
	    WAITS='$(WAITS)' SECONDS='$(if $(findstring command,$(origin SECONDS)),$(SECONDS))' ERROR='$(ERROR)'
peers: build/qray
	@$(PYTHON) $(STUDY)/peers.py '$(PEERS)'
.PHONY: report study plan peers
