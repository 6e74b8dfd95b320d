# Arm MPS2 with AN386: as AN385, with a Cortex-M4 and a single-precision FPU.
include $(FW_SRC)/mps2_an385/board.mk
BOARD_CPU  := -mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard
BOARD_QEMU := qemu-system-arm -M mps2-an386
