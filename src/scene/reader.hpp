// What every entity is made of: numbers, points, directions and colours, each checked as it is read, and the
// message where one is not as it should be.
#pragma once

#include "description.hpp"
#include "lexer.hpp"

#include <cmath>

namespace qray::scene {

struct Range {
    double low, high;
    const char* text;
    bool stands_for_1 = false; // what is 0 or less

    double meant(double v) const { return stands_for_1 && v <= 0 ? 1 : v; }
    bool holds(double v) const { return v >= low && v <= high; }
};

constexpr double smallest_length = 1e-60; // see description.hpp
constexpr double largest_length = 1e15;

constexpr Range share_range{0, 1, "a number from 0 to 1"};
constexpr Range light_range{0, 64, "a number from 0 to 64"};
constexpr Range shine_range{0, 1e6, "a number from 0 to 1e6"};
constexpr Range ior_range{0.125, 8, "a number from 0.125 to 8, or one up to 0 that stands for 1", true};
constexpr Range angle_range{0x1p-1074, 0x1.67fffffffffffp7, "a number above 0 and below 180"};
constexpr Range length_range{-largest_length, largest_length, "a number from -1e15 to 1e15"};
constexpr Range size_range{smallest_length, largest_length, "a number above 0, from 1e-60 to 1e15"};

// Whether a vector is shorter than any length that counts.
inline bool is_zero(const Vec3d& p) { return largest(p) < smallest_length; }

// A token as a message shows it: cut to a length that people read.
struct Shown {
    explicit Shown(std::string_view token);
    char text[41];
};

// A file's name as a message shows it: the end of a long one, control bytes as \x1b.
struct ShownName {
    explicit ShownName(const char* name);
    char text[200];
};

// Each function reads what its name says and returns false when it has written the error. Messages name what
// was read by `part` and `what`, such as "x of " and "the centre of a sphere".
class Reader {
public:
    Reader(const char* scene, const char* text, size_t size, Error& to) : lexer(text, size), error(to), name(scene) {}

    bool number(const char* what, const Range& range, double& value, const char* part = "");
    bool any_number(const char* what, double& value);
    bool radius(const char* what, double& value); // without its sign; 0 where it is no length that counts
    // A whole number of at least `low`; above `high` the message names the limit.
    bool count(const char* what, uint32_t low, uint32_t high, const char* limit, uint32_t& value);
    bool point(const char* what, Vec3d& value);
    bool direction(const char* what, Vec3d& value); // not zero
    bool not_zero(const char* what, const Vec3d& value);
    bool colour(const char* what, const Range& range, Vec3d& value);

    // Always false.
    [[gnu::format(printf, 3, 4)]] bool fail(Position at, const char* format, ...);
    bool expected(const char* part, const char* what); // the latest token is not what should stand here

    const char* scene_name() const { return name; }

    Lexer lexer;
    Token token;        // the latest
    Position vector_at; // where the latest point or direction began

protected:
    Error& error;

private:
    template <class T>
    bool read(NumberError (*as)(std::string_view, T&), const char* what, const char* part, T& value);

    const char* name;
};

} // namespace qray::scene
