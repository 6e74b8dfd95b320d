#include "study/scattered.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>

namespace {

using qray::study::Scattered;
constexpr Scattered sizes[] = {{1, 1},     {5, 3},     {64, 1},    {65, 2},    {80, 60},   {97, 89},
                               {160, 120}, {320, 240}, {333, 257}, {640, 480}, {1000, 1024}};

TEST(Scattered, EachCombIsThereOnce)
{
    for (const Scattered& s : sizes) {
        std::set<std::pair<uint32_t, uint32_t>> seen;
        for (uint32_t k = 0; k < s.count(); k++) {
            const auto [x, y] = s(k);
            EXPECT_LT(x + (s.length() - 1) * s.stride(), s.width);
            EXPECT_LT(y, s.height);
            seen.emplace(x, y);
        }
        EXPECT_EQ(seen.size(), s.count()) << s.width << " x " << s.height;
        EXPECT_LE(s.length(), 64u);
        EXPECT_GE(s.length() * s.stride() + 2, s.width);
    }
}

// Of the first combs, a band of rows has its share but for five, and rows that are a period apart are no further from
// theirs than chance would have them.
TEST(Scattered, TheBeginningStandsForTheWhole)
{
    for (const Scattered& s : sizes)
        for (uint32_t first = 8; first <= s.count(); first = first * 3 / 2)
            for (uint32_t part = 2; part <= 16 && part <= s.height; part++) {
                uint32_t above = 0, apart = 0;
                for (uint32_t k = 0; k < first; k++) {
                    above += s(k).y < s.height / part;
                    apart += s(k).y % part == 0;
                }
                const auto check = [&](uint32_t got, uint32_t rows, double least, double deviations) {
                    const double share = static_cast<double>(first) * rows / s.height;
                    EXPECT_NEAR(got, share, least + deviations * std::sqrt(share))
                        << s.width << " x " << s.height << ": " << first << " combs, " << part;
                };
                check(above, s.height / part, 5, 0);
                check(apart, (s.height + part - 1) / part, 1, 4);
            }
}

} // namespace
