// The number system of the study: double, but each step of the tracer rounds what it finds to a number of bits of its
// own. It is no model beside the tracer: where a step has an operation or a function of its own, that is given here for
// this system, and the tracer's own text calls it; where several steps share an operation, the file that calls tells
// which it is. Nothing of this is libm's, so that all numbers are the same on every machine.
#pragma once

#include <qray/picture/render.hpp>

#include <type_traits>

#include "../scene/builder.hpp"
#include "widths.hpp"

namespace qray {

namespace study {
struct Stepped;
}
template <>
struct Rounded<study::Stepped> {
    double x, y, z;
};

} // namespace qray

namespace qray::study {

// All that one step finds on its way is rounded like its result.
template <Step S>
struct Within : Double {
    QRAY_INLINE static constexpr double unit(double v) { return keep<S>(v); }
    QRAY_INLINE static constexpr double bent(double eta, double x) { return keep<S>(eta * x); }
    QRAY_INLINE static constexpr double sqrt_unit(double a) { return keep<S>(Double::sqrt_unit(a)); }
    QRAY_INLINE static constexpr bool normalise(double x, double y, double z, double& ux, double& uy, double& uz)
    {
        const double most = largest(x, largest(y, z));
        const auto kept = [most](double v) { return significant(v, widths[S] + 1, most); };
        const bool is = Double::normalise(kept(x), kept(y), kept(z), ux, uy, uz);
        sharpened(ux, uy, uz);
        return is;
    }
    QRAY_INLINE static constexpr void sharpen(double& x, double& y, double& z)
    {
        Double::sharpen(x, y, z);
        sharpened(x, y, z);
    }

private:
    QRAY_INLINE static constexpr double largest(double a, double b)
    {
        const double u = absolute(a), v = absolute(b);
        return u > v ? u : v;
    }
    QRAY_INLINE static constexpr void sharpened(double& x, double& y, double& z)
    {
        x = keep<S>(x);
        y = keep<S>(y);
        z = keep<S>(z);
    }
};

struct Stepped : Double {
    // Is it this file of the tracer, or one of this folder, that asks? Known when it is compiled.
    QRAY_INLINE static bool is_in(const char* file, const char* room)
    {
        const char* const at = __builtin_strstr(file, room);
        return at != nullptr && __builtin_strchr(at + __builtin_strlen(room), '/') == nullptr;
    }

    QRAY_INLINE static double length(double v, const char* file = __builtin_FILE())
    {
        return is_in(file, "vector/") ? keep<Step::point>(v) : keep<Step::projection>(v);
    }
    QRAY_INLINE static double unit(double v, const char* file = __builtin_FILE())
    {
        return is_in(file, "texture/") ? v // rounded as a share
            : is_in(file, "trace/trace.") || is_in(file, "see_through") ? keep<Step::weight>(v)
                                                                        : keep<Step::cosine>(v);
    }
    QRAY_INLINE static constexpr double colour(double v) { return keep<Step::colour>(v); }

    QRAY_INLINE static double fine(double v, int32_t by) { return by < 0 ? v / (1 << -by) : v * (1 << by); }
    QRAY_INLINE static double fine_sub(double a, double b, int32_t by)
    {
        return keep<Step::perpendicular>(fine(a - b, by));
    }
    QRAY_INLINE static double coarse(double v, int32_t by, const char* file = __builtin_FILE())
    {
        v = fine(v, -by);
        return is_in(file, "vector/") ? keep<Step::point>(v) : keep<Step::t>(v);
    }
    QRAY_INLINE static double coarse_above(double v, int32_t by) { return fine(v, -by) + 0.125; }

