# qray as a part of other projects; see README.md here.
#   make package                build/package: one header, for CMake, PlatformIO, ESP-IDF, Zephyr and Arduino
#   make object SCENE=...       build/object/NAME: a scene for C, qray.o and qray_c.h
# Optional for object: BOARD=, FORMAT='Dithered<Mono>', MOVING=camera,spheres (as qray compile --moving), NAME= and what
# `make run` takes for a picture.
package: build/qray
	@$(PYTHON) src/package/package.py build/package

OBJECT := build/object/$(or $(NAME),$(basename $(notdir $(SCENE))))
OBJECT_CXX = $(if $(BOARD),$(BOARD_TOOLS)g++ $(BOARD_CPU) $(BOARD_OPTIMISE),$(CXX) $(OPTIMISE))
object: build/qray
	@[ -n '$(SCENE)' ] || { echo "usage: make object SCENE=scenes/x.nff [BOARD=board NUMBER=q32 ...]" >&2; exit 2; }
	@mkdir -p $(OBJECT)
	@build/qray compile '$(SCENE)' $(FW_OPTIONS) $(if $(MOVING),--moving '$(MOVING)') -o $(OBJECT)/scene.hpp
	@cp src/package/c/qray_c.h $(OBJECT)
	@$(OBJECT_CXX) -std=c++20 $(WARNINGS) -Wno-maybe-uninitialized $(PROGRAM) -ffp-contract=off -ffreestanding \
	    -ffunction-sections -fdata-sections -Iinclude -I$(OBJECT) -DQRAY_SCENE_HEADER='"scene.hpp"' \
	    $(if $(FORMAT),-DQRAY_FORMAT='$(FORMAT)') $(if $(MOVING),-DQRAY_MOVING) \
	    -c src/package/c/qray_c.cpp -o $(OBJECT)/qray.o
	@echo "$(OBJECT)/qray.o, and qray_c.h"
.PHONY: package object
