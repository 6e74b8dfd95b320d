#include "explain.hpp"

#include "../scene/shapes.hpp"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <algorithm>
#include <string_view>

namespace qray::cli {

namespace {

using scene::Vec3d;
using Verdict = Explanation::Verdict;
using TracedRay = Explanation::TracedRay;
using LightShare = Explanation::LightShare;
using Sample = Explanation::Sample;

// What counts as the same: half a level of the picture, and what a number system of few bits may be off at every step.
constexpr double light_off = 1.0 / 510, direction_off = 1.0 / 256, t_off = 1.0 / 1000;
constexpr uint32_t columns = 120, deepest_indent = 16;

bool off(const Vec3d& a, const Vec3d& b, double by) { return largest(a - b) > by; }

struct Line {
    char text[600] = {};
    size_t used = 0;

    [[gnu::format(printf, 2, 3)]] void add(const char* format, ...)
    {
        va_list values;
        va_start(values, format);
        const int length = vsnprintf(text + used, sizeof text - used, format, values);
        va_end(values);
        used = std::min(used + static_cast<size_t>(std::max(length, 0)), sizeof text - 1);
    }
    void vector(const Vec3d& v) { add("(%.5g %.5g %.5g)", v.x + 0.0, v.y + 0.0, v.z + 0.0); } // no -0
};

class Writer {
public:
    Writer(scene::Source& to, const scene::Description& from, const Explained& one, const Explained* other)
        : out(to), d(from), first(one), beside(other)
    {
    }

    void write(const Place& at)
    {
        const Explanation &a = first.of, *const b = beside != nullptr ? &beside->of : nullptr;
        Line head;
        head.add("%s, %ux%u, pixel %u,%u", at.scene, at.width, at.height, at.x, at.y);
        depth = 0;
        put(head.text, "");
        drawing(first);
        if (b != nullptr) {
            drawing(*beside);
            out.print("'!' marks where they part: what is hit, what blocks, t by 1/1000 of itself, directions by "
                      "1/256, light by half a\nlevel. Lines without it have the numbers of %s.\n",
                      first.name);
            uint32_t shared = 0;
            for (const Sample& s : a.samples)
                shared += find(*b, s) != nullptr;
            if (shared != a.samples.count || shared != b->samples.count)
                out.print("! %s has %u sample%s, %s %u, of which %u are at the same places.\n", first.name,
                          a.samples.count, a.samples.count == 1 ? "" : "s", beside->name, b->samples.count, shared);
        }
        for (const Sample& s : a.samples) {
            const Sample* const same = b != nullptr ? find(*b, s) : nullptr;
            sample(first, s, same);
            if (b == nullptr)
                rays(a, s.first_ray, s.first_ray + s.ray_count);
            else if (same == nullptr)
                alone(first, s.first_ray, s.first_ray + s.ray_count);
            else
                pairs(s, *same);
        }
        if (b != nullptr)
            for (const Sample& s : b->samples)
                if (find(a, s) == nullptr) {
                    sample(*beside, s, nullptr);
                    alone(*beside, s.first_ray, s.first_ray + s.ray_count);
                }
    }

private:
    scene::Source& out;
    const scene::Description& d;
    const Explained& first;
    const Explained* const beside;
    uint32_t depth = 1; // of the ray that is written

    static const Sample* find(const Explanation& among, const Sample& one)
    {
        for (const Sample& s : among.samples)
            if (s.x == one.x && s.y == one.y)
                return &s;
        return nullptr;
    }

    void sample(const Explained& of, const Sample& s, const Sample* same)
    {
        char mark[40] = "";
        if (beside != nullptr && same == nullptr)
            snprintf(mark, sizeof mark, "! only in %s: ", of.name);
        out.print("\n%ssample at %.7g,%.7g\n", mark, s.x, s.y);
        depth = 0;
        item(same != nullptr && off(s.light, same->light, light_off), [&](Line& l, const Explanation& e) {
            l.add("light ");
            l.vector(same != nullptr && &e != &first.of ? same->light : s.light);
            l.add(" comes back");
        });
    }

    // How the pixel was drawn, and its colour.
    void drawing(const Explained& e)
    {
        const Pixel p = e.of.pixel, q = beside != nullptr ? beside->of.pixel : p, r = first.of.pixel;
        const bool differs = q.r != r.r || q.g != r.g || q.b != r.b;
        const scene::Settings& s = e.settings;
        const uint32_t count = s.grid * s.grid;
        out.put(differs ? "! " : "");
        if (strcmp(e.name, e.number) != 0)
            out.print("%s: ", e.name);
        out.print("%s, ", e.number);
        if (s.levels != 0)
            out.print("adaptive in %u level%s from %g", s.levels, s.levels == 1 ? "" : "s", s.threshold);
        else
            out.print("%u sample%s", count, count == 1 ? "" : "s");
        out.print(", depth %u, cutoff %g: colour %u %u %u\n", s.depth, s.cutoff, p.r, p.g, p.b);
    }
    const Explained& drawn(const Explanation& e) const { return &e == &first.of ? first : *beside; }

