# Arm MPS2 with AN385: Cortex-M3 at 25 MHz, 4 MB for code, 4 MB of RAM.
BOARD_TOOLS    := arm-none-eabi-
BOARD_CPU      := -mcpu=cortex-m3 -mthumb -mfloat-abi=soft
BOARD_OPTIMISE := -O2
BOARD_CORE     := cortex_m
BOARD_COUNTER  := host_systick
BOARD_UART     := uart_cmsdk
BOARD_QEMU     := qemu-system-arm -M mps2-an385
BOARD_TICK     := 40
