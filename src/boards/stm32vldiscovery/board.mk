# ST STM32VLDISCOVERY: STM32F100RB, Cortex-M3 at 24 MHz, 128 KB flash, 8 KB RAM.
include $(FW_SRC)/mps2_an385/board.mk
BOARD_OPTIMISE := -Os
BOARD_UART     := uart_stm32
BOARD_QEMU     := qemu-system-arm -M stm32vldiscovery
BOARD_TICK     := 41.6666667