    // A line, indented; or two where the number systems differ. text(line, explanation) makes it.
    template <class Text>
    void item(bool differs, Text text)
    {
        if (beside == nullptr || !differs)
            return line(first.of, "", text);
        for (const Explained* e : {&first, beside}) {
            char mark[32];
            snprintf(mark, sizeof mark, "! %s: ", e->name);
            line(e->of, mark, text);
        }
    }
    template <class Text>
    void line(const Explanation& of, const char* mark, Text text)
    {
        Line l;
        l.add("%s", mark);
        text(l, of);
        put(l.text, "|  ");
    }
    // Breaks what is too long at a space.
    void put(const char* text, const char* last)
    {
        const uint32_t levels = std::min(depth, deepest_indent);
        std::string_view rest = text;
        for (bool more = false; !rest.empty(); more = true) {
            for (uint32_t i = 0; i < levels; i++)
                out.put(i + 1 < levels || more ? "|  " : last);
            size_t room = columns - 3 * levels - (more ? 4 : 0), end = rest.size();
            if (end > room)
                end = std::min(rest.rfind(' ', room), room);
            out.print("%s%.*s\n", more ? "    " : "", static_cast<int>(end), rest.data());
            rest.remove_prefix(std::min(end + 1, rest.size()));
        }
    }

    // Rays.

    // All of one number system.
    void rays(const Explanation& e, uint32_t i, uint32_t end)
    {
        for (; i < end; i++)
            ray(e, e.rays[i], e, e.rays[i], "");
    }
    // Those that the other has not.
    void alone(const Explained& e, uint32_t i, uint32_t end)
    {
        char mark[40];
        snprintf(mark, sizeof mark, "! only in %s: ", e.name);
        for (; i < end; i++)
            ray(e.of, e.of.rays[i], e.of, e.of.rays[i], mark);
    }
    static uint32_t subtree(const Explanation& e, uint32_t i, uint32_t end)
    {
        const uint8_t at = e.rays[i].depth;
        for (i++; i < end && e.rays[i].depth > at;)
            i++;
        return i;
    }
    // Two trees beside each other. Below where they meet different things, each stands by itself.
    void pairs(const Sample& s, const Sample& t)
    {
        const Explanation &a = first.of, &b = beside->of;
        uint32_t i = s.first_ray, j = t.first_ray;
        const uint32_t ends[2] = {i + s.ray_count, j + t.ray_count};
        while (i < ends[0] || j < ends[1]) {
            // Which comes first in a tree: what is deeper; of two children, the mirrored one.
            const auto rank = [](const TracedRay& r) { return 2 * r.depth + (r.kind != RayKind::refracted); };
            const int one = i < ends[0] ? rank(a.rays[i]) : -1, two = j < ends[1] ? rank(b.rays[j]) : -1;
            if (one == two) {
                const TracedRay &r = a.rays[i], &q = b.rays[j];
                ray(a, r, b, q, "");
                const bool parted = r.hit != q.hit || (r.hit && r.place != q.place);
                const uint32_t next_i = parted ? subtree(a, i, ends[0]) : i + 1;
                const uint32_t next_j = parted ? subtree(b, j, ends[1]) : j + 1;
                alone(first, i + 1, next_i);
                alone(*beside, j + 1, next_j);
                i = next_i;
                j = next_j;
            } else {
                const Explained& e = one > two ? first : *beside;
                uint32_t& at = one > two ? i : j;
                const uint32_t next = subtree(e.of, at, ends[one < two]);
                alone(e, at, next);
                at = next;
            }
        }
    }

