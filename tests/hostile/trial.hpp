// What is asked of every shape, and the tally of the answers:
//   right hits    hit or miss, and t, against the oracle
//   rebounds      a ray that leaves a computed hit never finds the surface it left, and where it heads into a
//                 curved one finds its other side; the same of a second, equal object in the same place, which the
//                 ray does not know by name
//   both sides    followed straight on, a ray crosses a closed surface an even number of times; and the
//                 crossings counted for a shadow agree
#pragma once

#include <cstdio>

#include "shapes.hpp"

namespace hostile {

struct Tally {
    uint64_t rays = 0, hits = 0, wrong = 0;
    uint64_t measured = 0; // t
    double sum = 0, worst = 0;
    uint64_t rebounds = 0, self_hits = 0, twin_hits = 0, leaks = 0, parity = 0;
    double off = 0;         // the greatest distance of a computed hit from the surface, in ulp
    double clearance = 1e9; // the least height of a new origin over the surface it left, in ulp
    void operator+=(const Tally& o)
    {
        rays += o.rays;
        hits += o.hits;
        wrong += o.wrong;
        measured += o.measured;
        sum += o.sum;
        worst = std::fmax(worst, o.worst);
        rebounds += o.rebounds;
        self_hits += o.self_hits;
        twin_hits += o.twin_hits;
        leaks += o.leaks;
        parity += o.parity;
        off = std::fmax(off, o.off);
        clearance = std::fmin(clearance, o.clearance);
    }
};

// The nearest meeting in t > 0, or false.
template <class R>
bool first(const Meetings<R>& m, R& t)
{
    for (int i = 0; i < m.count; i++)
        if (m.t[i] > 0 && m.within[i] >= 0) {
            t = m.t[i];
            return true;
        }
    return false;
}

// A direction that leaves a surface whose unit normal is g: any, or one time in four almost along it.
inline Double3 spawned_direction(Random& random, const Double3& g)
{
    using namespace qray::scene;
    const Double3 d = direction(random);
    if (!random.chance(0.25))
        return d;
    return unit(across(random, g) + g * (random.logarithmic(1e-9, 1e-2) * (random.chance(0.5) ? 1 : -1)));
}

enum class Fault { wrong, self_hit, twin_hit, leak, parity };
inline constexpr const char* fault_names[] = {"wrong", "self-hit", "twin hit", "leak", "parity"};

template <class N>
void print_ray(const qray::Ray<N>& ray)
{
    std::printf("  o (%.17g, %.17g, %.17g) d (%.17g, %.17g, %.17g) from %x %s\n", exact<double>(ray.origin.x),
                exact<double>(ray.origin.y), exact<double>(ray.origin.z), exact<double>(ray.direction.x),
                exact<double>(ray.direction.y), exact<double>(ray.direction.z), ray.from.bits,
                ray.outward ? "outward" : "inward");
}

// Who is given the same shapes and rays besides, to be compared: nobody.
template <class N, template <class> class TrialOf>
struct Nobody {
    Tally tally;
    void look_at(const TrialOf<N>&) {}
    void answer(Random&, const qray::Ray<N>&, Regime, const Meetings<Wide>&) {}
};

template <class N, template <class> class TrialOf, template <class, template <class> class> class Beside = Nobody>
class Examiner {
public:
    using Trial = TrialOf<N>;
    Tally tally;
    Beside<N, TrialOf> beside;
    int verbose = 0; // how many faults to print

    void run(uint64_t seed, Regime regime, uint64_t count)
    {
        Random random(seed), others(~seed); // so that who is beside changes no ray
        while (tally.rays < count) {
            trial.make(random, regime);
            beside.look_at(trial);
            for (int i = 0; i < 16 && tally.rays < count; i++)
                examine(random, others, regime);
        }
    }

private:
    Trial trial;
    using Length = typename N::Length;

    static constexpr double one_ulp = ulp<N>();
    static constexpr Wide a_little = static_cast<Wide>(64 * one_ulp);

