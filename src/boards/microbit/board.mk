# BBC micro:bit V1: nRF51822, Cortex-M0 at 16 MHz, 256 KB flash, 16 KB RAM.
BOARD_TOOLS    := arm-none-eabi-
BOARD_CPU      := -mcpu=cortex-m0 -mthumb -mfloat-abi=soft
BOARD_OPTIMISE := -Os
BOARD_CORE     := cortex_m
BOARD_COUNTER  := host_systick
BOARD_UART     := uart_nrf51
BOARD_QEMU     := qemu-system-arm -M microbit
BOARD_TICK     := 62.5
