# Stellaris LM3S6965 evaluation board: Cortex-M3, 256 KB flash, 64 KB RAM. 12.5 MHz as QEMU resets it.
include $(FW_SRC)/mps2_an385/board.mk
BOARD_UART := uart_stellaris
BOARD_QEMU := qemu-system-arm -M lm3s6965evb
BOARD_TICK := 80
