# Netduino Plus 2: STM32F405RG, Cortex-M4 with a single-precision FPU at 168 MHz, 1 MB flash, 128 KB RAM.
include $(FW_SRC)/mps2_an386/board.mk
BOARD_UART := uart_stm32
BOARD_QEMU := qemu-system-arm -M netduinoplus2
BOARD_TICK := 5.95238095
