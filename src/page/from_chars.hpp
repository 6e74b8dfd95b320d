// What libc++ 14 lacks: a decimal number to the nearest double, as std::from_chars of C++17 reads it without a sign in
// front but '-', and neither "inf" nor "nan". Made from strtod, so that what follows the number must be readable.
#pragma once

#include <charconv>
#include <cmath>
#include <cstdlib>

namespace std {

inline from_chars_result from_chars(const char* first, const char* last, double& value)
{
    const char* at = first + (first != last && *first == '-');
    bool any = false, other_than_0 = false;
    const auto digits = [&] {
        const char* const begin = at;
        for (; at != last && *at >= '0' && *at <= '9'; at++)
            other_than_0 = other_than_0 || *at != '0';
        return at != begin;
    };
    any = digits();
    if (at != last && *at == '.') {
        at++;
        any = digits() || any;
    }
    if (!any)
        return {first, errc::invalid_argument};
    const bool is_zero = !other_than_0;
    if (at != last && (*at == 'e' || *at == 'E')) {
        const char* const end = at++;
        at += at != last && (*at == '+' || *at == '-');
        if (!digits())
            at = end;
    }
    const double read = strtod(first, nullptr);
    if (isinf(read) || (read == 0 && !is_zero))
        return {at, errc::result_out_of_range};
    value = read;
    return {at, errc()};
}

} // namespace std
