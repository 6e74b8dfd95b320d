// The board's output under an emulator: the picture to the file that the command line names, messages to the
// console, an exit status; and the measurements, taken here so that the firmware has no code for them.
// The calls are those of Arm's "Semihosting for AArch32 and AArch64" 3.0, which RISC-V took over with a trap
// of its own. On a bare board each call is a fault.
#include "board.hpp"

extern "C" {
extern uint32_t static_end[], stack_top[]; // sections.ld

enum Operation : uint32_t {
    open_file = 0x01,
    close_file = 0x02,
    write_text = 0x04,
    write_bytes = 0x05,
    get_command_line = 0x15,
    exit_extended = 0x20,
};

// `block` points to the operation's arguments, one word each, or to the text of write_text.
#if defined(__arm__)
[[gnu::naked]] uint32_t semihosting(Operation, const void*)
{
    asm volatile("bkpt 0xab\n\t"
                 "bx lr");
}
#else
[[gnu::naked, gnu::aligned(16)]] uint32_t semihosting(Operation, const void*) // the three lie in one page
{
    asm volatile(".option push\n\t"
                 ".option norvc\n\t"
                 "slli x0, x0, 0x1f\n\t"
                 "ebreak\n\t"
                 "srai x0, x0, 7\n\t"
                 ".option pop\n\t"
                 "ret");
}
#endif
}

namespace board {
namespace {

constexpr uint32_t paint = 0x5aa5'c33c;
constexpr uint32_t most_painted = 64 * 1024; // bytes below the stack pointer

char file_name[256];
uint32_t file;
uint64_t spent, since; // ticks
uint32_t* painted;

uint32_t address(const void* pointer)
{
    return static_cast<uint32_t>(reinterpret_cast<uintptr_t>(pointer));
}

void paint_stack()
{
    uint32_t* here;
#if defined(__arm__)
    asm volatile("mov %0, sp" : "=r"(here));
#else
    asm volatile("mv %0, sp" : "=r"(here));
#endif
    painted = address(here) - address(static_end) > most_painted ? here - most_painted / 4 : static_end;
    for (uint32_t* word = painted; word != here; ++word)
        *static_cast<volatile uint32_t*>(word) = paint;
}

bool write_file(const void* bytes, uint32_t size)
{
    const uint32_t block[] = {file, address(bytes), size};
    return semihosting(write_bytes, block) == 0; // the number of bytes not written
}

} // namespace

bool open_picture(const char* header, uint32_t size)
{
    paint_stack();
    const uint32_t command_line[] = {address(file_name), sizeof file_name};
    uint32_t length = 0;
    if (semihosting(get_command_line, command_line) == 0)
        while (file_name[length] != 0)
            ++length;
    const uint32_t block[] = {address(file_name), 5 /* "wb" */, length};
    file = semihosting(open_file, block);
    if (length == 0 || file == UINT32_MAX || !write_file(header, size)) {
        say("qray: cannot write the picture: ");
        say(length == 0 ? "the command line names no file" : file_name);
        say("\n");
        return false;
    }
    start_ticks();
    since = ticks();
    return true;
}

bool write_picture(const uint8_t* bytes, uint32_t size)
{
    spent += ticks() - since;
    const bool written = write_file(bytes, size);
    if (!written)
        say("qray: cannot write the picture\n");
    since = ticks();
    return written;
}

bool close_picture()
{
    spent += ticks() - since;
    const uint32_t* lowest = painted;
    while (*lowest == paint)
        ++lowest;
    if (semihosting(close_file, &file) != 0) {
        say("qray: cannot write the picture\n");
        return false;
    }
    say("stack: ");
    say_hex(address(stack_top) - address(lowest));
    say("\nticks: ");
    say_hex(static_cast<uint32_t>(spent >> 32));
    say(" ");
    say_hex(static_cast<uint32_t>(spent));
    say("\n");
    return true;
}

void say(const char* text)
{
    semihosting(write_text, text);
}

void stop(int status)
{
    const uint32_t block[] = {0x20026 /* ADP_Stopped_ApplicationExit */, static_cast<uint32_t>(status)};
    for (;;)
        semihosting(exit_extended, block);
}

} // namespace board
