# Frames of a scene that moves, as the desktop draws them. Included by the top-level Makefile.
#   make frames SCENE=... ANIMATION=orbit [FRAMES=24]   build/frames/SCENE-orbit-q32.ppm, one picture behind another
# and with BOARD=..., `make run` draws the same. An animation is src/firmware/animations/NAME.cpp; its first line says
# what moves. WITHIN=x,y,z,x,y,z: see qray compile --within.
ifdef ANIMATION
FRAMES  ?= 24
FR_CODE := src/firmware/animations/$(ANIMATION).cpp
ifeq ($(wildcard $(FR_CODE)),)
$(error there is no animation $(ANIMATION); they are: $(basename $(notdir $(wildcard src/firmware/animations/*.cpp))))
endif
ifeq ($(shell echo '$(FRAMES)' | grep -Ex '[1-9][0-9]{0,5}'),)
$(error FRAMES=$(FRAMES): expected a whole number from 1 to 999999)
endif
FR_MOVES   := $(shell sed -n 's,^// Moves: ,,p' $(FR_CODE))
ifeq ($(strip $(FR_MOVES)),)
$(error $(FR_CODE) does not say what moves; expected a line like // Moves: spheres,lights)
endif
FR_DEFINES := -DQRAY_FRAMES=$(FRAMES) -DQRAY_ANIMATION='"firmware/animations/$(ANIMATION).cpp"'
FR_NAME    := $(basename $(notdir $(SCENE)))-$(ANIMATION)
FR_STEM     = build/frames/$(FR_NAME)-$(or $(NUMBER),q32)

frames: build/qray
	@mkdir -p build/frames
	@build/qray compile $(SCENE) $(FW_OPTIONS) --moving $(FR_MOVES) -o $(FR_STEM).hpp
	@$(CXX) $(filter-out -MMD -MP,$(FLAGS)) $(PROGRAM) -Wno-maybe-uninitialized -Ibuild/frames $(FR_DEFINES) \
	    -DQRAY_SCENE_HEADER='"$(FR_STEM).hpp"' -I. src/firmware/frames.cpp src/firmware/desktop.cpp -o $(FR_STEM)
	@$(FR_STEM) > $(FR_STEM).part && mv $(FR_STEM).part $(FR_STEM).ppm
	@echo "picture: $(FR_STEM).ppm"
else
frames:
	@echo "usage: make frames SCENE=scenes/x.nff ANIMATION=orbit [FRAMES=24] [NUMBER=q32] [SIZE=64x48]" >&2
	@exit 2
endif
.PHONY: frames
