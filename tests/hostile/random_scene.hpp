// Random scenes of hostile numbers, within what the parser accepts, as text.
#pragma once

#include <array>
#include <cstdio>
#include <iterator>
#include <string>

#include <qray/scene/effects.hpp>

#include "numbers.hpp"
#include "scene/shapes.hpp"

namespace hostile {

class RandomScene {
public:
    explicit RandomScene(uint64_t seed) : random(seed)
    {
        // One scale for most of the scene, and one in eight numbers of any size at all.
        scale = random.chance(0.5) ? 1 : random.logarithmic(1e-12, 1e12);
        around = random.chance(0.7) ? Double3{} : Double3{coordinate(), coordinate(), coordinate()};
        wild = random.chance(0.3) ? 0.125 : 0;
    }

    // With energy: no surface gives back more light than reaches it, and no light is brighter than 1, all together.
    std::string text(bool with_energy, uint32_t least_objects = 1)
    {
        energy = with_energy;
        share = 1;
        const std::string from = point(), at = point();
        s = "v from " + from + " at " + at + " up " + direction() + " angle "
            + number(random.chance(0.1) ? random.logarithmic(1e-6, 179.9) : random.in(10, 120))
            + " hither 1 resolution 2 2\n";
        lights = random.below(energy ? 3 : 6);
        for (uint32_t i = 0; i < lights; i++) {
            s += random.chance(0.3) ? "sun " + direction()
                : random.chance(0.2) ? "panel 3 " + point() + " " + direction() + " " + direction()
                                     : "l " + point();
            // Together at most one half.
            const double most = energy ? 0.5 / lights : random.chance(0.1) ? 64 : 1;
            s += " " + number(random.in(0, most)) + " " + number(random.in(0, most)) + " " + number(most) + "\n";
        }
        s += "b " + colour(energy ? 1 : 64) + "\nambientlight " + colour(energy ? 0.5 : 64) + "\n";
        if (random.chance(0.1))
            s += "shadows off\n";
        if (random.chance(0.2))
            s += "far " + number(std::fabs(coordinate()) + 1e-50) + "\n";
        const uint32_t objects = least_objects + random.below(12);
        for (uint32_t i = 0; i < objects; i++) {
            if (random.chance(0.5))
                material();
            object();
            if (random.chance(0.1))
                s += last; // twice the same
        }
        if (random.chance(0.1))
            s += "radiosity " + number(std::fabs(coordinate()) + 1e-50) + "\n";
        return s;
    }

    // What shapes are made of, as text: see src/scene/shape/host.hpp.
    bool chance(double p) { return random.chance(p); }
    uint32_t below(uint32_t n) { return random.below(n); }
    std::string point() { return numbers(place()); }
    std::string radius() { return number(length()); }
    std::string direction()
    {
        if (random.chance(0.3)) {
            const char* axes[] = {"0 1 0", "1 0 0", "0 0 -1", "1 1 0", "-3 4 0"};
            return axes[random.below(5)];
        }
        using namespace qray::scene;
        return numbers(hostile::direction(random) * random.logarithmic(1e-6, 1e6));
    }
    // Not the same, and as near as numbers go with this probability.
    std::array<std::string, 2> two_points(double near)
    {
        using namespace qray::scene;
        const Double3 a = place();
        Double3 b = random.chance(near) ? a + Double3{0, length() + 1e-50, 0} : place();
        if (largest(b - a) < 1e-50)
            b = b + Double3{scale, 0, 0};
        return {numbers(a), numbers(b)};
    }
    // Corners in a plane, more or less, some of them the same.
    std::string figure(const char* word, uint32_t n, bool normals)
    {
        using namespace qray::scene;
        const Double3 c = place(), a = place() - c, b = place() - c;
        std::string text = word + (" " + std::to_string(n));
        for (uint32_t i = 0; i < n; i++) {
            const double turn = 2 * M_PI * i / n, r = random.in(0.3, 1);
            const Double3 v = random.chance(0.05) ? c
                : random.chance(wild)             ? place()
                                                  : c + a * (r * std::cos(turn)) + b * (r * std::sin(turn));
            text += "\n " + numbers(v) + (normals ? " " + direction() : "");
        }
        return text;
    }

private:
    Random random;
    double scale = 1, wild = 0, share = 1;
    uint32_t lights = 0;
    Double3 around;
    bool energy = false;
    std::string s, last;

