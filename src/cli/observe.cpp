// The tracer that is explained, the one for everything, with an observer that keeps what it is told.
#include "explain.hpp"
#include "renderer.hpp"

namespace qray::cli {

namespace {

using scene::value;
using scene::Vec3d;
using Verdict = Explanation::Verdict;

template <class N>
class Observer {
public:
    static constexpr bool explains = true;
    Observer(const scene::Description& from, Explanation& into) : d(from), to(into) {}

    void operator()(RayKind) {}

    // A sample of the eye's starts, at a place as camera.hpp counts it.
    void sample(const Camera<N>& c, int32_t x, int32_t y)
    {
        const double n = 2.0 * c.grid;
        keep(to.samples, {(x + c.grid * c.width) / n, (y + c.grid * c.height) / n, to.rays.count, 0, {}});
    }
    // Its light.
    void comes_back(const Rgb<N>& c)
    {
        to.samples.last().light = light(c);
        to.samples.last().ray_count = to.rays.count - to.samples.last().first_ray;
    }
    void starts(RayKind kind, const Ray<N>& ray, typename N::Unit weight, uint32_t depth)
    {
        Explanation::TracedRay r{};
        r.kind = kind;
        r.depth = static_cast<uint8_t>(depth);
        r.weight = value(weight);
        r.origin = point(ray.origin);
        r.direction = value(ray.direction);
        r.light = light(s.background);
        r.cut_mirrored = r.cut_refracted = -1;
        r.first_light = to.lights.count;
        keep(to.rays, r);
    }
    void hits(const Hit<N>& hit, const Surface<N>& surface)
    {
        Explanation::TracedRay& r = to.rays.last();
        r.hit = true;
        r.place = hit.tag.place();
        r.material = hit.tag.material();
        r.t = value(hit.t) / s.scale;
        r.point = point(surface.point);
        r.normal = value(surface.normal);
        r.turned = surface.turned;
        r.cosine = value(surface.n_d);
    }
    // What comes to the surface without lights, and its colour.
    void shades(const Rgb<N>& arrives, const Vec<typename N::Unit>& colour)
    {
        to.rays.last().arrives = light(arrives);
        to.rays.last().colour = value(colour);
    }
    // The surface's light, all together.
    void shaded(const Rgb<N>& c)
    {
        to.rays.last().light = light(c);
        to.rays.last().light_count = to.lights.count - to.rays.last().first_light;
    }

    // The i-th light of its kind is asked; what is told next is of this one.
    template <class L>
    void asks_light(const L& asked, uint32_t i)
    {
        Explanation::LightShare share{};
        share.light = light_number(asked, i);
        share.through = 1;
        share.places = 1;
        if constexpr (requires { asked.places; })
            share.places = uint32_t{asked.places} * asked.places;
        keep(to.lights, share);
    }
    void turned_to_light(typename N::Unit cosine, typename N::Length distance)
    {
        Explanation::LightShare& l = to.lights.last();
        l.cosine = value(cosine);
        l.distance = value(distance) / s.scale;
        const bool faces = cosine > N::zero;
        l.behind += !faces;
        l.verdict = faces ? std::max(l.verdict, Verdict::nothing) : std::max(l.verdict, Verdict::behind);
    }
    // A shadow ray: what is in its way is asked as the tracer asks it, but to the end.
    template <Effects E, class... Light>
    void crossed(const Scene<N, E>& scene, const Ray<N>& ray, typename N::Length distance, Light... of)
    {
        Explanation::LightShare& l = to.lights.last();
        bool blocked = false;
        for_each_candidate(scene, ray, [distance] { return distance; }, [&](const auto& shape, Kind, uint32_t) {
            const Tag tag = tag_of(shape);
            const int times = crossings_before(scene, shape, ray, distance, of...);
            if (times != 0) {
                const auto amount = scene.transmits[tag.material()].amount;
                if (l.crossed++ == 0 || tag.place() < l.first_crossed)
                    l.first_crossed = tag.place();
                blocked = blocked || amount == N::zero;
                for (int i = 0; i < times; i++)
                    l.through *= value(amount);
            }
            return false;
        });
        l.blocked += blocked;
        if (blocked)
            l.verdict = std::max(l.verdict, Verdict::nothing);
    }
    // What a light, or a place of a panel, gives, by the tracer's own account.
    void adds_light(typename N::Unit diffuse, typename N::Unit highlight, const Rgb<N>& colour)
    {
        Explanation::LightShare& l = to.lights.last();
        const Vec3d c = light(colour) * (1.0 / l.places);
        l.matte = l.matte + c * value(diffuse);
        l.highlight = l.highlight + c * value(highlight);
        l.lit++;
        l.verdict = Verdict::adds;
    }

    // Why a child is not traced, or how it is.
    void reflects_totally() { to.rays.last().totally_reflected = true; }
    void touches_edge() { to.rays.last().touched_edge = true; }
    void cut_off(RayKind kind, typename N::Unit share, typename N::Unit weight)
    {
        if (share > N::zero)
            (kind == RayKind::mirrored ? to.rays.last().cut_mirrored : to.rays.last().cut_refracted) = value(weight);
    }
    void is_deepest(uint32_t material)
    {
        to.rays.last().deepest = d.fills[material].mirror > 0 || d.fills[material].transmit > 0;
    }

private:
    const scene::Storage<N>& s = storage_of<N>();
    const scene::Description& d;
    Explanation& to;

    Vec3d point(const Point<N>& p) const { return value(p) * (1 / s.scale) + s.origin; }
    Vec3d light(const Rgb<N>& c) const { return value(c) * ldexp(1, s.exposure); }

    template <class T>
    void keep(Explanation::List<T>& list, const T& what)
    {
        if (!list.push(what)) {
            to.whole = false;
            if (list.count != 0)
                list.last() = what;
        }
    }

    // Which of the text's lights stands so in the tables: a far one is a sun there.
    template <class L>
    uint32_t light_number(const L&, uint32_t i) const
    {
        for (uint32_t k = 0; k < d.light_count; k++) {
            const bool sun = d.lights[k].sun || (s.far_lights >> k & 1) != 0;
            const bool panel = !sun && d.lights[k].places != 0;
            if (sun == !L::has_place && (sun || panel == requires(L l) { l.places; }) && i-- == 0)
                return k;
        }
        return 0;
    }
};

template <class N>
void explain(const scene::Description& from, uint32_t x, uint32_t y, Explanation& into)
{
    constexpr Effects all = scene::desktop_effects();
    Observer<N> observer(from, into);
    into.pixel = render_pixel(storage_of<N>().template view<all>(), x, y, observer);
}

} // namespace

void explain_pixel(Number number, const scene::Description& from, uint32_t x, uint32_t y, Explanation& into)
{
    using Explain = void (*)(const scene::Description&, uint32_t, uint32_t, Explanation&);
#define QRAY_NUMBER(Type, name) explain<Type>,
    constexpr Explain of[] = {QRAY_NUMBERS(QRAY_NUMBER)};
#undef QRAY_NUMBER
    of[static_cast<int>(number)](from, x, y, into);
}

} // namespace qray::cli
