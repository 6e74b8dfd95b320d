# Firmware: one board, one scene, one picture. Included by the top-level Makefile; see README.md here.
#   make run BOARD=microbit SCENE=scenes/x.nff NUMBER=q32      build, run in QEMU, measure
#   make size BOARD=... SCENE=... NUMBER=...                   build, and report what is known without running
#   make profile BOARD=... SCENE=... NUMBER=...                build, trace in QEMU, and say where instructions go
# Optional: SIZE=WxH SAMPLES=N ADAPTIVE=LEVELS[,THRESHOLD] DEPTH=N CUTOFF=W, NAME= of the outputs,
# OUTPUT=uart (the image for a real board).
# Without SCENE, the board draws its test card.
FW_SRC    := src/boards
FW_BOARDS := $(patsubst $(FW_SRC)/%/board.mk,%,$(wildcard $(FW_SRC)/*/board.mk))
FW_OPTIONS = $(if $(NUMBER),-n $(NUMBER)) $(if $(SIZE),-s $(SIZE)) $(if $(SAMPLES),-r $(SAMPLES)) \
    $(if $(ADAPTIVE),-a $(ADAPTIVE)) $(if $(DEPTH),-d $(DEPTH)) $(if $(CUTOFF),--cutoff $(CUTOFF)) \
    $(if $(WITHIN),--within $(WITHIN)) $(if $(LIGHT_BITS),--light-bits $(LIGHT_BITS))
# Shells may have variables of these names: Zephyr's a BOARD, WSL's a NAME.
ifeq ($(origin NAME),environment)
undefine NAME
endif
ifeq ($(origin BOARD)$(filter $(BOARD),$(FW_BOARDS)),environment)
undefine BOARD
endif

ifdef BOARD
ifneq ($(words $(BOARD))$(filter-out $(FW_BOARDS),$(BOARD)),1)
$(error there is no board $(BOARD); boards are: $(FW_BOARDS))
endif
include $(FW_SRC)/$(BOARD)/board.mk

NUMBER  ?= $(if $(SCENE),q32,float)
NAME    ?= $(if $(SCENE),$(basename $(notdir $(SCENE)))$(ANIMATION:%=-%),card)
OUTPUT  ?= semihosting

# What is wrong, each in one line. Names are of letters that neither make nor a shell takes for anything else.
FW_DOLLAR := $$
FW_ODD    := $(strip $(foreach c,' " ` \ ( ) < > & ; | * ? [ ] ~ : % $(FW_DOLLAR),$(findstring $c,$(SCENE)$(NAME))))
ifneq ($(words x$(SCENE)) $(words x$(NAME)),1 1)
$(error make cannot take a name with white space in it: SCENE=$(SCENE) NAME=$(NAME))
endif
ifneq ($(FW_ODD),)
$(error make cannot take a name with $(FW_ODD) in it: SCENE=$(SCENE) NAME=$(NAME))
endif
ifneq ($(if $(SCENE),$(wildcard $(SCENE)),-),$(or $(SCENE),-))
$(error there is no scene $(SCENE))
endif
ifeq ($(filter $(patsubst src/cli/kernel_%.cpp,%,$(wildcard src/cli/kernel_*.cpp)),$(NUMBER)),)
$(error NUMBER=$(NUMBER): expected $(shell sed -n 's/.*_SAID "\(.*\)"/\1/p' src/scene/numbers.hpp))
endif
ifeq ($(filter semihosting uart,$(OUTPUT)),)
$(error OUTPUT=$(OUTPUT): expected uart, or none)
endif
ifneq ($(if $(filter profile,$(MAKECMDGOALS)),$(filter uart,$(OUTPUT))),)
$(error make profile has no OUTPUT=uart: it needs an image that ends)
endif
FW_SIZE := $(subst x, ,$(SIZE))
ifneq ($(if $(SCENE),,$(SIZE)),)
ifeq ($(shell echo '$(SIZE)' | grep -Ex '[1-9][0-9]*x[1-9][0-9]*'),)
$(error SIZE=$(SIZE): expected WIDTHxHEIGHT)
endif
endif

FW_STEM := build/$(BOARD)/$(NAME)-$(NUMBER)
FW_ELF  := $(FW_STEM)$(if $(filter uart,$(OUTPUT)),-uart).elf
FW_OBJ  := $(FW_ELF:.elf=.obj)
FW_OWN  := build/$(BOARD)/$(OUTPUT).obj
FW_MAIN ?= src/firmware/$(if $(ANIMATION),frames,main).cpp
FW_INCLUDE ?= include

FW_COMPILE  := $(FW_OPTIONS) $(if $(ANIMATION),--moving $(FR_MOVES))
FW_DEFINES  := $(FR_DEFINES) $(if $(SCENE),-DQRAY_SCENE_HEADER='"$(notdir $(FW_STEM)).hpp"',\
    $(if $(SIZE),-DQRAY_WIDTH=$(word 1,$(FW_SIZE)) -DQRAY_HEIGHT=$(word 2,$(FW_SIZE)))) \
    -I$(FW_INCLUDE) -Ibuild/$(BOARD) $(if $(filter profile,$(MAKECMDGOALS)),-g) $(FW_EXTRA)
# To say where variables are takes a compiler a quarter of its time; of use only to see where instructions go.
FW_FLAGS    := -std=c++20 $(BOARD_CPU) $(BOARD_OPTIMISE) -g1 $(WARNINGS) -Wno-maybe-uninitialized -Isrc -ffreestanding \
    -fno-exceptions -fno-rtti -fno-threadsafe-statics -fno-unwind-tables \
    -fno-asynchronous-unwind-tables -ffunction-sections -fdata-sections -ffp-contract=off \
    -fstack-usage -fcallgraph-info=su
FW_LINK     := $(BOARD_CPU) -nostdlib -Wl,--gc-sections,--fatal-warnings \
    -L$(FW_SRC)/common -L$(FW_SRC) -T $(FW_SRC)/$(BOARD)/board.ld

FW_COMMON := start memory $(BOARD_CORE) host_fault host_text
FW_OBJS   := $(addprefix $(FW_OWN)/,$(addsuffix .o,$(FW_COMMON) \
    $(if $(filter uart,$(OUTPUT)),output_uart $(BOARD_UART),host_semihosting $(BOARD_COUNTER))))
# The desktop draws the same picture, and counts its rays.
FW_COUNT  := build/qray $(SCENE) $(FW_OPTIONS) -q --stats -o /dev/null 2>&1 | sed -n 's/^rays: //p'
FW_REPORT  = $(PYTHON) $(FW_SRC)/common/run.py --tools $(BOARD_TOOLS) --tick $(BOARD_TICK) \
    $(if $(UNBOUNDED),--unbounded) $(FW_ELF)

# What the outputs were made with: a change of options remakes them.
$(FW_OBJ)/config: FW_CONFIG = $(SCENE) $(FW_COMPILE) $(FW_DEFINES) $(FW_FLAGS) $(FW_MAIN)
$(FW_OWN)/config: FW_CONFIG = $(FW_FLAGS)
%/config: FORCE
	@mkdir -p $(@D)
	@printf '%s\n' '$(subst ','\'',$(FW_CONFIG))' | cmp -s - $@ || \
	    printf '%s\n' '$(subst ','\'',$(FW_CONFIG))' > $@

ifneq ($(SCENE),)
$(FW_STEM).hpp: $(SCENE) $(wildcard $(addprefix $(dir $(SCENE))*.,bmp ppm obj)) build/qray $(FW_OBJ)/config
	@build/qray compile $(SCENE) $(FW_COMPILE) -o $@
$(FW_OBJ)/main.o: $(FW_STEM).hpp
endif

$(FW_OBJ)/main.o: $(FW_MAIN) $(FW_OBJ)/config | firmware-tools
	@$(BOARD_TOOLS)g++ $(FW_FLAGS) $(FW_DEFINES) -MMD -MP -c $< -o $@
# What is a board's own serves all its firmware. It appears only whole, whoever else makes it.
$(FW_OWN)/%.o: $(FW_SRC)/common/%.cpp $(FW_OWN)/config | firmware-tools
	@part=$$(mktemp -dp $(@D)) && $(BOARD_TOOLS)g++ $(FW_FLAGS) -MMD -MP -MT $@ -c $< -o $$part/$(@F) && \
	    mv $$part/* $(@D) && rmdir $$part
$(FW_OWN)/memory.o: FW_FLAGS += -fno-tree-loop-distribute-patterns

FW_SCRIPTS := $(FW_SRC)/$(BOARD)/board.ld $(FW_SRC)/common/sections.ld
# The linker takes three lines to say that a board is too small.
FW_SMALL := s/.*region .\(.*\). overflowed by \(.*\) bytes/\1 of $(BOARD) is \2 bytes too small/p
FW_LINKED = 2> $(FW_OBJ)/$(@F).link || \
    { small=$$(sed -n "$(FW_SMALL)" $(FW_OBJ)/$(@F).link); \
      echo "$${small:-$$(cat $(FW_OBJ)/$(@F).link)}" >&2; exit 1; }
$(FW_ELF): $(FW_OBJ)/main.o $(FW_OBJS) $(FW_SCRIPTS)
	@$(BOARD_TOOLS)g++ $(FW_LINK) -Wl,-Map=$(@:.elf=.map) $(filter %.o,$^) -lgcc -o $@ $(FW_LINKED)
$(FW_ELF:.elf=.hex): $(FW_ELF)
	@$(BOARD_TOOLS)objcopy -O ihex $< $@

run: $(FW_ELF) $(if $(filter uart,$(OUTPUT)),$(FW_ELF:.elf=.hex)) | firmware-qemu
	@$(FW_REPORT) --qemu '$(BOARD_QEMU)' --picture $(FW_STEM).ppm \
	    $(if $(ANIMATION),--frames $(FRAMES)) \
	    $(if $(filter uart,$(OUTPUT)),--uart,$(if $(SCENE),$(if $(ANIMATION),,--rays $$($(FW_COUNT)))))
size: $(FW_ELF)
	@$(FW_REPORT)
describe:
	@echo '{"tools": "$(BOARD_TOOLS)", "cpu": "$(BOARD_CPU)", "optimise": "$(BOARD_OPTIMISE)",' \
	    '"qemu": "$(BOARD_QEMU)", "tick": $(BOARD_TICK)}'
profile: $(FW_ELF) | firmware-qemu
	@$(PYTHON) $(FW_SRC)/common/profile.py --tools $(BOARD_TOOLS) --qemu '$(BOARD_QEMU)' $(FW_ELF)

firmware-package = $(if $(filter arm%,$(BOARD_TOOLS)),gcc-arm-none-eabi,gcc-riscv64-unknown-elf)
firmware-need = @command -v $(1) > /dev/null || \
    { echo "BOARD=$(BOARD) needs $(1): apt-get install $(2)" >&2; exit 1; }
firmware-tools:
	$(call firmware-need,$(BOARD_TOOLS)g++,$(firmware-package))
	$(call firmware-need,python3,python3)
firmware-qemu:
	$(call firmware-need,$(firstword $(BOARD_QEMU)),$(if $(filter %arm,$(firstword $(BOARD_QEMU))),\
	    qemu-system-arm,qemu-system-misc))
FORCE:
-include $(wildcard $(FW_OBJ)/*.d $(FW_OWN)/*.d)
else
run size profile:
	@echo "usage: make $@ BOARD=board SCENE=scenes/x.nff NUMBER=q32 [SIZE=64x48] [SAMPLES=4] [ADAPTIVE=2]" >&2
	@echo "boards: $(FW_BOARDS)" >&2
	@exit 2
describe:
	@echo '{"boards": "$(FW_BOARDS)"}'
endif
.PHONY: run size profile describe firmware-tools firmware-qemu FORCE