    static std::string number(double v)
    {
        char buffer[40];
        std::snprintf(buffer, sizeof buffer, "%.17g", v);
        return buffer;
    }
    static std::string numbers(const Double3& v) { return number(v.x) + " " + number(v.y) + " " + number(v.z); }

    double coordinate()
    {
        if (random.chance(wild)) {
            const double sign = random.chance(0.5) ? 1 : -1;
            switch (random.below(6)) {
            case 0: return 0;
            case 1: return sign * 1e15;
            case 2: return sign * random.logarithmic(1e-60, 1e15);
            case 3: return sign * 4.9e-324;
            case 4: return sign * 0x1p-24;
            default: return sign * random.logarithmic(1e-3, 1e3);
            }
        }
        return scale * (random.chance(0.3) ? static_cast<int>(random.below(9)) - 4 : random.in(-4, 4));
    }
    Double3 place()
    {
        using namespace qray::scene;
        return Double3{coordinate(), coordinate(), coordinate()} + around;
    }
    double length()
    {
        if (random.chance(wild))
            return random.chance(0.2) ? 0 : random.logarithmic(1e-60, 1e15);
        return scale * (random.chance(0.2) ? random.logarithmic(1e-9, 10) : random.in(0.1, 3));
    }
    std::string colour(double most)
    {
        const auto one = [&] { return random.chance(0.2) ? 0 : random.chance(0.2) ? most : random.in(0, most); };
        const double r = one(), g = one(), b = one();
        return numbers({r, g, b});
    }
    void material()
    {
        double weights[5]; // ambient, diffuse, highlight, mirror, transmit
        double sum = 0;
        for (double& w : weights) {
            w = random.chance(0.3) ? 0 : random.chance(0.1) ? 1 : random.unit();
            sum += w;
        }
        if (energy && sum > 1) // what ambient and diffuse get is at most one half of them, the highlight's half too
            for (double& w : weights)
                w /= sum * (1 + 1e-9);
        const double shine = random.chance(0.2) ? 1e6 : random.chance(0.3) ? 0 : random.logarithmic(0.1, 1e4);
        const double ior = random.chance(0.1) ? 8 : random.chance(0.1) ? 0.125 : random.in(0.5, 2.5);
        s += "material colour " + colour(1) + " ambient " + number(weights[0]) + " diffuse " + number(weights[1])
            + " highlight " + number(weights[2]) + " shine " + number(shine) + " mirror " + number(weights[3])
            + " transmit " + number(weights[4]) + " ior " + number(ior)
            + (!energy && random.chance(0.2) ? " emission 1.5\n" : "\n");
        if (random.chance(0.3)) {
            struct Named {
                const char* name;
                qray::TextureText text;
            };
#define QRAY_NAMED(Type, name, table) {#name, qray::Type<qray::Float>::text},
            constexpr Named textures[] = {QRAY_TEXTURES(QRAY_NAMED)};
#undef QRAY_NAMED
            if (const Named& t = textures[random.below(std::size(textures))]; !qray::has_texels(t.text))
                s += "texture " + std::string(t.name) + " " + colour(1) + " " + number(std::fabs(coordinate()) + 1e-50)
                    + (t.text == qray::TextureText::cells_along ? " " + direction() : "") + "\n";
        }
    }
    void object()
    {
        constexpr uint32_t kinds = qray::everything(1).shapes();
        const auto shape = static_cast<qray::Kind>(random.below(kinds));
        last = qray::scene::with_host(shape, [this](auto host) { return host.random(*this); }) + "\n";
        s += last;
    }
};

} // namespace hostile
