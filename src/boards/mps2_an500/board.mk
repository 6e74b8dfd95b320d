# Arm MPS2 with AN500: Cortex-M7 at 25 MHz with a double-precision FPU, 4 MB for code, 4 MB of RAM.
BOARD_TOOLS    := arm-none-eabi-
BOARD_CPU      := -mcpu=cortex-m7 -mthumb -mfpu=fpv5-d16 -mfloat-abi=hard
BOARD_OPTIMISE := -O2
BOARD_CORE     := cortex_m
BOARD_COUNTER  := host_systick
BOARD_UART     := uart_cmsdk
BOARD_QEMU     := qemu-system-arm -M mps2-an500
BOARD_TICK     := 40
