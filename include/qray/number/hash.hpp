// A hash of three integers (scenes/README.md, section 4): for noise, and for the places of panels.
#pragma once

#include "base.hpp"

namespace qray {

// Into h; a value that is returned moved registers on the M0.
QRAY_INLINE constexpr void hash(uint32_t x, uint32_t y, uint32_t z, uint32_t& h)
{
    h = x * 0x8da6b343u ^ y * 0xd8163841u ^ z * 0xcb1ab31fu;
    h ^= h >> 15;
    h *= 0x2c1b3c6du;
    h ^= h >> 12;
    h *= 0x297a2d39u;
    h ^= h >> 15;
}

} // namespace qray