    void fault(Fault f, const qray::Ray<N>& ray)
    {
        switch (f) {
        case Fault::wrong: tally.wrong++; break;
        case Fault::self_hit: tally.self_hits++; break;
        case Fault::twin_hit: tally.twin_hits++; break;
        case Fault::leak: tally.leaks++; break;
        case Fault::parity: tally.parity++; break;
        }
        if (verbose > 0) {
            verbose--;
            std::printf("%s: %s\n", Trial::name, fault_names[static_cast<int>(f)]);
            print_object();
            print_ray<N>(ray);
            qray::Hit<N> h{};
            const bool hit = nearest(ray, h);
            std::printf("  ours %d %.17g;", hit, exact<double>(h.t));
            const Meetings<Quad> m = trial.template meet<Quad>(ray);
            for (int i = 0; i < m.count; i++)
                std::printf(" t %.17g within %.9g;", static_cast<double>(m.t[i]), static_cast<double>(m.within[i]));
            std::printf("\n");
        }
    }

    // As in a scene text.
    void print_object() const
    {
        const qray::scene::Object& o = trial.bench.from.objects[0];
        std::printf("  a %.17g %.17g %.17g b %.17g %.17g %.17g ra %.17g rb %.17g", o.a.x, o.a.y, o.a.z, o.b.x, o.b.y,
                    o.b.z, o.ra, o.rb);
        for (uint32_t i = 0; i < o.count; i++) {
            const Double3& v = trial.bench.from.vertices[i];
            std::printf(", %.17g %.17g %.17g", v.x, v.y, v.z);
        }
        std::printf("\n");
    }

    void examine(Random& random, Random& others, Regime regime)
    {
        const qray::Ray<N> ray = trial.aim(random, regime);
        tally.rays++;
        qray::Hit<N> h{};
        const bool hit = nearest(ray, h);
        const Length t = h.t;
        const Meetings<Wide> m = trial.template meet<Wide>(ray);
        beside.answer(others, ray, regime, m);
        Wide expected{};
        bool meets = first(m, expected);
        double error = static_cast<double>(size(exact<Wide>(t) - expected));
        if (hit != meets || (sizeof(Length) == 8 && tally.rays % 16 == 0)) {
            const Meetings<Quad> fine = trial.template meet<Quad>(ray);
            Quad quad{};
            meets = first(fine, quad);
            error = static_cast<double>(size(exact<Quad>(t) - quad));
        }
        if (hit != meets)
            fault(Fault::wrong, ray);
        else if (hit && (sizeof(Length) != 8 || tally.rays % 16 == 0)) {
            tally.measured++;
            tally.sum += error;
            tally.worst = std::fmax(tally.worst, error);
        }
        if (hit) {
            tally.hits++;
            for (int i = 0; i < 2; i++)
                rebound(random, ray, h);
        }
        straight_on(ray, m);
    }

    auto scene() const { return trial.bench.storage.template view<Trial::effects>(); }
    bool nearest(const qray::Ray<N>& ray, qray::Hit<N>& hit) const { return qray::nearest(scene(), ray, hit); }
    qray::Surface<N> surface(const qray::Ray<N>& ray, const qray::Hit<N>& hit) const
    {
        return surface_at(scene(), ray, hit);
    }

    qray::Ray<N> spawn(const qray::Surface<N>& s, qray::Kind kind, const qray::Direction<N>& d) const
    {
        const bool above = qray::dot<N>(s.normal, d) > typename N::Cosine{};
        const auto n_d = N::unit(qray::dot<N>(s.normal, d));
        return tally.rebounds % 2 == 0
            ? qray::going_on<N, Trial::effects>(s, kind, trial.shape.tag, d, above, above ? n_d : -n_d)
            : qray::leaving<N, Trial::effects>(s, kind, trial.shape.tag, d, above);
    }

