// The textbook forms beside a number system's own: the same shapes and rays, judged by the same oracle.
#pragma once

#include "../hostile/run.hpp"
#include "textbook.hpp"

namespace textbook {

// The arithmetic of a textbook that is as wide as a number system's.
template <class N>
struct Beside {
    using T = std::conditional_t<sizeof(typename N::Length) == 4, Real<float>, Real<double>>;
};
template <>
struct Beside<qray::q16> {
    using T = Fixed<16>;
};
template <>
struct Beside<qray::q24> : Beside<qray::q16> {};
template <>
struct Beside<qray::q32> {
    using T = Fixed<24>;
};

template <class T, qray::Effects E>
constexpr auto form()
{
    if constexpr (E.sphere)
        return Sphere<T>{};
    else if constexpr (E.disc)
        return Disc<T>{};
    else if constexpr (E.cone)
        return Cone<T>{};
    else if constexpr (E.polygon)
        return Polygon<T>{};
    else
        return Triangle<T>{};
}

template <class N, template <class> class TrialOf>
class Examiner {
    using Wide = hostile::Wide;
    using Quad = hostile::Quad;

public:
    using Trial = TrialOf<N>;
    using T = typename Beside<N>::T;
    hostile::Tally tally;

    void look_at(const Trial& t)
    {
        trial = &t;
        shape.look_at(t);
    }

    void answer(hostile::Random& random, const qray::Ray<N>& given, hostile::Regime,
                const hostile::Meetings<Wide>& m)
    {
        tally.rays++;
        const Ray<T> r = ray<T>(given);
        T t{};
        const bool hit = shape.hit(r, t);
        Wide expected{};
        bool meets = hostile::first(m, expected);
        if (hit != meets) {
            Quad quad{};
            meets = hostile::first(trial->template meet<Quad>(given), quad);
            expected = static_cast<Wide>(quad);
        }
        tally.wrong += hit != meets;
        if (hit && meets) {
            const double error = static_cast<double>(hostile::size(static_cast<Wide>(t.value()) - expected));
            tally.measured++;
            tally.sum += error;
            tally.worst = std::fmax(tally.worst, error);
        }
        tally.hits += hit;
        for (int i = 0; hit && i < 2; i++)
            rebound(random, r, t);
    }

private:
    const Trial* trial = nullptr;
    decltype(form<T, Trial::effects>()) shape;

    // Which way the surface at p faces.
    hostile::Double3 outward(const hostile::Vec3<Wide>& p) const
    {
        const Wide h = 1e-6L;
        const auto slope = [&](const hostile::Vec3<Wide>& step) {
            return static_cast<double>((trial->outside(p + step) - trial->outside(p - step)) / h);
        };
        return qray::scene::unit({slope({h, 0, 0}), slope({0, h, 0}), slope({0, 0, h})});
    }

    // As hostile::Examiner::rebound().
    void rebound(hostile::Random& random, const Ray<T>& from, T t)
    {
        const Vec<T> o = from.o + from.d * t;
        const hostile::Vec3<Wide> p{static_cast<Wide>(o.x.value()), static_cast<Wide>(o.y.value()),
                                    static_cast<Wide>(o.z.value())};
        const hostile::Double3 g = outward(p), d = spawned_direction(random, g);
        const Ray<T> next{o, {T::of(d.x), T::of(d.y), T::of(d.z)}};
        const qray::Ray<qray::Double> exactly{{o.x.value(), o.y.value(), o.z.value()},
                                              {next.d.x.value(), next.d.y.value(), next.d.z.value()},
                                              {qray::Tag::none}, false};
        tally.rebounds++;
        const hostile::Meetings<Wide> m = trial->template meet<Wide>(exactly);
        const bool inward = Trial::curved && dot(g, d) < 0;
        const Wide little = 64 * static_cast<Wide>(hostile::ulp<N>());
        bool deep = false;
        if (inward && m.count == 2 && m.within[1] > 0 && m.t[1] > 0 && m.certain(1, little))
            deep = trial->outside(p + hostile::exact3<Wide>(exactly.direction) * ((m.t[0] + m.t[1]) / 2))
                < -little / 4;
        T again{};
        const bool hit = shape.hit(next, again);
        tally.self_hits += hit && (!inward || (deep && static_cast<Wide>(again.value()) < m.t[1] / 2));
        tally.leaks += deep && !hit;
    }
};

} // namespace textbook
