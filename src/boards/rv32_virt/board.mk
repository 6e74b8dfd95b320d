# QEMU's RISC-V virt machine with an RV32IMAC core. ISA 2.2, as there counters are no extension, and the
# compiler then finds its library for the core.
BOARD_TOOLS    := riscv64-unknown-elf-
BOARD_CPU      := -march=rv32imac -misa-spec=2.2 -mabi=ilp32 -msmall-data-limit=0
BOARD_OPTIMISE := -O2
BOARD_CORE     := riscv
BOARD_COUNTER  := host_minstret
BOARD_UART     := uart_16550
BOARD_QEMU     := qemu-system-riscv32 -M virt -bios none
BOARD_TICK     := 1