    void rebound(Random& random, const qray::Ray<N>& ray, const qray::Hit<N>& from)
    {
        using namespace qray::scene;
        const qray::Surface<N> s = surface(ray, from);
        const Double3 g =
            unit({exact<double>(s.geometric.x), exact<double>(s.geometric.y), exact<double>(s.geometric.z)});
        const Double3 d = spawned_direction(random, g);
        qray::Ray<N> next =
            spawn(s, from.kind,
                  random.chance(0.125) ? mirrored<N>(ray.direction, s.normal, s.n_d) : made_direction<N>(random, d));
        tally.rebounds++;
        const double at = static_cast<double>(trial.outside(exact3<Wide>(s.point))) / one_ulp;
        const double start = static_cast<double>(trial.outside(exact3<Wide>(next.origin))) / one_ulp;
        tally.off = std::fmax(tally.off, std::fabs(at));
        if (verbose > 0 && std::fabs(at) > 20) {
            std::printf("off by %.1f ulp\n", at);
            print_ray<N>(ray);
            print_object();
            const Meetings<Quad> q = trial.template meet<Quad>(ray);
            std::printf("  ours %.17g;", exact<double>(from.t));
            for (int i = 0; i < q.count; i++)
                std::printf(" t %.17g within %.9g;", static_cast<double>(q.t[i]), static_cast<double>(q.within[i]));
            std::printf("\n");
            verbose--;
        }
        tally.clearance = std::fmin(tally.clearance, next.outward ? start : -start);
        const Meetings<Wide> m = trial.template meet<Wide>(next);
        // The other side of a curved surface: the farther root, for a ray that heads in. A chord that is nowhere deeper
        // than a few ulp may end anywhere; in a sphere, which has no rim to go out at, it has an end all the same.
        const bool inward = Trial::curved && !next.outward;
        const bool clear = inward && m.count == 2 && m.within[1] > 0 && m.t[1] > 0 && m.certain(1, a_little);
        bool deep = false;
        if (clear) {
            const Wide middle = (m.t[0] + m.t[1]) / 2;
            deep = trial.outside(exact3<Wide>(next.origin) + exact3<Wide>(next.direction) * middle) < -a_little / 4;
        }
        qray::Hit<N> h{};
        const bool hit = nearest(next, h);
        if (hit && (!inward || (deep && exact<Wide>(h.t) < m.t[1] / 2)))
            fault(Fault::self_hit, next);
        if ((deep || (inward && Trial::effects.sphere)) && !hit)
            fault(Fault::leak, next);
        next.from = {qray::Tag::none};
        const bool again = nearest(next, h);
        if (again && (!inward || (deep && exact<Wide>(h.t) < m.t[1] / 2)))
            fault(Fault::twin_hit, next);
        if (deep && !again)
            fault(Fault::leak, next);
    }

    void straight_on(const qray::Ray<N>& first_ray, const Meetings<Wide>& m)
    {
        // Rims, tangents and origins on the surface may be seen either way; not the rest.
        int expected = 0;
        if (Trial::effects.cone && m.count == 0) // a tangent near a rim may have one
            return;
        for (int i = 0; i < m.count; i++) {
            if (!m.certain(i, a_little))
                return;
            expected += m.t[i] > 0 && m.within[i] > 0;
        }
        qray::Ray<N> ray = first_ray;
        int count = 0;
        for (; count < 4; count++) {
            qray::Hit<N> h{};
            if (!nearest(ray, h))
                break;
            ray = spawn(surface(ray, h), h.kind, ray.direction);
        }
        if (Trial::curved && (count ^ expected) & 1)
            fault(Fault::parity, first_ray);
        else if (count > 2)
            fault(Fault::parity, first_ray);
        // A light that lies in the plane of a flat shape, as far as one can tell, is not behind it.
        if (!Trial::curved) {
            const Vec3<Wide> d = exact3<Wide>(first_ray.direction), o = exact3<Wide>(first_ray.origin);
            if (size(trial.outside(o + d) - trial.outside(o)) < a_little)
                return;
        }
        const int counted = surely_missed(trial.shape, qray::RejectRay<N>(first_ray))
            ? 0
            : qray::crossings<true>(trial.shape, corners_of(scene()), first_ray, N::length_max);
        if (Trial::curved ? (counted ^ expected) & 1 : counted != count)
            fault(Fault::parity, first_ray);
    }
};

} // namespace hostile
