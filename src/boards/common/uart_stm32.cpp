// USART1 of STM32F1 and F4 on pin PA9, at the internal oscillator's clock, as it is after a reset (ST RM0041, chapters
// 6, 7, 23; RM0090, chapters 7, 8, 30). The port is the same; its address, its pin and the clock are the family's.
#include "board.hpp"

namespace board {
namespace {
#if defined(__ARM_ARCH_7M__) // F1
constexpr uint32_t uart = 0x4001'3800, oscillator = 8'000'000;

void open_pin()
{
    reg(0x4002'1018) = 1u << 14 | 1u << 2;                      // RCC_APB2ENR: USART1, port A
    reg(0x4001'0804) = (reg(0x4001'0804) & ~0xf0u) | 0xbu << 4; // GPIOA_CRH: alternate function, push-pull
}
#else // F4
constexpr uint32_t uart = 0x4001'1000, oscillator = 16'000'000;

void open_pin()
{
    reg(0x4002'3830) = reg(0x4002'3830) | 1;                        // RCC_AHB1ENR: port A
    reg(0x4002'3844) = 1u << 4;                                     // RCC_APB2ENR: USART1
    reg(0x4002'0024) = 7u << 4;                                     // GPIOA_AFRH: function 7
    reg(0x4002'0000) = (reg(0x4002'0000) & ~(3u << 18)) | 2u << 18; // GPIOA_MODER: alternate function
}
#endif
}

void open_uart()
{
    open_pin();
    reg(uart + 0x08) = (oscillator + 57'600) / 115'200; // BRR
    reg(uart + 0x0c) = 1u << 13 | 1u << 3;              // CR1: on, transmit
}

void put_uart(uint8_t byte)
{
    while ((reg(uart + 0x00) & 1u << 7) == 0) { // SR: transmit register empty
    }
    reg(uart + 0x04) = byte;
}

} // namespace board
