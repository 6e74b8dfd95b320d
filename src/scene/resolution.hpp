// What a number system cannot tell apart in a scene: where the eye may stand, which objects span too few steps, and
// which surfaces fall together. The bounds were measured against tests/oracle, so that what is below them is not drawn
// right (28 dB in q16, 40 dB in q24, 60 dB in q32, 45 dB in float), and what is above them is.
#pragma once

#include <algorithm>
#include <tuple>

#include "convert.hpp"
#include "frame.hpp"
#include "shapes.hpp"

namespace qray::scene {

template <class N>
struct Steps {
    // Rays that start so many steps off a surface meet it.
    static constexpr double off = NarrowFixed<N> ? 5 : 3;
    // Of two surfaces, where one lets rays through, and where none does.
    static constexpr double clear_apart = NarrowFixed<N> ? 4 : N::is_fixed ? 48 : 4, apart = 1.6;
    // Of a picture's height, where the object is.
    static constexpr double picture = ShortFixed<N> ? 300 : N::is_fixed ? 6144 : SingleFloat<N> ? 2048 : 0x1p28;
    // How much of a picture's height the horizon of a curved surface may move, and how many steps it is off anyway.
    static constexpr double horizon = ShortFixed<N> ? 1.0 / 256 : N::is_fixed ? 2e-3 : 4e-3;
    static constexpr double tapered_horizon = SingleFloat<N> ? horizon / 8 : horizon;
    static constexpr double rough = NarrowFixed<N> ? 1 : 0;
};

template <class N>
class Resolution {
public:
    Resolution(const Description& from, const Frame& in, Warning& into)
        : d(from), frame(in), lost(into), forward(unit(from.view.at - from.view.from)),
          half(tan(from.view.angle * (M_PI / 360)))
    {
    }

    // The least difference of coordinates as large as the world, in the scene's own units.
    double step() const { return step_at(world / frame.scale); }
    // Of coordinates of that size.
    double step_at([[maybe_unused]] double size) const
    {
        if constexpr (N::is_fixed)
            return ldexp(1 / frame.scale, -N::Length::frac);
        else
            return static_cast<double>(N::epsilon) * size;
    }

    // Of the radius of a ball, in such steps: more than one where it takes more bits than may be squared; else 0.
    double coarse([[maybe_unused]] const Object& o) const
    {
        int fine = 0;
        if constexpr (NarrowFixed<N>)
            fine = is_ball(o.kind) ? block_scale<N>(Convert<N>::length(o.ra * frame.scale), &Blocks::ball) : 0;
        return fine < 0 ? ldexp(1, -fine) : 0;
    }

    // What double makes of the distance 0 from p to the surface with this normal.
    double noise(const Object& o, const Vec3d& n, const Vec3d& p) const
    {
        const Vec3d at = place(o), v = p - at;
        const auto part = [](double a, double b, double along) { return (fabs(a) + fabs(b)) * fabs(along); };
        const bool curved = widest(o) < HUGE_VAL, exact = largest(n) == 1, apex = largest(n) == 0;
        return 0x1p-50 * (part(p.x, at.x, n.x) + part(p.y, at.y, n.y) + part(p.z, at.z, n.z)
                          + (curved ? widest(o) + largest(v) : exact ? 0 : largest(v))
                          + (apex ? largest(p) + largest(at) : 0));
    }

    // The text's eye or, where that is off a surface by less than what rays need to meet it, as much as that.
    Vec3d eye()
    {
        Vec3d at = d.view.from;
        bool moved = true;
        for (int round = 0; moved && round < 8; round++) {
            moved = false;
            for_each_near(d.view.from, Steps<N>::off * step() + length(at - d.view.from), [&](const Near& s) {
                const Object& o = s.object;
                const Above& text = s.above;
                const double most = fmin((Steps<N>::off + coarse(o)) * step(), share() * widest(o));
                const double side = text.height < 0 ? -1 : 1;
                if (round == 0)
                    horizon(o, text, fmax(most, text.height));
                const Above now = lies_on(d, o, s.part, at, s.off);
                if (is_on(o, text) || !now.near || !(length(now.outward) > 0) || side * now.height > 0.99 * most)
                    return true;
                at = at + now.outward * (side * most - now.height);
                moved = true;
                if (round == 7)
                    lost.note({o.line, 0}, "the eye, %.3g off a %s, falls onto it where steps are %.3g",
                              fabs(text.height), name_of(o), step());
                return true;
            });
        }
        return at;
    }