    // A ray, beside the same one in the other number system, or beside itself.
    void ray(const Explanation& a, const TracedRay& r, const Explanation& b, const TracedRay& q, const char* mark)
    {
        constexpr const char* kinds[] = {"eye", "shadow", "mirrored", "refracted"};
        depth = r.depth;
        // Of a line that is made for either of them; a subtree that stands alone is its own partner.
        const auto of = [&](const Explanation& e) -> const TracedRay& { return &r != &q && &e == &b ? q : r; };
        const auto each = [&](bool differs, auto text) {
            if (&r == &q)
                line(a, "", [&](Line& l, const Explanation&) { text(l, r, a); });
            else
                item(differs, [&](Line& l, const Explanation& e) { text(l, of(e), e); });
        };
        Line head;
        head.add("%s%s ray, depth %u, weight %.5g", mark, kinds[static_cast<int>(r.kind)], r.depth, r.weight);
        depth -= depth == 1; // the eye's stands at the edge
        put(head.text, "+- ");
        depth = r.depth;
        each(off(r.direction, q.direction, direction_off) || fabs(r.weight - q.weight) > light_off,
             [&](Line& l, const TracedRay& of_it, const Explanation&) {
                 l.add("from ");
                 l.vector(of_it.origin);
                 l.add(" along ");
                 l.vector(of_it.direction);
             });
        const bool parted = r.hit != q.hit || r.place != q.place || r.material != q.material;
        each(parted || fabs(r.t - q.t) > t_off * fabs(q.t), [&](Line& l, const TracedRay& of_it, const Explanation&) {
            if (!of_it.hit)
                return l.add("meets nothing");
            l.add("meets ");
            object(l, of_it.place);
            l.add(" at t %.6g, ", of_it.t);
            l.vector(of_it.point);
        });
        if (!r.hit && !q.hit)
            return each(off(r.light, q.light, light_off), [&](Line& l, const TracedRay& of_it, const Explanation&) {
                l.add("= ");
                l.vector(of_it.light);
                l.add(", the background");
            });
        if (parted) {
            hit(a, r);
            if (q.hit)
                hit(b, q);
            return;
        }
        each(off(r.normal, q.normal, direction_off), [&](Line& l, const TracedRay& of_it, const Explanation&) {
            l.add("normal ");
            l.vector(of_it.normal);
            l.add(", n.d %.5g%s", of_it.cosine, of_it.turned ? "; turned to the ray, which meets it from behind" : "");
        });
        each(off(r.colour, q.colour, light_off),
             [&](Line& l, const TracedRay& of_it, const Explanation&) { colour(l, of_it); });
        each(off(times(r.arrives, r.colour), times(q.arrives, q.colour), light_off / std::max(r.weight, 1e-9)),
             [&](Line& l, const TracedRay& of_it, const Explanation&) { arrives(l, of_it); });
        for (uint32_t k = 0; k < r.light_count; k++) {
            const LightShare &one = a.lights[r.first_light + k], &two = b.lights[q.first_light + k]; // each asks all
            const bool differs = one.verdict != two.verdict || one.lit != two.lit || one.blocked != two.blocked
                || one.crossed != two.crossed || (one.crossed != 0 && one.first_crossed != two.first_crossed)
                || off((times(one.matte, r.colour) + one.highlight) * r.weight,
                       (times(two.matte, q.colour) + two.highlight) * q.weight, light_off);
            each(differs, [&](Line& l, const TracedRay& of_it, const Explanation& e) {
                light(l, of_it, e.lights[of_it.first_light + k]);
            });
        }
        each(off(r.light * r.weight, q.light * q.weight, light_off),
             [&](Line& l, const TracedRay& of_it, const Explanation&) { sum(l, of_it); });
        const uint32_t ends = endings(r), other_ends = endings(q);
        if (ends != 0 || other_ends != 0)
            each(ends != other_ends,
                 [&](Line& l, const TracedRay& of_it, const Explanation& e) { children(l, of_it, drawn(e).settings); });
    }
    // What there is to be said of the rays that a hit does not send on as its material has it.
    static uint32_t endings(const TracedRay& r)
    {
        return r.totally_reflected + 2u * r.touched_edge + 4u * r.deepest + 8u * (r.cut_mirrored >= 0)
            + 16u * (r.cut_refracted >= 0);
    }
    // All of a hit that has no partner.
    void hit(const Explanation& e, const TracedRay& r)
    {
        Line head;
        head.add("! %s:", drawn(e).name);
        put(head.text, "|  ");
        const auto own = [&](auto text) { line(e, "   ", text); };
        if (r.hit) {
            own([&](Line& l, const Explanation&) { colour(l, r); });
            own([&](Line& l, const Explanation&) { arrives(l, r); });
            for (uint32_t k = 0; k < r.light_count; k++)
                own([&](Line& l, const Explanation&) { light(l, r, e.lights[r.first_light + k]); });
        }
        own([&](Line& l, const Explanation&) { sum(l, r); });
        if (endings(r) != 0)
            own([&](Line& l, const Explanation&) { children(l, r, drawn(e).settings); });
    }

    // Lines of a hit.

