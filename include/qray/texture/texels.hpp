// The texels of an image, as image and globe look them up.
#pragma once

#include "../vector/vec.hpp"

namespace qray {

// A texture is made of what a scene's text says: made(make), to which `make` gives its colour, its coordinates and its
// file (src/scene/texture_builder.hpp). This stands behind its name there.
enum class TextureText : uint8_t {
    cells,       // a colour, and a size
    cells_along, // and an axis
    image,       // a file, a corner and two edges
    globe,       // a file, and a centre
};
constexpr bool has_texels(TextureText text) { return text >= TextureText::image; }

// A scene's table of the bytes of all its images.
template <class N>
using Texel = uint8_t;

template <class N>
struct Texels {
    const uint8_t* texels;  // rows from the bottom: an index each, or red, green and blue
    const uint8_t* colours; // red, green and blue by index; null where there are none
    uint16_t width, height;

    // (s, t) in 2^-32 of the image, from its lower left.
    constexpr Vec<typename N::Unit> at(uint32_t s, uint32_t t) const
    {
        return texel(place(s, width), place(t, height));
    }

    constexpr Vec<typename N::Unit> texel(uint32_t column, uint32_t row) const
    {
        const uint32_t i = row * width + column;
        const uint8_t* const rgb = colours != nullptr ? colours + 3 * uint32_t{texels[i]} : texels + 3 * i;
        return {share(rgb[0]), share(rgb[1]), share(rgb[2])};
    }

private:
    static constexpr uint32_t place(uint32_t part, uint32_t size)
    {
        if constexpr (ShortFixed<N>)
            return (part >> 18) * size >> 14;
        else
            return mul_high(part, size);
    }
    // v / 255, error below 1 ulp; 255 is 1.
    static constexpr typename N::Unit share(uint8_t v)
    {
        if constexpr (N::is_fixed)
            return {v * (N::one.raw / 255) + ((v * (N::one.raw % 255) + 128) >> 8)};
        else
            return static_cast<typename N::Unit>(v) * (N::one / 255);
    }
};

} // namespace qray