    QRAY_INLINE static double sqrt(double a) { return keep<Step::root>(Double::sqrt(a)); }
    QRAY_INLINE static double root(double a) { return keep<Step::root>(Double::root(a)); }
    QRAY_INLINE static constexpr double quotient(double v)
    {
        if (__builtin_is_constant_evaluated())
            return v;
        return keep<Step::t>(significant(v, widths[Step::quotient], v));
    }
    QRAY_INLINE static bool quotient(double num, double den, int, double& t)
    {
        const bool is = Double::quotient(num, den, 0, t);
        t = quotient(t);
        return is;
    }
    QRAY_INLINE static double ratio(double v, double inverse_r) { return keep<Step::curved>(v * inverse_r); }
    static bool weights(double a, double b, double c, double& wa, double& wb, double& wc)
    {
        const bool is = Double::weights(a, b, c, wa, wb, wc);
        wa = keep<Step::curved>(wa);
        wb = keep<Step::curved>(wb);
        wc = keep<Step::curved>(wc);
        return is;
    }
    QRAY_INLINE static void sharpen(double& x, double& y, double& z) { Within<Step::normal>::sharpen(x, y, z); }
    QRAY_INLINE static double power_whole(double x, Shine e)
    {
        return keep<Step::power>(Double::power_whole(keep<Step::power>(x), e));
    }
    QRAY_INLINE static double power(double x, Shine e)
    {
        return keep<Step::power>(Double::power(keep<Step::power>(x), e));
    }
};

static_assert(NumberSystem<Stepped> && NumberSystem<Within<Step::normal>>);

} // namespace qray::study