    // Seen from outside, where does what is curved end?
    void horizon(const Object& o, const Above& text, double seen_from)
    {
        const double r = widest(o), off = text.height;
        if (r == HUGE_VAL || off < 0 || is_on(o, text) || fabs(dot(text.outward, forward)) > sin(half_diagonal()))
            return;
        const double moved = sqrt(2 * seen_from / r) - sqrt(2 * off / r)
            + fmax(Steps<N>::rough, coarse(o) / 2) * step() / sqrt(2 * seen_from * r);
        if (moved > (is_ball(o.kind) || o.ra == o.rb ? Steps<N>::horizon : Steps<N>::tapered_horizon) * 2 * half)
            lost.note({o.line, 0}, "the eye, %.3g off a %s, sees its horizon from %.3g off, where steps are %.3g", off,
                      name_of(o), seen_from, step());
    }

    // The first surface that the eye lies on: its number, 0 at least; or -1.
    int64_t eye_surface(uint32_t& fill, Vec3d& outward) const
    {
        int64_t found = -1;
        const double off = 0x1p-44 * (frame.radius + largest(d.view.from));
        for_each_near(d.view.from, off, [&](const Near& s) {
            if (!is_on(s.object, s.above))
                return true;
            fill = s.object.fill;
            outward = s.above.outward;
            found = s.place;
            return false;
        });
        return found;
    }

    // Where the eye may leave it, nothing is known of a surface that it is on.
    void moving_eye(Warning& unmoved) const
    {
        const double off = Steps<N>::off * step();
        for_each_near(d.view.from, off, [&](const Near& s) {
            unmoved.note({s.object.line, 0},
                         "the eye, %.3g off a %s, does not know of it where something moves: rounding decides whether "
                         "it sees it; expected an eye %.3g off",
                         fabs(s.above.height), name_of(s.object), off);
            return true;
        });
    }

    // Calls f(object, place, outward normal, side) for the surfaces that hold a light at p, or lie as near as rounding.
    template <class F>
    void light_surfaces(const Vec3d& p, F f) const
    {
        for_each_near(p, fmax(Steps<N>::off * step(), 0x1p-44 * (frame.radius + largest(p))), [&](const Near& s) {
            const bool on = fabs(s.above.height) <= 16 * noise(s.object, s.above.outward, p); // it may be computed
            f(s.object, s.place, s.above.outward, on ? 0 : s.above.height > 0 ? 1 : -1);
            return true;
        });
    }

    // The same for the flat surfaces in whose plane a panel lies, and that have a part of it near them.
    template <class F>
    void panel_surfaces(const LightSource& l, F f) const
    {
        const double off = fmax(Steps<N>::off * step(), 0x1p-44 * (frame.radius + largest(l.at)));
        const Vec3d reach{fabs(l.u.x) + fabs(l.v.x) + off, fabs(l.u.y) + fabs(l.v.y) + off,
                          fabs(l.u.z) + fabs(l.v.z) + off};
        uint32_t first = 0;
        for (uint32_t i = 0; i < d.object_count; first += surfaces_of(d.objects[i++])) {
            const Object& o = d.objects[i];
            Extent box;
            add_object(box, d, o);
            box = {box.low - reach, box.high + reach};
            if (widest(o) < HUGE_VAL || !(is_endless(o) || box.holds(l.at)))
                continue;
            for (uint32_t part = 0; part < surfaces_of(o); part++) {
                const auto [met, height, n] = over(o, l.at, part);
                if (met && fabs(height) + fabs(dot(n, l.u)) + fabs(dot(n, l.v)) <= off)
                    f(o, first + part, n, fabs(height) <= 16 * noise(o, n, l.at) ? 0 : height > 0 ? 1 : -1);
            }
        }
    }

