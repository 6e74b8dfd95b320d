// The shapes: random ones, rays thrown at them, and where those meet them according to an oracle that works on
// the shape as it is stored, in a number system N, and a ray as that is, in N or another, M.
#pragma once

#include "figures.hpp"

namespace hostile {

template <class N>
struct SphereTrial {
    static constexpr const char* name = "sphere";
    static constexpr bool curved = true;
    static constexpr Effects effects{.sphere = true};
    Bench<N> bench;
    const qray::Sphere<N>& shape = bench.storage.spheres.data[0];
    Double3 centre;
    double radius;

    void make(Random& random, Regime regime)
    {
        radius = random_size(random, regime);
        centre = random_place(random, regime, radius);
        auto o = bench.object(qray::Kind::sphere);
        o.a = centre;
        o.ra = radius;
        bench.build(o);
    }
    qray::Ray<N> aim(Random& random, Regime regime) const
    {
        using namespace qray::scene;
        if (regime == Regime::grazing) {
            const Double3 n = direction(random);
            return ray_along<N>(random, centre + n * (radius * random.in(0.999, 1.001)), across(random, n));
        }
        return ray_at<N>(random, regime, centre + in_ball(random, 1.5 * radius));
    }
    template <class R, class M>
    Meetings<R> meet(const qray::Ray<M>& ray) const
    {
        const Vec3<R> d = exact3<R>(ray.direction), v = exact_centre<R, N>(shape.centre, shape) - exact3<R>(ray.origin);
        const R r = exact<R>(shape.radius) / two_to<R>(shape.fine), d2 = dot(d, d), b = dot(v, d) / d2;
        const Vec3<R> p = v - d * b;
        const R rest = r * r - dot(p, p);
        Meetings<R> m;
        if (rest < 0)
            return m;
        const R half = root(rest / d2);
        m.add(b - half, r, half / r);
        m.add(b + half, r, half / r);
        return m;
    }
    // How far a point lies outside.
    Wide outside(const Vec3<Wide>& p) const
    {
        return length(p - exact_centre<Wide, N>(shape.centre, shape))
            - exact<Wide>(shape.radius) / two_to<Wide>(shape.fine);
    }
};

template <class N>
struct DiscTrial {
    static constexpr const char* name = "disc";
    static constexpr bool curved = false;
    static constexpr Effects effects{.disc = true};
    Bench<N> bench;
    const qray::Disc<N>& shape = bench.storage.discs.data[0];
    Double3 centre, normal;
    double radius;
    double beyond = 1.5; // rays are aimed within that many radii

    void make(Random& random, Regime regime)
    {
        radius = random_size(random, regime);
        centre = random_place(random, regime, 1.5 * radius);
        normal = direction(random);
        auto o = bench.object(qray::Kind::disc);
        o.a = centre;
        o.b = normal;
        o.ra = radius;
        bench.build(o);
    }
    qray::Ray<N> aim(Random& random, Regime regime) const
    {
        using namespace qray::scene;
        const Double3 side = across(random, normal);
        if (regime != Regime::grazing)
            return ray_at<N>(random, regime, centre + side * (beyond * radius * std::sqrt(random.unit())));
        if (random.chance(0.5)) {
            Double3 d = direction(random);
            return ray_along<N>(random, centre + side * (radius * random.in(0.999, 1.001)), d);
        }
        const Double3 d = unit(across(random, normal) + normal * random.in(-1e-3, 1e-3));
        return ray_along<N>(random, centre + side * (beyond * radius * std::sqrt(random.unit())), d);
    }
    template <class R, class M>
    Meetings<R> meet(const qray::Ray<M>& ray) const
    {
        const Vec3<R> d = exact3<R>(ray.direction), v = exact3<R>(shape.centre) - exact3<R>(ray.origin);
        const Vec3<R> n = exact3<R>(shape.normal);
        const R den = dot(d, n);
        Meetings<R> m;
        if (den == 0)
            return m;
        const R t = dot(v, n) / den;
        m.add(t, exact<R>(shape.radius) - length(d * t - v), size(den));
        return m;
    }
    Wide outside(const Vec3<Wide>& p) const
    {
        return dot(p - exact3<Wide>(shape.centre), exact3<Wide>(shape.normal));
    }
};

// A plane is a disc that fills the world.
template <class N>
struct PlaneTrial : DiscTrial<N> {
    static constexpr const char* name = "plane";
    void make(Random& random, Regime)
    {
        using namespace qray::scene;
        const Double3 n = direction(random);
        const double height = random.in(-40, 40);
        this->beyond = 0.99;
        this->radius = std::sqrt((world - 0.25) * (world - 0.25) - height * height);
        this->centre = n * height;
        this->normal = n;
        auto o = this->bench.object(qray::Kind::disc);
        o.ra = HUGE_VAL; // a plane
        o.a = this->centre + across(random, n) * random.in(0, 30);
        o.b = n;
        this->bench.build(o);
    }
    qray::Ray<N> aim(Random& random, Regime regime) const
    {
        using namespace qray::scene;
        if (regime == Regime::ordinary)
            return ray_at<N>(random, regime, in_ball(random, world));
        if (regime == Regime::small_far) // from close by to far away
        {
            const Double3 n = this->normal;
            const Double3 from = this->centre + across(random, n) * random.in(0, this->radius * 0.7)
                + n * random.logarithmic(0.001, 1);
            return free_ray<N>(random, from, across(random, n) * 30 - n * random.logarithmic(0.001, 1));
        }
        return DiscTrial<N>::aim(random, regime);
    }
};

template <class N>
struct ConeTrial {
    static constexpr const char* name = "cone";
    static constexpr bool curved = true;
    static constexpr Effects effects{.cone = true};
    Bench<N> bench;
    const qray::Cone<N>& shape = bench.storage.cones.data[0];
    Double3 base, axis;
    double height, ra, rb;

