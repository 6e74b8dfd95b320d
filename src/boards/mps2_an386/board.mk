# Arm MPS2 with AN386: Cortex-M4 at 25 MHz with a single-precision FPU, 4 MB for code, 4 MB of RAM.
BOARD_TOOLS    := arm-none-eabi-
BOARD_CPU      := -mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard
BOARD_OPTIMISE := -O2
BOARD_CORE     := cortex_m
BOARD_COUNTER  := host_systick
BOARD_UART     := uart_cmsdk
BOARD_QEMU     := qemu-system-arm -M mps2-an386
BOARD_TICK     := 40