    // Does an object in view span steps enough? Of a plane that has a pattern, what is nearest in view.
    void span(const Object& o)
    {
        if (is_endless(o)) {
            if (d.fills[o.fill].texture.kind == TextureKind::none)
                return;
            const Above from = lies_on(d, o, 0, d.view.from, HUGE_VAL);
            const double side = from.height < 0 ? -1 : 1;
            const double turned = acos(fmax(-1, fmin(1, -dot(from.outward, forward) * side))) - half_diagonal();
            const double away = fabs(from.height) / cos(fmax(0, turned));
            if (turned < M_PI / 2 && away != 0 && away <= frame.far + frame.radius)
                span(o, d.view.from + forward * away, away, HUGE_VAL);
            return;
        }
        Extent box;
        add_object(box, d, o);
        const Vec3d middle = box.middle(), v = middle - d.view.from;
        const double r = length(box.high - box.low) / 2, away = length(v);
        if (away > r && r * d.view.height >= half * away
            && acos(fmax(-1, fmin(1, dot(v, forward) / away))) - asin(r / away) <= half_diagonal())
            span(o, middle, away, r);
    }

    // Which surfaces lie so close that what is between them is lost? `sorted` has room for all objects.
    void pairs(SortedObject* sorted)
    {
        double near = Steps<N>::clear_apart * step();
        if constexpr (N::is_fixed)
            near = ldexp(near, -N::blocks.ball.least);
        uint32_t count = 0;
        for (uint32_t i = 0; i < d.object_count; i++)
            if (const Object& o = d.objects[i]; is_flat(o) || widest(o) < HUGE_VAL) {
                const Vec3d k = key(o);
                sorted[count++] = {is_flat(o) ? flat : static_cast<uint32_t>(o.kind), i, k.x, k.y, k.z};
            }
        std::sort(sorted, sorted + count, [](const SortedObject& a, const SortedObject& b) {
            return std::tie(a.group, a.x, a.y, a.z, a.index) < std::tie(b.group, b.x, b.y, b.z, b.index);
        });
        for (uint32_t i = 0; i < count; i++)
            for (uint32_t k = i + 1; k < count && k < i + neighbours; k++) {
                const SortedObject &a = sorted[i], &b = sorted[k];
                if (b.group != a.group || b.x - a.x > near)
                    break;
                // The tiles of one floor are told apart here: there may be many.
                if (fmax(fabs(b.y - a.y), fabs(b.z - a.z)) > near
                    || (a.group == flat && b.x - a.x <= 0x1p-52 * b.x))
                    continue;
                pair(d.objects[std::min(a.index, b.index)], d.objects[std::max(a.index, b.index)]);
            }
    }

private:
    static constexpr uint32_t neighbours = 64, flat = UINT32_MAX; // of all that is flat, the group

    const Description& d;
    const Frame& frame;
    Warning& lost;
    const Vec3d forward;
    const double half; // of the picture's height, at a distance of 1

    // Of a radius, as much as leaves normals of unit length.
    static double share()
    {
        if constexpr (N::is_fixed)
            return NarrowFixed<N> ? 0x1p-5 : 0x1p-8;
        else
            return sqrt(static_cast<double>(N::epsilon)) / 4;
    }

    double half_diagonal() const { return atan(half * sqrt(1 + pow(double(d.view.width) / d.view.height, 2))); }

    bool is_on(const Object& o, const Above& eye) const
    {
        return fabs(eye.height) <= noise(o, eye.outward, d.view.from);
    }

    // A surface that a point of the text is near, no farther than `off`.
    struct Near {
        const Object& object;
        uint32_t place, part;
        double off;
        Above above;
    };
    // For each that is no farther than `off` from p, until it returns false.
    template <class Visit>
    void for_each_near(const Vec3d& p, double off, Visit visit) const
    {
        uint32_t place = 0;
        for (uint32_t i = 0; i < d.object_count; i++) {
            const Object& o = d.objects[i];
            const double most = fmin(off + coarse(o) * step(), share() * widest(o));
            for (uint32_t part = 0; part < surfaces_of(o); part++, place++)
                if (const Above above = lies_on(d, o, part, p, most);
                    above.near && !visit(Near{o, place, part, most, above}))
                    return;
        }
    }

    // Of a part of it of radius r, `away` from the eye.
    void span(const Object& o, const Vec3d& middle, double away, double r)
    {
        const double picture = 2 * half * away;
        const double error = fmax(fmax(across_view(middle, middle - d.view.from), coarse(o) * step()), frame.pushed);
        if (picture >= Steps<N>::picture * error)
            return;
        if (2 * r < picture)
            lost.note({o.line, 0}, "a %s spans only %.3g steps of %.3g", name_of(o), 2 * r / error, error);
        else
            lost.note({o.line, 0}, "at a %s the picture spans only %.3g steps of %.3g", name_of(o), picture / error,
                      error);
    }

