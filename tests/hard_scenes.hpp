// Scenes whose text is written through a move of the world: turned into their mirror image, scaled, then shifted.
#pragma once

#include <cstdarg>
#include <cstdio>
#include <initializer_list>
#include <string>
#include <vector>

#include "number_helpers.hpp"

namespace qray::test {

struct World {
    double scale = 1;
    Vec3 shift{0, 0, 0};
    bool mirrored = false; // in the plane x = 0
    bool reversed = false; // objects, each with its fill, in the opposite order

    Vec3 operator()(const Vec3& p) const
    {
        return Vec3{mirrored ? -p.x : p.x, p.y, p.z} * scale + shift;
    }
    Vec3 direction(const Vec3& d) const { return {mirrored ? -d.x : d.x, d.y, d.z}; }
};

class SceneText {
public:
    explicit SceneText(const World& w) : world(w) {}

    void view(const Vec3& from, const Vec3& at, double angle, int size)
    {
        head += format("v from %s at %s up 0 1 0 angle %.17g hither 1 resolution %d %d\n", at_point(from).c_str(),
                       at_point(at).c_str(), angle, size, size);
    }
    void light(const Vec3& at, double brightness)
    {
        head += format("l %s %.17g %.17g %.17g\n", at_point(at).c_str(), brightness, brightness, brightness);
    }
    void sun(const Vec3& from, double brightness)
    {
        head += format("sun %s %.17g %.17g %.17g\n", numbers(world.direction(from)).c_str(), brightness, brightness,
                       brightness);
    }
    void background(double r, double g, double b) { head += format("b %.17g %.17g %.17g\n", r, g, b); }
    void far(double d) { head += format("far %.17g\n", d * world.scale); }

    void fill(const Vec3& colour, double diffuse, double highlight, double shine, double mirror, double transmit,
              double ior)
    {
        current = format(
            "material colour %s diffuse %.17g highlight %.17g shine %.17g mirror %.17g transmit %.17g ior %.17g\n",
            numbers(colour).c_str(), diffuse, highlight, shine, mirror, transmit, ior);
    }
    void matte(double r, double g, double b) { fill({r, g, b}, 1, 0, 1, 0, 0, 1); }
    void checker(const Vec3& other, double size)
    {
        current += format("texture checker %s %.17g\n", numbers(other).c_str(), size * world.scale);
    }

    void sphere(const Vec3& c, double r) { object(format("s %s %.17g\n", at_point(c).c_str(), r * world.scale)); }
    void cone(const Vec3& base, double rb, const Vec3& apex, double ra)
    {
        object(format("c %s %.17g %s %.17g\n", at_point(base).c_str(), rb * world.scale, at_point(apex).c_str(),
                      ra * world.scale));
    }
    void disc(const Vec3& c, const Vec3& n, double r)
    {
        object(format("disc %s %s %.17g\n", at_point(c).c_str(), numbers(world.direction(n)).c_str(), r * world.scale));
    }
    void plane(const Vec3& p, const Vec3& n)
    {
        object(format("plane %s %s\n", at_point(p).c_str(), numbers(world.direction(n)).c_str()));
    }
    // In a mirror image corners run the other way around.
    void polygon(std::vector<Vec3> corners)
    {
        std::string s = format("p %zu\n", corners.size());
        for (size_t i = 0; i < corners.size(); i++)
            s += "  " + at_point(corners[turned(i, corners.size())]) + "\n";
        object(s);
    }
    void patch(const std::vector<Vec3>& corners, const std::vector<Vec3>& normals)
    {
        std::string s = format("pp %zu\n", corners.size());
        for (size_t i = 0; i < corners.size(); i++) {
            const size_t k = turned(i, corners.size());
            s += "  " + at_point(corners[k]) + "  " + numbers(world.direction(normals[k])) + "\n";
        }
        object(s);
    }

    std::string text() const
    {
        std::string s = head;
        for (size_t i = 0; i < objects.size(); i++)
            s += objects[world.reversed ? objects.size() - 1 - i : i];
        return s;
    }

private:
    World world;
    std::string head, current = "material\n";
    std::vector<std::string> objects;

    static std::string format(const char* f, ...) __attribute__((format(printf, 1, 2)))
    {
        char buffer[512];
        va_list list;
        va_start(list, f);
        std::vsnprintf(buffer, sizeof buffer, f, list);
        va_end(list);
        return buffer;
    }
    static std::string numbers(const Vec3& v) { return format("%.17g %.17g %.17g", v.x, v.y, v.z); }
    std::string at_point(const Vec3& p) const { return numbers(world(p)); }
    size_t turned(size_t i, size_t n) const { return world.mirrored && i > 0 ? n - i : i; }
    void object(const std::string& s) { objects.push_back(current + s); }
};

} // namespace qray::test
