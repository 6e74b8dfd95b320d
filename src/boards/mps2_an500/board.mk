# Arm MPS2 with AN500: as AN385, with a Cortex-M7 and a double-precision FPU.
include $(FW_SRC)/mps2_an385/board.mk
BOARD_CPU  := -mcpu=cortex-m7 -mthumb -mfpu=fpv5-d16 -mfloat-abi=hard
BOARD_QEMU := qemu-system-arm -M mps2-an500