    // By how much an object may seem to lie beside where it is.
    double across_view(const Vec3d& middle, const Vec3d& v) const
    {
        if constexpr (N::is_fixed) {
            return step();
        } else {
            const auto part = [](double a, double b, double c, double along) {
                const double m = fmax(fabs(a), fmax(fabs(b), fabs(c)));
                return m * m * (1 - along * along);
            };
            const Vec3d e = frame.eye - frame.origin, m = middle - frame.origin;
            return static_cast<double>(N::epsilon)
                * sqrt(fmax(0, part(e.x, m.x, v.x, forward.x) + part(e.y, m.y, v.y, forward.y)
                                + part(e.z, m.z, v.z, forward.z)));
        }
    }

    // p as seen from the plane of what is flat.
    Above over(const Object& o, const Vec3d& p, uint32_t part = 0) const { return lies_on(d, o, part, p, HUGE_VAL); }
    Vec3d place(const Object& o) const { return o.count != 0 ? d.vertices[o.vertex] : o.a; }
    // What is the same in two objects that fall together comes first.
    Vec3d key(const Object& o) const { return is_flat(o) ? Vec3d{fabs(over(o, {}).height), 0, 0} : middle(d, o); }

    static bool clear(const Fill& f)
    {
        return f.transmit > 0.99 && f.ambient + f.diffuse + f.highlight + f.mirror == 0;
    }

    // How far apart are they, at most? HUGE_VAL where they have little in common.
    double apart(const Object& a, const Object& b) const
    {
        if (!is_flat(a))
            return with_host(a.kind, [&](auto host) { return host.apart(a, b); });
        const auto [met, height, n] = over(a, place(b));
        if (fabs(dot(n, over(b, {}).outward)) < 1 - 1e-9
            || !(covers(d, a, n, middle(d, b)) || covers(d, b, n, middle(d, a))))
            return HUGE_VAL;
        return fabs(height);
    }

    // Are they one surface after rounding?
    bool same(const Object& a, const Object& b) const
    {
        const auto length = [this](double v) { return Convert<N>::length(v * frame.scale); };
        const Point<N> p = Convert<N>::point(frame.point(place(a))), q = Convert<N>::point(frame.point(place(b)));
        if (is_flat(a)) {
            const Vec3d n = over(a, {}).outward;
            return (fabs(n.x) == 1 && p.x == q.x) || (fabs(n.y) == 1 && p.y == q.y) || (fabs(n.z) == 1 && p.z == q.z);
        }
        return p == q && length(a.ra * 16) == length(b.ra * 16) && length(a.rb * 16) == length(b.rb * 16);
    }

    // a stands before b in the text, and so is what is seen where they are one.
    void pair(const Object& a, const Object& b)
    {
        const Fill &f = d.fills[a.fill], &g = d.fills[b.fill];
        const bool opaque = f.transmit == 0 && g.transmit == 0;
        const double one = fmax(1, fmax(coarse(a), coarse(b)))
            * step_at(fmax(largest(frame.eye - frame.origin), largest(place(a) - frame.origin)));
        const double off = apart(a, b), least = (opaque ? Steps<N>::apart : Steps<N>::clear_apart) * one;
        if (off > least || off > widest(a) / 16 || (opaque && f == g)
            || off <= noise(a, is_flat(a) ? over(a, {}).outward : Vec3d{1, 0, 0}, place(b)))
            return;
        if (f.transmit == 0 && (clear(g) || in_front(a, b)) && same(a, b))
            return;
        lost.note({b.line, 0},
                  "a %s falls together with another surface, that of line %u, %.3g off, where steps are %.3g",
                  name_of(b), a.line, off, step());
    }
    bool in_front(const Object& a, const Object& b) const
    {
        if (!is_flat(a))
            return a.ra + a.rb > b.ra + b.rb; // the eye is outside
        return over(a, frame.eye).height * over(a, place(b)).height < 0;
    }
};

} // namespace qray::scene
