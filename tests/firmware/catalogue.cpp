// The hard cases whose answers are exact, on a board, in the number system CATALOGUE_NUMBER: says which do
// not hold, and how many do. Ends with status 1 where one does not. The picture is there because a firmware
// has one.
#include "../hard_catalogue.hpp"
#include "boards/common/board.hpp"

namespace {

using Number = qray::CATALOGUE_NUMBER;

struct Sum {
    uint32_t checks = 0, passed = 0, failed = 0;
};

void say_count(const char* name, uint32_t count)
{
    board::say(name);
    board::say_hex(count);
    board::say("\n");
}

void count(Sum& sum, const char* name, const catalogue::Check& check)
{
    sum.checks += check.checks;
    if (check.checks != 0 && check.failures == 0) {
        ++sum.passed;
        return;
    }
    ++sum.failed;
    board::say(name);
    say_count(" does not hold: line:", check.first);
}

template <void (*run)(catalogue::Check&)>
[[gnu::noinline]] void run_case(Sum& sum, const char* name)
{
    catalogue::Check check;
    run(check);
    count(sum, name, check);
}

} // namespace

int main()
{
    static uint8_t pixel[3];
    if (!board::open_picture("P6\n1 1\n255\n", 11))
        return 1;
    Sum sum;
#define RUN_CASE(name) run_case<catalogue::name<Number>>(sum, #name);
    QRAY_CATALOGUE(RUN_CASE)
    say_count("checks: ", sum.checks);
    say_count("passed: ", sum.passed);
    say_count("failed: ", sum.failed);
    return board::write_picture(pixel, sizeof pixel) && board::close_picture() && sum.failed == 0 ? 0 : 1;
}