    void make(Random& random, Regime regime)
    {
        const double s = random_size(random, regime);
        make(random, regime, s * random.in(0.2, 1), s * random.in(0.2, 1), random.below(4));
    }
    void make(Random& random, Regime regime, double a, double half, uint32_t kind)
    {
        ra = a;
        rb = kind == 0 ? 0 : kind == 1 ? a * random.in(0.999, 1.001) : a * random.unit();
        height = 2 * half;
        place(random, regime);
    }
    void place(Random& random, Regime regime)
    {
        using namespace qray::scene;
        const double bound = std::sqrt(height * height / 4 + std::fmax(ra, rb) * std::fmax(ra, rb));
        axis = direction(random);
        base = random_place(random, regime, bound + 0.1) - axis * (height / 2);
        auto o = bench.object(qray::Kind::cone);
        o.a = base;
        o.b = base + axis * height;
        o.ra = ra;
        o.rb = rb;
        bench.build(o);
    }
    qray::Ray<N> aim(Random& random, Regime regime) const
    {
        using namespace qray::scene;
        const Double3 side = across(random, axis);
        const double share = random.unit(), r = ra + (rb - ra) * share;
        const Double3 centre = base + axis * (height * share);
        if (regime != Regime::grazing)
            return ray_at<N>(random, regime, centre + side * (1.5 * (r + 0.1 * ra) * std::sqrt(random.unit())));
        // Near a tangent plane: through it, and a half of the time close to a generator too.
        const double growth = (rb - ra) / height;
        const Double3 generator = unit(axis + side * growth), sideways = cross(axis, side);
        const Double3 d = random.chance(0.5)
            ? unit(generator + sideways * random.in(-1e-2, 1e-2) + side * random.in(-1e-3, 1e-3))
            : unit(sideways + generator * random.in(-2, 2));
        return ray_along<N>(random, centre + side * (r * random.in(0.999, 1.001)), random.chance(0.5) ? d : d * -1);
    }
    template <class R, class M>
    Meetings<R> meet(const qray::Ray<M>& ray) const
    {
        Vec3<R> a = exact3<R>(shape.axis);
        a = a * (1 / length(a));
        const R c = exact<R>(shape.cosine), s = exact<R>(shape.sine);
        const Vec3<R> d = exact3<R>(ray.direction), v = exact_centre<R, N>(shape.middle, shape) - exact3<R>(ray.origin);
        const R b = dot(v, d) / dot(d, d);
        const Vec3<R> o = d * b - v;
        const R oz = dot(o, a), dz = dot(d, a), scale = two_to<R>(shape.fine);
        const R rho = exact<R>(shape.rho0) / scale + s * oz;
        const Vec3<R> op = o - a * oz, dp = d - a * dz;
        const R aa = c * c * dot(dp, dp) - s * s * dz * dz, bb = c * c * dot(op, dp) - rho * s * dz;
        const R cc = c * c * dot(op, op) - rho * rho, disc = bb * bb - aa * cc;
        Meetings<R> m;
        if (disc < 0)
            return m;
        const R q = bb < 0 ? root(disc) - bb : -(root(disc) + bb), half = exact<R>(shape.half) / scale;
        // Both nappes: the rims leave one.
        const auto meeting = [&](R tau) {
            const R z = oz + tau * dz, sine = root(disc) / size(rho + s * tau * dz);
            // Almost along a generator the roots are as uncertain as B / A is, whose B is known to an ulp of rho.
            m.add(b + tau, half - size(z), sine < size(aa) / (1 + rho) ? sine : size(aa) / (1 + rho));
        };
        if (aa != 0)
            meeting(q / aa);
        if (q != 0)
            meeting(cc / q);
        m.sort();
        return m;
    }
    Wide outside(const Vec3<Wide>& p) const
    {
        Vec3<Wide> a = exact3<Wide>(shape.axis);
        a = a * (1 / length(a));
        const Vec3<Wide> w = p - exact_centre<Wide, N>(shape.middle, shape);
        const Wide z = dot(w, a);
        return exact<Wide>(shape.cosine) * length(w - a * z)
            - (exact<Wide>(shape.rho0) / two_to<Wide>(shape.fine) + exact<Wide>(shape.sine) * z);
    }
};

template <class N>
struct CylinderTrial : ConeTrial<N> {
    static constexpr const char* name = "cylinder";
    void make(Random& random, Regime regime)
    {
        const double s = random_size(random, regime);
        this->ra = this->rb = s * random.in(0.1, 1);
        this->height = 2 * s * random.in(0.2, 1);
        this->place(random, regime);
    }
};

} // namespace hostile