namespace qray {

// No reject: what rounding makes of a shape's edge shall show.
template <>
struct RejectRay<study::Stepped> {
    explicit RejectRay(const Ray<study::Stepped>&) {}
    static bool misses_ball(const Point<study::Stepped>&, double) { return false; }
    static bool misses_plane(const Point<study::Stepped>&, const Direction<study::Stepped>&) { return false; }
};

// As in q32, where it is asked for.
template <>
inline constexpr Vec<double> from_exact<study::Stepped>(const Vec<double>& p, const Rounded<study::Stepped>& rounded)
{
    return p + Vec<double>{rounded.x, rounded.y, rounded.z};
}
template <>
inline constexpr Vec<double> from_rounded<study::Stepped>(const Vec<double>& p, const Rounded<study::Stepped>& rounded)
{
    return p - Vec<double>{rounded.x, rounded.y, rounded.z};
}

// What a colour is multiplied by.
template <>
inline constexpr void add_scaled<study::Stepped>(Vec<double>& sum, double k, const Vec<double>& light)
{
    k = study::keep<study::Step::share>(k);
    sum = sum + Vec<double>{study::Stepped::colour(light.x * k), study::Stepped::colour(light.y * k),
                            study::Stepped::colour(light.z * k)};
}
template <>
inline constexpr void saturating_add<study::Stepped>(Vec<double>& sum, const Vec<double>& light, double k)
{
    add_scaled<study::Stepped>(sum, k, light);
}
template <>
inline constexpr Vec<double> filtered<study::Stepped>(const Vec<double>& light, const Vec<double>& m)
{
    const Vec<double> k = study::keep<study::Step::share>(m);
    return {study::Stepped::colour(light.x * k.x), study::Stepped::colour(light.y * k.y),
            study::Stepped::colour(light.z * k.z)};
}

// Where a ray starts that leaves a surface: as in fixed point, a few last bits of a point off it.
template <>
inline constexpr Vec<double> step_off<study::Stepped>(const Vec<double>& q, const Vec<double>& g, bool outward)
{
    using study::Step;
    if (__builtin_is_constant_evaluated() || study::widths[Step::point] >= study::exact)
        return step_off<Double>(q, g, outward);
    const double size = 2 * study::roundings[static_cast<int>(Step::point)].half * study::widths.leave;
    return q + study::keep<Step::point>(scaled<Double>(outward ? size : -size, g));
}

// In fixed point the place in a light map is rounded down.
template <>
inline constexpr int32_t LightSteps<study::Stepped>::operator()(const Vec<double>& q) const
{
    const double at = dot<Double>(q, row);
    if (!__builtin_is_constant_evaluated() && study::widths[study::Step::map] < study::exact)
        return static_cast<int32_t>(study::Rounding(0, true)(at)) + offset;
    return static_cast<int32_t>(at) + offset;
}

// Exact in fixed point: see corners.hpp.
template <>
inline constexpr Sheared<study::Stepped> Shear<study::Stepped>::operator()(const Point<study::Stepped>& v) const
{
    const Moments m = exact(v);
    return {m.x, m.y};
}

template <>
inline constexpr bool Pencil<study::Stepped>::unit(Vec<double>& d) const
{
    return study::Within<study::Step::camera>::normalise(x, y, z, d.x, d.y, d.z);
}
template <>
inline constexpr bool normalise_short<study::Stepped, double>(const Vec<double>& v, Vec<double>& u)
{
    return normalise_short<study::Within<study::Step::normal>>(v, u);
}
template <>
inline constexpr Vec<double> mirrored<study::Stepped>(const Vec<double>& d, const Vec<double>& n, double n_d)
{
    return mirrored<study::Within<study::Step::mirrored>>(d, n, n_d);
}
template <>
inline constexpr bool refracted<study::Stepped>(const Vec<double>& d, const Vec<double>& n, double n_d, double eta,
                                                Vec<double>& out)
{
    return refracted<study::Within<study::Step::refracted>>(d, n, n_d, eta, out);
}
template <>
inline constexpr bool intersect_plane<study::Stepped>(double num, double den, double limit, double& t)
{
    if (!intersect_plane<Double>(num, den, Double::length_max, t))
        return false;
    t = study::Stepped::quotient(t);
    return t > 0 && t <= limit;
}
template <>
inline constexpr Vec<double> on_plane<study::Stepped>(const Vec<double>& c, const Vec<double>& normal,
                                                      const Vec<double>& q)
{
    return study::keep<study::Step::point>(on_plane<Double>(c, normal, q));
}
// Colours are often round decimals, whose 255-fold ends on a half. As in fixed point, those that rounding left up to 4
// steps below it count as on it, but where that would be seen.
template <>
inline constexpr uint8_t Sample<study::Stepped>::byte(double v)
{
    if (!__builtin_is_constant_evaluated())
        if (const int bits = study::widths[study::Step::colour]; bits >= 20)
            v += 8 * study::Rounding(bits).half + 0x1p-50;
    return static_cast<uint8_t>(v * 255 + 0.5);
}

template <>
inline constexpr Cell<study::Stepped> LatticeAxis<study::Stepped>::split(double p)
{
    const Cell<Double> c = LatticeAxis<Double>::split(study::keep<study::Step::texture>(p));
    return {c.index, c.inside};
}
template <>
inline constexpr double LatticeAxis<study::Stepped>::clamped(const Vec<double>& q) const
{
    const double p = study::keep<study::Step::texture>(row_dot(q) + offset);
    return p > 0 ? p < 1 ? p : 1 : 0;
}

namespace scene {

// What a scene's numbers become.
template <>
inline double Convert<study::Stepped>::length(double v)
{
    return study::keep<study::Step::coordinate>(v);
}
template <>
inline Rounded<study::Stepped> Convert<study::Stepped>::rounded(const Vec3d& p, int fine)
{
    const auto rest = [fine](double v) { return length(ldexp(length(v) - v, fine)); };
    return study::widths.keeps_rest ? Rounded<study::Stepped>{rest(p.x), rest(p.y), rest(p.z)}
                                    : Rounded<study::Stepped>{};
}
template <>
inline Vec<double> Convert<study::Stepped>::direction(const Vec3d& d)
{
    return study::keep<study::Step::normal>(Vec<double>{d.x, d.y, d.z});
}
template <>
inline double Convert<study::Stepped>::eta(double v)
{
    return study::keep<study::Step::eta>(v);
}
template <>
inline LatticeAxis<study::Stepped> Convert<study::Stepped>::axis(const Vec3d& row, const Vec3d& origin, double scale,
                                                                 double offset, bool wraps)
{
    const auto a = Convert<Double>::axis(row, origin, scale, offset, wraps);
    const double most = fmax(fabs(a.row_x), fmax(fabs(a.row_y), fabs(a.row_z)));
    const auto kept = [most](double v) { return study::significant(v, study::widths[study::Step::row], most); };
    return {kept(a.row_x), kept(a.row_y), kept(a.row_z), a.inside, a.index, a.offset};
}
template <>
inline Vec<double> Convert<study::Stepped>::surface(const Vec3d& c)
{
    return {c.x, c.y, c.z};
}
// What keeps surfaces in a lattice's plane clean: not less than a hit point may be off, as where products have 32 bits.
template <>
inline double TextureBuilder<study::Stepped>::Make::epsilon() const
{
    const int bits = study::widths[study::Step::point];
    return bits >= study::exact ? 1.0 / 1024 : fmax(1.0 / 1024, ldexp(1.5, -bits) / (t.size * frame.scale));
}
template <>
inline int Builder<study::Stepped>::fine_for(double size, Blocks::Of Blocks::*of) const
{
    const Blocks* const blocks = study::widths.blocks;
    if (blocks == nullptr)
        return 0;
    const double with_slack = ldexp(size * frame.scale, study::widths.length) + blocks->slack;
    const Blocks::Of& block = blocks->*of;
    int fine = block.least;
    while (fine < block.most && ldexp(with_slack, fine + 1) <= block.size)
        fine++;
    return fine;
}

} // namespace scene

} // namespace qray

