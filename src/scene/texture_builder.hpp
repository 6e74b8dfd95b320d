// The tables of textures and of images' texels.
#pragma once

#include <string.h>

#include <utility>

#include "frame.hpp"
#include "storage.hpp"

namespace qray::scene {

template <class N>
class TextureBuilder {
public:
    TextureBuilder(const Description& from, const Frame& in, Storage<N>& into) : d(from), s(into), frame(in) {}

    // The bytes of all images: an index a texel where there are at most 256 colours, which stand behind them, and that
    // is shorter; else all three.
    void images()
    {
        for (uint32_t i = 0; i < d.image_count; i++) {
            const ImageSource& from = d.images[i];
            const uint8_t* const rgb = d.image_bytes.room.at + from.first;
            uint8_t* const to = s.texels.data + s.texels.count;
            const uint32_t size = from.width * from.height;
            // A colour's number stands at its hash, or at the next place that was free.
            uint32_t colours = 0, keys[1024] = {};
            uint8_t numbers[1024];
            for (uint32_t k = 0; k < size && colours <= 256; k++) {
                const uint8_t* const c = rgb + 3 * size_t{k};
                const uint32_t key = 1 + (uint32_t{c[0]} | uint32_t{c[1]} << 8 | uint32_t{c[2]} << 16);
                uint32_t at = key * 0x9e3779b1u >> 22;
                while (keys[at] != 0 && keys[at] != key)
                    at = (at + 1) & 1023;
                if (keys[at] == 0) {
                    keys[at] = key;
                    numbers[at] = static_cast<uint8_t>(colours++);
                }
                to[k] = numbers[at];
            }
            const bool indexed = colours <= 256 && size + 3 * colours < 3 * size;
            if (indexed) {
                for (uint32_t at = 0; at < 1024; at++)
                    for (uint32_t c = 0; keys[at] != 0 && c < 3; c++)
                        to[size + 3 * numbers[at] + c] = static_cast<uint8_t>((keys[at] - 1) >> 8 * c);
            } else {
                memcpy(to, rgb, 3 * size_t{size});
            }
            s.texels.count += indexed ? size + 3 * colours : 3 * size;
            texels[i] = {to, indexed ? to + size : nullptr, static_cast<uint16_t>(from.width),
                         static_cast<uint16_t>(from.height)};
        }
    }

    // After images().
    TextureRef texture(const Texture& t)
    {
        const auto push = [&t, this](auto& table) {
            table.push() = std::remove_reference_t<decltype(*table.data)>::made(Make{t, frame, texels});
            return TextureRef{t.kind, static_cast<uint16_t>(table.count - 1)};
        };
        switch (t.kind) {
        case TextureKind::none: break;
#define QRAY_CASE(Type, name, table) case TextureKind::name: return push(s.table);
            QRAY_TEXTURES(QRAY_CASE)
#undef QRAY_CASE
        }
        return {TextureKind::none, 0};
    }

private:
    const Description& d;
    Storage<N>& s;
    const Frame& frame;
    Texels<N> texels[Limits::images];

    // The coordinates of a texture, in its own size: see the textures' headers.
    struct Make {
        const Texture& t;
        const Frame& frame;
        const Texels<N>* images;
        // What keeps a surface in a plane of the lattice clean: not less than a hit may lie off its surface.
        double epsilon() const
        {
            if constexpr (NarrowFixed<N>)
                return fmax(1.0 / 1024, ldexp(1.5, -N::Length::frac) / (t.size * frame.scale));
            return 1.0 / 1024;
        }
        Vec3d direction() const { return scene::length(t.axis) > 0 ? unit(t.axis) : Vec3d{0, 1, 0}; }
        LatticeAxis<N> axis(const Vec3d& along, double offset, bool wraps) const
        {
            return Convert<N>::axis(along * (1 / t.size), frame.origin, frame.scale, offset, wraps);
        }

        Vec<typename N::Unit> colour() const { return Convert<N>::surface(t.colour); }
        // Cells along x, y and z; of y so many to a size.
        Lattice<N> lattice(bool clean, int courses = 1) const
        {
            const auto step = [&](const Vec3d& along) {
                return Convert<N>::step(axis(along, clean ? epsilon() : 0, true));
            };
            return {step({1, 0, 0}), step({0, static_cast<double>(courses), 0}), step({0, 0, 1})};
        }
        LatticeAxis<N> along_axis(bool clean, bool wraps) const
        {
            return axis(direction(), clean ? epsilon() : 0, wraps);
        }
        LatticeAxis<N> across_axis(int which) const
        {
            const Vec3d u = unit_across(direction());
            return axis(which == 0 ? u : cross(direction(), u), 0, false);
        }
        LatticeAxis<N> along_x() const { return axis({1, 0, 0}, 0, false); }
        LatticeAxis<N> along_z() const { return axis({0, 0, 1}, 0, false); }

        Texels<N> texels() const { return images[t.image]; }
        LatticeAxis<N> along_edge(int which) const
        {
            const Vec3d& edge = which == 0 ? t.u : t.v;
            const double length = scene::length(edge);
            const Vec3d row = edge * (1 / length) * (1 / length);
            return Convert<N>::axis(row, frame.origin, frame.scale, -dot(row, t.at), true);
        }
        // Farther away than any light that is not a sun, only its direction tells.
        auto centre() const
        {
            Vec3d at = frame.point(t.at);
            at = at * fmin(1, ldexp(world, 30) / fmax(largest(at), 1));
            const FarPoint far = far_point<N>(at);
            return std::pair(Convert<N>::point(far.at), int32_t{far.shift});
        }
    };
};

} // namespace qray::scene