    void colour(Line& l, const TracedRay& r) const
    {
        constexpr const char* textures[] = {"",
#define QRAY_NAME(Type, name, table) ", " #name,
            QRAY_TEXTURES(QRAY_NAME)
#undef QRAY_NAME
        };
        l.add("colour ");
        l.vector(r.colour);
        l.add("%s", textures[static_cast<int>(d.fills[r.material].texture.kind)]);
    }
    void arrives(Line& l, const TracedRay& r) const
    {
        const double e = d.fills[r.material].emission;
        l.add("+ ");
        l.vector(times(r.colour, r.arrives - Vec3d{e, e, e}));
        l.add(" %s", d.radiosity > 0 ? "from other surfaces" : "ambient");
        if (e > 0) {
            l.add(" + ");
            l.vector(r.colour * e);
            l.add(" emission");
        }
    }
    void light(Line& l, const TracedRay& r, const LightShare& s) const
    {
        const scene::LightSource& source = d.lights[s.light];
        const bool panel = s.places > 1;
        const auto crossed = [&](const char* before) {
            if (s.crossed == 0)
                return;
            l.add("%s", before);
            object(l, s.first_crossed);
            if (s.crossed > 1)
                l.add(" and %u more", s.crossed - 1);
        };
        if (s.verdict == Verdict::adds) {
            l.add("+ ");
            l.vector(times(s.matte, r.colour));
            if (largest(s.highlight) > 0) {
                l.add(" + highlight ");
                l.vector(s.highlight);
            }
        } else {
            l.add("+ 0");
        }
        l.add(" from %s, line %u: ", source.sun ? "sun" : source.places != 0 ? "panel" : "light", source.line);
        if (panel) {
            l.add("of %u places %u lit, %u blocked, %u behind", s.places, s.lit, s.blocked, s.behind);
            return crossed("; in the way ");
        }
        if (s.verdict == Verdict::at_light)
            return l.add("it stands at the point itself");
        l.add("n.l %.5g", s.cosine);
        if (!source.sun)
            l.add(", %.5g away", s.distance);
        if (s.verdict == Verdict::behind)
            l.add(", behind the surface");
        else if (s.blocked != 0)
            crossed(", blocked by ");
        else if (s.verdict == Verdict::nothing)
            l.add(", too little to be told from nothing");
        else if (s.crossed != 0) {
            l.add(", %.5g of it", s.through);
            crossed(" through ");
        }
    }
    void sum(Line& l, const TracedRay& r) const
    {
        l.add("= ");
        l.vector(r.light);
        if (!r.hit)
            l.add(", the background");
        if (r.weight != 1) {
            l.add(", weighed ");
            l.vector(r.light * r.weight);
        }
    }
    void children(Line& l, const TracedRay& r, const scene::Settings& settings) const
    {
        const char* between = "";
        const auto note = [&](const char* text) {
            l.add("%s%s", between, text);
            between = "; ";
        };
        if (r.totally_reflected)
            note("total internal reflection: the mirrored ray has both weights");
        if (r.touched_edge)
            note("only an edge is touched: the ray goes straight on");
        if (r.deepest)
            note("the greatest depth: no mirrored or refracted ray");
        const auto cut = [&](const char* kind, double weight) {
            if (weight < 0)
                return;
            note("no ");
            l.add("%s ray: weight %.3g, cutoff %g", kind, weight, settings.cutoff);
        };
        cut("mirrored", r.cut_mirrored);
        cut("refracted", r.cut_refracted);
        if (endings(r) == 0)
            l.add("sends on all rays of its material");
    }

    // Of the surface at that place in the text.
    void object(Line& l, uint32_t place) const
    {
        uint32_t face = 1, i = 0;
        for (; i + 1 < d.object_count; i++) {
            const uint32_t surfaces = surfaces_of(d.objects[i]);
            if (place < surfaces)
                break;
            place -= surfaces;
            face = d.objects[i + 1].line == d.objects[i].line ? face + 1 : 1;
        }
        const scene::Object& o = d.objects[i];
        l.add("%s", name_of(o));
        if (face > 1 || (i + 1 < d.object_count && d.objects[i + 1].line == o.line))
            l.add(" %u of", face);
        else
            l.add(",");
        l.add(" line %u", o.line);
        if (surfaces_of(o) > 1)
            l.add(", triangle %u", place + 1);
    }
};

} // namespace

void write_explanation(scene::Source& out, const scene::Description& description, const Place& place,
                       const Explained& first, const Explained* beside)
{
    Writer(out, description, first, beside).write(place);
}

} // namespace qray::cli