namespace qray::study {

// Functions that are found by what they are asked of.
inline bool towards(const Light<Stepped>& lamp, const Point<Stepped>& q, Direction<Stepped>& l, double& distance)
{
    const bool is = qray::towards<Stepped>(lamp, q, l, distance);
    l = keep<Step::light>(l);
    return is;
}
inline bool towards(const Sun<Stepped>& sun, const Point<Stepped>&, Direction<Stepped>& l, double& distance)
{
    l = keep<Step::light>(sun.from);
    distance = Stepped::length_max;
    return true;
}
template <Effects E>
Rgb<Stepped> light_of_surfaces(const Scene<Stepped, E>& scene, Tag tag, bool inside, const Point<Stepped>& q)
{
    return keep<Step::map>(qray::light_of_surfaces<Stepped, E>(scene, tag, inside, q));
}
// As in fixed point, where the rounding of v.d does not reach the normal.
inline void surface_of(const Sphere<Stepped>& s, const Corners<Stepped>& corners, const Ray<Stepped>& ray, double t,
                       Local<Stepped> local, Point<Stepped>& point, Direction<Stepped>& n)
{
    local.offset -= dot<Stepped>(local.near, ray.direction);
    qray::surface_of<Stepped>(s, corners, ray, t, local, point, n);
}

// Where a tree would say which shapes a ray meets, what rounding makes of their edges would not show. It is taken for
// what is too large without: nearly all are triangles then, and the inside of these is exact.
inline constexpr uint32_t few_objects = 200;
template <bool Tree>
constexpr Effects stepped_effects()
{
    Effects e = scene::desktop_effects();
    e.tree = Tree;
    e.grid = e.adaptive = false;
    return e;
}

// What a scene says of its materials and its lights.
inline void round_tables(scene::Storage<Stepped>& s)
{
    const auto all = []<Step S, class T, class M>(std::integral_constant<Step, S>, scene::Array<T>& table,
                                                  M T::*member) {
        for (uint32_t i = 0; i < table.count; i++)
            table.data[i].*member = keep<S>(table.data[i].*member);
    };
    constexpr std::integral_constant<Step, Step::weight> weight;
    constexpr std::integral_constant<Step, Step::colour> colour;
    all(weight, s.mattes, &Matte<Stepped>::diffuse);
    all(weight, s.highlights, &Highlight<Stepped>::amount);
    all(weight, s.mirrors, &Mirror<Stepped>::amount);
    all(weight, s.transmits, &Transmit<Stepped>::amount);
    s.cutoff = keep<Step::weight>(s.cutoff);
    all(colour, s.mattes, &Matte<Stepped>::ambient);
    all(colour, s.even_lights, &EvenLight<Stepped>::light);
#define QRAY_ROUND(Type, name, table) all(colour, s.table, &Type<Stepped>::colour);
    QRAY_LIGHTS(QRAY_ROUND)
#undef QRAY_ROUND
    s.background = keep<Step::colour>(s.background);
}

} // namespace qray::study
