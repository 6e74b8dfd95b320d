// From a scene text, through the real parser and builder, to light and pixels in any number system.
#pragma once

#include "number_helpers.hpp"
#include "tracer.hpp"

#include <string>
#include <vector>

namespace qray::test {

inline scene::Description& description() { return kept<scene::Description>(); }
template <class N>
scene::Storage<N>& storage()
{
    return kept<scene::Storage<N>>();
}

// As boards draw a compiled scene with a tree.
constexpr scene::Settings compiled(bool is = true)
{
    scene::Settings s;
    s.compiled = is;
    return s;
}

// Parses and builds into storage<N>().
template <class N>
::testing::AssertionResult loaded(const std::string& text, const scene::Settings& settings = {},
                                  const scene::Files* files = nullptr)
{
    scene::Error error;
    if (!parse("test.nff", text.data(), text.size(), description(), error, files)
        || !scene::Builder<N>(description(), settings, storage<N>()).build(error))
        return ::testing::AssertionFailure() << error.text;
    return ::testing::AssertionSuccess();
}

// For a scene that has been loaded: the light along the ray through the centre of pixel (i, j), not clamped.
template <class N, Effects E = scene::desktop_effects()>
Vec3 light_at(uint32_t i, uint32_t j, RayCount* count = nullptr)
{
    const Scene<N, E> s = storage<N>().template view<E>();
    const Camera<N>& c = s.camera;
    const int32_t x = 2 * static_cast<int32_t>(i) + 1 - c.width, y = 2 * static_cast<int32_t>(j) + 1 - c.height;
    RayCount counted;
    const auto light = trace(s, eye_ray(s, c.row(y) + c.right * x), counted, eye_sample(c, x, y, 1));
    if (count != nullptr)
        *count = counted;
    return value(light) * std::ldexp(1, s.exposure);
}

struct Picture {
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> rgb;
    Pixel at(uint32_t i, uint32_t j) const
    {
        const uint8_t* p = &rgb[(size_t{j} * width + i) * 3];
        return {p[0], p[1], p[2]};
    }
    friend bool operator==(const Picture&, const Picture&) = default;
};

// A scene that has been loaded, drawn row by row to a sink.
template <class N, Effects E = scene::desktop_effects()>
Picture draw(uint32_t rows = 4)
{
    const Scene<N, E> s = storage<N>().template view<E>();
    Picture p{s.camera.width, s.camera.height, {}};
    std::vector<uint8_t> buffer(size_t{rows} * p.width * 3);
    const auto sink = [&p](uint32_t, uint32_t, const uint8_t* bytes, uint32_t size) {
        p.rgb.insert(p.rgb.end(), bytes, bytes + size);
        return true;
    };
    RayCount counted; // as light_at, so that the tracer is compiled once
    render<Rgb888>(s, buffer.data(), rows, sink, counted);
    return p;
}

// Light of size about 1 from few roundings: what a closed form may be missed by.
template <class N>
double light_tolerance()
{
    return N::is_fixed ? 16 * make<N>::length_ulp() : 64 * make<N>::length_ulp();
}

inline void expect_light(const Vec3& light, const Vec3& expected, double tolerance)
{
    EXPECT_LE(distance(light, expected), tolerance)
        << "is " << light.x << " " << light.y << " " << light.z << ", should be " << expected.x << " " << expected.y
        << " " << expected.z;
}

// The byte of a level: exact but where it lies within `slack` of the step between two.
inline bool is_byte_of(uint8_t byte, double level, double slack)
{
    const double v = std::fmin(1, std::fmax(0, level));
    return byte >= std::floor(255 * (v - slack) + 0.5) && byte <= std::floor(255 * (v + slack) + 0.5);
}

} // namespace qray::test
