// An independent renderer of the scene language, in long double: what the picture of a scene is, as
// plainly as it can be written. It shares no code with the tracer that is tested against it.
//
//   g++ -std=gnu++20 -O2 -pthread tests/oracle/oracle.cpp -o build/oracle
//   oracle SCENE.nff -o out.ppm [-s WxH] [-r N] [-a LEVELS[,THRESHOLD]] [-d DEPTH] [--cutoff W] [-j THREADS]
//
// -DORACLE_DOUBLE computes in double, -DORACLE_QUAD in __float128 (add -lquadmath): a picture that is the
// same in two of them is settled. Input is assumed to be valid.
//
// Three textures beyond those of the page that defines the image, with p = q/size, M the colour of the fill,
// N the texture's own, e = 1/1024, frac(x) = x - floor(x), axis = unit(AX AY AZ) and
// turb(p) = noise(p) + noise(2p)/2 + noise(4p)/4 + noise(8p)/8, in [0, 1.875):
//   marble R G B size AX AY AZ   w = frac(p.axis + 2 turb(p)); s = 1 - |2w - 1|; M + (N - M) s s (3 - 2s)
//   wood   R G B size AX AY AZ   rho = distance of p from the line through 0 along axis;
//                                w = frac(rho + noise(p)/2); M + (N - M) w w
//   brick  R G B size            j = floor(2 py + e); h = 1/2 if j is odd, else 0; N (mortar) where
//                                frac(px + h + e) < 1/16 or frac(pz + h + e) < 1/16 or
//                                frac(2 py + e) < 1/8, else M
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#if defined(ORACLE_QUAD)
#include <quadmath.h>
using Real = __float128;
const Real machine_eps = FLT128_EPSILON;
Real root(Real x) { return sqrtq(x); }
Real power(Real x, Real y) { return powq(x, y); }
Real tangent(Real x) { return tanq(x); }
Real floor_of(Real x) { return floorq(x); }
Real magnitude(Real x) { return fabsq(x); }
Real arc_sine(Real x) { return asinq(x); }
Real arc_tangent(Real y, Real x) { return atan2q(y, x); }
Real parse_real(const char* s, char** end) { return strtoflt128(s, end); }
const Real pi = M_PIq;
#else
#if defined(ORACLE_DOUBLE)
using Real = double;
#else
using Real = long double;
#endif
const Real machine_eps = std::numeric_limits<Real>::epsilon();
Real root(Real x) { return std::sqrt(x); }
Real power(Real x, Real y) { return std::pow(x, y); }
Real tangent(Real x) { return std::tan(x); }
Real floor_of(Real x) { return std::floor(x); }
Real magnitude(Real x) { return std::fabs(x); }
Real arc_sine(Real x) { return std::asin(x); }
Real arc_tangent(Real y, Real x) { return std::atan2(y, x); }
Real parse_real(const char* s, char** end) { return static_cast<Real>(std::strtold(s, end)); }
const Real pi = static_cast<Real>(3.14159265358979323846264338327950288L);
#endif
const Real infinity = static_cast<Real>(std::numeric_limits<double>::infinity());

[[noreturn]] void fail(const std::string& what) {
    std::fprintf(stderr, "oracle: %s\n", what.c_str());
    std::exit(1);
}

// ---------------------------------------------------------------- vectors

struct Vec {
    Real x = 0, y = 0, z = 0;
    Real operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
};
Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec operator-(Vec a) { return {-a.x, -a.y, -a.z}; }
Vec operator*(Real s, Vec a) { return {s * a.x, s * a.y, s * a.z}; }
Vec operator/(Vec a, Real s) { return {a.x / s, a.y / s, a.z / s}; }
Vec times(Vec a, Vec b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
Real dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec cross(Vec a, Vec b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
Real length(Vec a) { return root(dot(a, a)); }
Vec unit(Vec a) { return a / length(a); }
Real frac(Real x) { return x - floor_of(x); }
Real clamp01(Real x) { return x < 0 ? Real(0) : x > 1 ? Real(1) : x; }

// ---------------------------------------------------------------- the scene

struct Image {
    int width = 0, height = 0;
    std::vector<uint8_t> rgb;  // rows from the bottom
};

enum class Tex { None, Checker, Stripes, Gradient, Rings, Noise, Marble, Wood, Brick, Image, Globe };

struct Material {
    Vec colour{1, 1, 1};
    Real ambient = 1, diffuse = 1, highlight = 0, shine = 1, mirror = 0, transmit = 0, ior = 1, emission = 0;
    Tex tex = Tex::None;
    Vec tex_colour, axis{0, 1, 0};
    Real size = 1;
    Vec o, u, v;  // image: origin and edges; globe: o is the centre
    int image = -1;
};

struct Light {
    bool sun = false, coloured = false;
    Vec at, colour;  // at: a place, a panel's middle, or the unit direction to a sun
    int places = 0;  // of a panel along an edge, else 0
    uint32_t number = 0;  // among panels
    Vec u, v;        // its half edges
};

// Column and row of an eye's sample among all of its size.
struct Sample {
    uint32_t x = 0, y = 0;
};

enum class Kind { Sphere, Cone, Polygon, Triangle, Plane, Disc };

struct Prim {
    Kind kind = Kind::Sphere;
    int material = 0;
    Vec a;             // centre; base; first vertex; point
    Vec g;             // geometric normal (flat kinds); unit axis (cone)
    Real r0 = 0, r1 = 0, len = 0, slope = 0;
    int first = 0, count = 0;  // vertices in the pool; a triangle's normals are in the same places
};

struct Box {
    Vec lo{infinity, infinity, infinity}, hi{-infinity, -infinity, -infinity};
    void add(Vec p) {
        lo = {std::min(lo.x, p.x), std::min(lo.y, p.y), std::min(lo.z, p.z)};
        hi = {std::max(hi.x, p.x), std::max(hi.y, p.y), std::max(hi.z, p.z)};
    }
    void add(const Box& b) { add(b.lo), add(b.hi); }
    void add_circle(Vec c, Vec axis, Real r) {
        auto e = [&](Real n) { return r * root(std::max(Real(0), 1 - n * n)); };
        Vec h{e(axis.x), e(axis.y), e(axis.z)};
        add(c - h), add(c + h);
    }
};

struct Node {
    double lo[3], hi[3];
    int left = -1, right = -1, axis = 0, first = 0, count = 0;
};

struct Scene {
    Vec from, at, up;
    Real angle = 0;
    int width = 0, height = 0;
    Vec background, ambient{Real(0.2L), Real(0.2L), Real(0.2L)};
    bool shadows = true;
    Real far = -1;
    std::vector<Light> lights;
    std::vector<Material> materials;
    std::vector<Prim> prims;
    std::vector<Vec> vertices, normals;
    std::vector<Image> images;
    int dropped = 0;

    Vec centre;        // of the scene box
    Real t_min = 0;    // another surface nearer than this coincides with the one that the ray left
    std::vector<Node> nodes;
    std::vector<int> order, planes;

    const Prim& prim(int i) const { return prims[static_cast<size_t>(i)]; }
    const Material& material(int i) const { return materials[static_cast<size_t>(prim(i).material)]; }
    const Image& image(const Material& m) const { return images[static_cast<size_t>(m.image)]; }
};

// ---------------------------------------------------------------- reading

struct Reader {
    std::vector<std::string> tokens;
    size_t i = 0;
    std::string folder;

    explicit Reader(const std::string& path) {
        FILE* f = path == "-" ? stdin : std::fopen(path.c_str(), "rb");
        if (!f) fail("cannot read " + path);
        std::string word;
        bool comment = false;
        for (int c; (c = std::fgetc(f)) != EOF;) {
            if (c == '#') comment = true;
            if (comment || std::isspace(c)) {
                if (!word.empty()) tokens.push_back(word), word.clear();
                if (c == '\n') comment = false;
            } else {
                word += static_cast<char>(c);
            }
        }
        if (!word.empty()) tokens.push_back(word);
        if (f != stdin) std::fclose(f);
        size_t slash = path.rfind('/');
        if (slash != std::string::npos) folder = path.substr(0, slash + 1);
    }
    bool done() const { return i >= tokens.size(); }
    bool number_next() const {
        return !done() && std::strchr("+-.0123456789", tokens[i][0]) != nullptr;
    }
    std::string word() {
        if (done()) fail("the scene ends early");
        return tokens[i++];
    }
    void expect(const char* what) {
        std::string w = word();
        if (w != what) fail("expected " + std::string(what) + ", found " + w);
    }
    Real real() {
        std::string w = word();
        char* end = nullptr;
        Real r = parse_real(w.c_str(), &end);
        if (*end) fail("not a number: " + w);
        return r;
    }
    int integer() { return static_cast<int>(real()); }
    Vec vec() {
        Real x = real(), y = real();
        return {x, y, real()};
    }
};

Image read_image(const std::string& path) {
    FILE* f = std::fopen(path.c_str(), "rb");
    if (!f) fail("cannot read " + path);
    std::vector<uint8_t> d;
    for (int c; (c = std::fgetc(f)) != EOF;) d.push_back(static_cast<uint8_t>(c));
    std::fclose(f);
    Image m;
    auto le = [&](size_t at, int n) {
        uint32_t v = 0;
        for (int k = n - 1; k >= 0; --k) v = v << 8 | d[at + static_cast<size_t>(k)];
        return static_cast<int32_t>(v);
    };
    if (d.size() > 54 && d[0] == 'B' && d[1] == 'M') {
        m.width = le(18, 4);
        int h = le(22, 4);
        m.height = std::abs(h);
        size_t start = static_cast<uint32_t>(le(10, 4));
        size_t w = static_cast<size_t>(m.width), rows = static_cast<size_t>(m.height);
        size_t pitch = (3 * w + 3) / 4 * 4;
        if (le(28, 2) != 24 || d.size() < start + pitch * rows) fail("not a 24-bit BMP: " + path);
        m.rgb.resize(3 * w * rows);
        for (size_t y = 0; y < rows; ++y)
            for (size_t x = 0; x < w; ++x)
                for (size_t c = 0; c < 3; ++c)
                    m.rgb[3 * (y * w + x) + c] =
                        d[start + (h > 0 ? y : rows - 1 - y) * pitch + 3 * x + 2 - c];
        return m;
    }
    size_t at = 2;
    auto field = [&] {
        for (;; ++at) {
            if (at >= d.size()) fail("not a picture: " + path);
            if (d[at] == '#') while (at < d.size() && d[at] != '\n') ++at;
            else if (!std::isspace(d[at])) break;
        }
        int v = 0;
        for (; at < d.size() && std::isdigit(d[at]); ++at) v = 10 * v + d[at] - '0';
        return v;
    };
    if (d.size() < 8 || d[0] != 'P' || d[1] != '6') fail("not a BMP or a PPM: " + path);
    m.width = field(), m.height = field();
    int top = field();
    size_t w = static_cast<size_t>(m.width), rows = static_cast<size_t>(m.height);
    if (top < 1 || top > 255 || d.size() < at + 1 + 3 * w * rows) fail("not an 8-bit PPM: " + path);
    m.rgb.resize(3 * w * rows);
    for (size_t y = 0; y < rows; ++y)
        for (size_t x = 0; x < 3 * w; ++x) {
            int v = std::min<int>(top, d[at + 1 + 3 * w * (rows - 1 - y) + x]);
            m.rgb[3 * w * y + x] = static_cast<uint8_t>(std::floor(255.0 * v / top + 0.5));
        }
    return m;
}

void read_texture(Reader& in, Scene& scene, Material& m) {
    static const std::pair<const char*, Tex> names[] = {
        {"checker", Tex::Checker}, {"stripes", Tex::Stripes}, {"gradient", Tex::Gradient},
        {"rings", Tex::Rings}, {"noise", Tex::Noise}, {"marble", Tex::Marble}, {"wood", Tex::Wood},
        {"brick", Tex::Brick}, {"image", Tex::Image}, {"globe", Tex::Globe}};
    std::string name = in.word();
    m.tex = Tex::None;
    for (auto& [text, tex] : names) if (name == text) m.tex = tex;
    if (m.tex == Tex::None) fail("unknown texture " + name);
    if (m.tex == Tex::Image || m.tex == Tex::Globe) {
        std::string file = in.word();
        scene.images.push_back(read_image(file[0] == '/' ? file : in.folder + file));
        m.image = static_cast<int>(scene.images.size()) - 1;
        m.o = in.vec();
        if (m.tex == Tex::Image) m.u = in.vec(), m.v = in.vec();
        return;
    }
    m.tex_colour = in.vec();
    m.size = in.real();
    if (m.tex == Tex::Stripes || m.tex == Tex::Gradient || m.tex == Tex::Marble || m.tex == Tex::Wood)
        m.axis = unit(in.vec());
}

// Twice the area of a polygon as a vector. Coordinates are decimal, so what stands for no area at all may
// come out as a rounding error.
Vec area_vector(const std::vector<Vec>& p) {
    Vec sum;
    for (size_t k = 1; k + 1 < p.size(); ++k) sum = sum + cross(p[k] - p[0], p[k + 1] - p[0]);
    return sum;
}
bool no_area(Vec area, const std::vector<Vec>& p) {
    Real edge = 0, far = 0;
    for (Vec v : p) {
        edge = std::max(edge, length(v - p[0]));
        far = std::max(far, length(v));
    }
    return length(area) <= 16 * machine_eps * far * edge;
}

// A Wavefront OBJ file, face by face: smooth ones whole, others as triangles.
template <class Flat, class Smooth>
void read_obj(const std::string& path, Real scale, Vec place, Flat flat, Smooth smooth) {
    std::ifstream file(path);
    if (!file) fail("cannot read " + path);
    std::vector<Vec> points, normals;
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line.substr(0, line.find('#')));
        std::string word;
        std::vector<std::string> w;
        while (words >> word) w.push_back(word);
        if (w.empty()) continue;
        auto vec = [&] {
            auto real = [&](size_t k) { return parse_real(w.at(k).c_str(), nullptr); };
            return Vec{real(1), real(2), real(3)};
        };
        if (w[0] == "v") points.push_back(scale * vec() + place);
        if (w[0] == "vn") normals.push_back(vec());
        if (w[0] != "f") continue;
        std::vector<Vec> v, n;
        auto pick = [](const std::vector<Vec>& of, int k) {
            return of.at(k > 0 ? static_cast<size_t>(k) - 1 : of.size() - static_cast<size_t>(-k));
        };
        for (size_t k = 1; k < w.size(); ++k) {
            v.push_back(pick(points, std::stoi(w[k])));
            size_t second = w[k].find('/'), third = w[k].find('/', second + 1);
            if (second != w[k].npos && third != w[k].npos)
                n.push_back(pick(normals, std::stoi(w[k].substr(third + 1))));
        }
        if (n.size() == v.size()) smooth(v, n);
        else for (size_t k = 1; k + 1 < v.size(); ++k) flat({v[0], v[k], v[k + 1]});
    }
}

void read_scene(Reader& in, Scene& s) {
    Material fill;
    bool fill_new = true;
    auto material = [&] {
        if (fill_new) s.materials.push_back(fill), fill_new = false;
        return static_cast<int>(s.materials.size()) - 1;
    };
    auto add_vertices = [&](Prim& p, std::initializer_list<Vec> v, std::initializer_list<Vec> n) {
        p.first = static_cast<int>(s.vertices.size()), p.count = static_cast<int>(v.size());
        s.vertices.insert(s.vertices.end(), v), s.normals.insert(s.normals.end(), n);
    };
    auto polygon = [&](const std::vector<Vec>& v) {
        Prim p;
        p.kind = Kind::Polygon, p.material = material(), p.a = v[0];
        p.first = static_cast<int>(s.vertices.size()), p.count = static_cast<int>(v.size());
        Vec area = area_vector(v), corner = cross(v[1] - v[0], v[2] - v[1]);
        // The first three vertices may lie on a line: then the whole polygon says where its front is.
        if (no_area(corner, {v[0], v[1], v[2]})) corner = area;
        if (no_area(corner, v)) { ++s.dropped; return; }
        p.g = unit(corner);
        s.vertices.insert(s.vertices.end(), v.begin(), v.end());
        s.normals.resize(s.vertices.size());
        s.prims.push_back(p);
    };
    auto patch = [&](const std::vector<Vec>& v, const std::vector<Vec>& m) {
        for (size_t k = 1; k + 1 < v.size(); ++k) {
            Prim t;
            t.kind = Kind::Triangle, t.material = material(), t.a = v[0];
            Vec area = cross(v[k] - v[0], v[k + 1] - v[k]);
            if (no_area(area, {v[0], v[k], v[k + 1]})) { ++s.dropped; continue; }
            t.g = unit(area);
            add_vertices(t, {v[0], v[k], v[k + 1]}, {m[0], m[k], m[k + 1]});
            s.prims.push_back(t);
        }
    };
    while (!in.done()) {
        std::string w = in.word();
        Prim p;
        if (w == "v") {
            in.expect("from"), s.from = in.vec();
            in.expect("at"), s.at = in.vec();
            in.expect("up"), s.up = in.vec();
            in.expect("angle"), s.angle = in.real();
            in.expect("hither"), in.real();
            in.expect("resolution"), s.width = in.integer(), s.height = in.integer();
        } else if (w == "b") {
            s.background = in.vec();
        } else if (w == "ambientlight") {
            s.ambient = in.vec();
        } else if (w == "l" || w == "sun" || w == "panel") {
            Light l;
            l.sun = w == "sun";
            if (w == "panel") l.places = in.integer();
            l.at = in.vec();
            if (l.places) l.u = in.vec(), l.v = in.vec();
            for (const Light& other : s.lights) if (l.places && other.places) ++l.number;
            if (l.sun) l.at = unit(l.at);
            if (in.number_next()) l.coloured = true, l.colour = in.vec();
            s.lights.push_back(l);
        } else if (w == "shadows") {
            s.shadows = in.word() == "on";
        } else if (w == "far") {
            s.far = in.real();
        } else if (w == "f") {
            fill = Material();
            fill.colour = in.vec();
            fill.ambient = fill.diffuse = clamp01(in.real());
            fill.highlight = fill.mirror = clamp01(in.real());
            fill.shine = in.real(), fill.transmit = clamp01(in.real()), fill.ior = in.real();
            fill.ior = fill.ior <= 0 ? 1 : fill.ior < 0.125 ? Real(0.125) : fill.ior > 8 ? Real(8) : fill.ior;
            fill_new = true;
        } else if (w == "material") {
            fill = Material();
            for (; !in.done(); ) {
                const std::string& name = in.tokens[in.i];
                if (name == "colour") { ++in.i; fill.colour = in.vec(); continue; }
                Real* field = name == "ambient" ? &fill.ambient : name == "diffuse" ? &fill.diffuse :
                    name == "highlight" ? &fill.highlight : name == "shine" ? &fill.shine :
                    name == "mirror" ? &fill.mirror : name == "transmit" ? &fill.transmit :
                    name == "ior" ? &fill.ior : name == "emission" ? &fill.emission : nullptr;
                if (!field) break;
                ++in.i, *field = in.real();
            }
            if (fill.ior <= 0) fill.ior = 1;
            fill_new = true;
        } else if (w == "texture") {
            read_texture(in, s, fill);
            fill_new = true;
        } else if (w == "s") {
            p.a = in.vec(), p.r0 = magnitude(in.real()), p.material = material();
            if (p.r0 == 0) ++s.dropped;
            else s.prims.push_back(p);
        } else if (w == "c") {
            p.kind = Kind::Cone;
            p.a = in.vec(), p.r0 = magnitude(in.real());
            Vec end = in.vec();
            p.r1 = magnitude(in.real()), p.material = material();
            p.len = length(end - p.a);
            if (p.len == 0 || (p.r0 == 0 && p.r1 == 0)) { ++s.dropped; continue; }
            p.g = (end - p.a) / p.len, p.slope = (p.r1 - p.r0) / p.len;
            s.prims.push_back(p);
        } else if (w == "p") {
            std::vector<Vec> v(static_cast<size_t>(in.integer()));
            for (Vec& x : v) x = in.vec();
            polygon(v);
        } else if (w == "pp") {
            size_t n = static_cast<size_t>(in.integer());
            std::vector<Vec> v(n), m(n);
            for (size_t k = 0; k < n; ++k) v[k] = in.vec(), m[k] = in.vec();
            patch(v, m);
        } else if (w == "mesh") {
            std::string file = in.word();
            Real scale = in.number_next() ? in.real() : Real(1);
            Vec place = in.number_next() ? in.vec() : Vec{};
            read_obj(file[0] == '/' ? file : in.folder + file, scale, place, polygon, patch);
        } else if (w == "plane" || w == "disc") {
            p.kind = w == "plane" ? Kind::Plane : Kind::Disc;
            p.a = in.vec(), p.g = unit(in.vec());
            if (p.kind == Kind::Disc) p.r0 = magnitude(in.real());
            p.material = material();
            if (p.kind == Kind::Disc && p.r0 == 0) ++s.dropped;
            else s.prims.push_back(p);
        } else {
            fail("unknown entity " + w);
        }
    }
    for (Light& l : s.lights) {
        Real white = 1 / root(static_cast<Real>(s.lights.size()));
        if (!l.coloured) l.colour = {white, white, white};
    }
}

// ---------------------------------------------------------------- the scene box, and a tree of boxes

Box bounds(const Scene& s, const Prim& p) {
    Box b;
    if (p.kind == Kind::Sphere) {
        Vec r{p.r0, p.r0, p.r0};
        b.add(p.a - r), b.add(p.a + r);
    } else if (p.kind == Kind::Disc) {
        b.add_circle(p.a, p.g, p.r0);
    } else if (p.kind == Kind::Cone) {
        b.add_circle(p.a, p.g, p.r0), b.add_circle(p.a + p.len * p.g, p.g, p.r1);
    } else {
        for (int k = 0; k < p.count; ++k) b.add(s.vertices[static_cast<size_t>(p.first + k)]);
    }
    return b;
}

// The tree only rejects, so its boxes are doubles with a margin far above their rounding.
int build_tree(Scene& s, const std::vector<Box>& boxes, int first, int count, Real margin) {
    int index = static_cast<int>(s.nodes.size());
    s.nodes.emplace_back();
    Box all, centres;
    for (int k = first; k < first + count; ++k) {
        const Box& b = boxes[static_cast<size_t>(s.order[static_cast<size_t>(k)])];
        all.add(b), centres.add(Real(0.5) * (b.lo + b.hi));
    }
    Node n;
    for (int c = 0; c < 3; ++c) {
        n.lo[c] = static_cast<double>(all.lo[c] - margin), n.hi[c] = static_cast<double>(all.hi[c] + margin);
    }
    n.first = first, n.count = count;
    if (count > 2) {
        Vec e = centres.hi - centres.lo;
        int axis = e.x >= e.y && e.x >= e.z ? 0 : e.y >= e.z ? 1 : 2;
        n.axis = axis;
        int half = count / 2;
        auto at = s.order.begin() + first;
        std::nth_element(at, at + half, at + count, [&](int i, int j) {
            const Box &a = boxes[static_cast<size_t>(i)], &b = boxes[static_cast<size_t>(j)];
            return a.lo[axis] + a.hi[axis] < b.lo[axis] + b.hi[axis];
        });
        n.count = 0;
        n.left = build_tree(s, boxes, first, half, margin);
        n.right = build_tree(s, boxes, first + half, count - half, margin);
    }
    s.nodes[static_cast<size_t>(index)] = n;
    return index;
}

void prepare(Scene& s) {
    Box all;
    all.add(s.from), all.add(s.at);
    std::vector<Box> boxes(s.prims.size());
    for (size_t i = 0; i < s.prims.size(); ++i) {
        if (s.prims[i].kind == Kind::Plane) {
            s.planes.push_back(static_cast<int>(i));
        } else {
            boxes[i] = bounds(s, s.prims[i]);
            all.add(boxes[i]), s.order.push_back(static_cast<int>(i));
        }
    }
    s.centre = Real(0.5) * (all.lo + all.hi);
    Real radius = Real(0.5) * length(all.hi - all.lo);
    if (s.far < 0) s.far = 16 * radius;
    Real scale = length(s.centre) + radius;
    s.t_min = machine_eps * (8192 * scale + (s.planes.empty() ? Real(0) : 32 * s.far));
    Real margin = Real(1e-10L) * (scale + (s.planes.empty() ? Real(0) : s.far));
    if (!s.order.empty()) build_tree(s, boxes, 0, static_cast<int>(s.order.size()), margin);
}

// ---------------------------------------------------------------- rays and surfaces

struct Ray {
    Vec o, d;
    int start = -1;  // the primitive on which o lies
};

// Whether the ray's line passes through the polygon. The vertices are sheared along the ray, and the edges
// that the positive first axis crosses are counted; two polygons that share an edge find the same of it.
bool inside(const Scene& s, const Prim& p, const Ray& ray) {
    Real ax = magnitude(ray.d.x), ay = magnitude(ray.d.y), az = magnitude(ray.d.z);
    int k = ax >= ay && ax >= az ? 0 : ay >= az ? 1 : 2, i = (k + 1) % 3, j = (k + 2) % 3;
    Real si = ray.d[i] / ray.d[k], sj = ray.d[j] / ray.d[k];
    bool in = false;
    const Vec* v = &s.vertices[static_cast<size_t>(p.first)];
    auto shear = [&](Vec q, Real& x, Real& y) {
        Vec r = q - ray.o;
        x = r[i] - si * r[k], y = r[j] - sj * r[k];
    };
    Real x0, y0, x1, y1;
    shear(v[p.count - 1], x0, y0);
    for (int m = 0; m < p.count; ++m, x0 = x1, y0 = y1) {
        shear(v[m], x1, y1);
        if ((y0 > 0) != (y1 > 0)) {
            Real c = x0 * y1 - x1 * y0;
            if (y1 > y0 ? c > 0 : c < 0) in = !in;
        }
    }
    return in;
}

// All t != 0 at which the ray meets the surface, at most two, in no order. Of the surface on which the ray
// starts, the crossing at t = 0 is taken out of the equation, not filtered by its size.
int crossings(const Scene& s, int index, const Ray& ray, Real t[2]) {
    const Prim& p = s.prim(index);
    bool self = index == ray.start;
    Vec o = ray.o - p.a;
    if (p.kind == Kind::Sphere) {
        Real b = dot(o, ray.d);
        if (self) {
            t[0] = -2 * b;
            return 1;
        }
        Vec foot = o - b * ray.d;
        Real h2 = p.r0 * p.r0 - dot(foot, foot);
        if (h2 < 0) return 0;
        Real h = root(h2);
        t[0] = -b - h, t[1] = -b + h;
        return 2;
    }
    if (p.kind == Kind::Cone) {
        Real z = dot(o, p.g), dz = dot(ray.d, p.g), r = p.r0 + p.slope * z;
        Vec op = o - z * p.g, dp = ray.d - dz * p.g;
        Real a = dot(dp, dp) - p.slope * p.slope * dz * dz;
        Real b = dot(op, dp) - p.slope * r * dz;
        Real root_t[2];
        int n = 0, kept = 0;
        if (self) {
            if (a != 0) root_t[n++] = -2 * b / a;
        } else {
            Real rho = length(op), c = (rho - r) * (rho + r), d = b * b - a * c;
            if (d < 0) return 0;
            Real q = -(b + (b < 0 ? -root(d) : root(d)));
            if (a != 0) root_t[n++] = q / a;
            if (q != 0) root_t[n++] = c / q;
        }
        for (int k = 0; k < n; ++k) {
            Real at = z + root_t[k] * dz;
            if (at >= 0 && at <= p.len) t[kept++] = root_t[k];
        }
        return kept;
    }
    Real dg = dot(ray.d, p.g);
    if (self || dg == 0) return 0;
    t[0] = -dot(o, p.g) / dg;
    if (!(t[0] > 0)) return 0;
    if (p.kind == Kind::Plane) {
        Vec q = ray.o + t[0] * ray.d - s.centre;
        return dot(q, q) <= s.far * s.far;
    }
    if (p.kind == Kind::Disc) {
        Vec q = o + t[0] * ray.d;
        return dot(q, q) <= p.r0 * p.r0;
    }
    return inside(s, p, ray);
}

// Calls f(index of a primitive) for all that the ray may meet before t_max, which f may lower.
template <class F>
void visit(const Scene& s, const Ray& ray, const Real& t_max, F f) {
    for (int i : s.planes) f(i);
    if (s.nodes.empty()) return;
    double o[3], inv[3];
    for (int c = 0; c < 3; ++c) {
        o[c] = static_cast<double>(ray.o[c]);
        double d = static_cast<double>(ray.d[c]);
        inv[c] = std::fabs(d) < 1e-30 ? 1e30 : 1 / d;
    }
    int stack[64], top = 0;
    stack[top++] = 0;
    while (top > 0) {
        const Node& n = s.nodes[static_cast<size_t>(stack[--top])];
        double t0 = 0, t1 = static_cast<double>(t_max) * (1 + 1e-9);
        for (int c = 0; c < 3; ++c) {
            double a = (n.lo[c] - o[c]) * inv[c], b = (n.hi[c] - o[c]) * inv[c];
            t0 = std::max(t0, std::min(a, b)), t1 = std::min(t1, std::max(a, b));
        }
        if (t0 > t1 * (1 + 1e-9)) continue;
        if (n.count > 0) {
            for (int k = 0; k < n.count; ++k) f(s.order[static_cast<size_t>(n.first + k)]);
        } else {
            bool forward = ray.d[n.axis] >= 0;  // the nearer child is looked at first
            stack[top++] = forward ? n.right : n.left;
            stack[top++] = forward ? n.left : n.right;
        }
    }
}

bool valid(const Scene& s, int index, const Ray& ray, Real t) {
    return t > (index == ray.start || ray.start < 0 ? Real(0) : s.t_min);
}

struct Hit {
    Real t = infinity;
    int prim = -1;
};

Hit nearest(const Scene& s, const Ray& ray) {
    Hit hit;
    visit(s, ray, hit.t, [&](int i) {
        Real t[2];
        int n = crossings(s, i, ray, t);
        for (int k = 0; k < n; ++k) {
            if (!valid(s, i, ray, t[k])) continue;
            if (t[k] < hit.t || (t[k] == hit.t && i < hit.prim)) hit.t = t[k], hit.prim = i;
        }
    });
    return hit;
}

// Does the surface hold the point, but for what the text's doubles are off?
bool holds(const Scene& s, int index, Vec p, Real scale) {
    const Prim& prim = s.prim(index);
    Real off = Real(1e-14L) * scale;
    Vec o = p - prim.a;
    if (prim.kind == Kind::Sphere) return magnitude(length(o) - prim.r0) <= off;
    Real z = dot(o, prim.g);
    if (prim.kind == Kind::Cone)
        return z >= -off && z <= prim.len + off && magnitude(length(o - z * prim.g) - prim.r0 - prim.slope * z) <= off;
    return magnitude(z) <= off;
}

// The product of `transmit` over all crossings between the ray's start and t_end. Where a lamp stands there, of a
// surface that holds it that crossing is taken out, not filtered by how near it is.
Real light_through(const Scene& s, const Ray& ray, Real t_end, const Vec* lamp = nullptr) {
    Real through = 1, t_max = t_end;
    visit(s, ray, t_max, [&](int i) {
        if (through == 0) return;
        Real t[2];
        int n = crossings(s, i, ray, t);
        int at_lamp = -1;
        if (n > 0 && lamp != nullptr && holds(s, i, *lamp, length(*lamp) + length(s.prim(i).a)))
            at_lamp = n == 2 && magnitude(t[1] - t_end) < magnitude(t[0] - t_end) ? 1 : 0;
        if (at_lamp >= 0 && magnitude(t[at_lamp] - t_end) > Real(1e-6L) * t_end) at_lamp = -1;  // that is beyond an end
        for (int k = 0; k < n; ++k)
            if (k != at_lamp && valid(s, i, ray, t[k]) && t[k] < t_end - s.t_min)
                through *= s.material(i).transmit;
        if (through == 0) t_max = 0;
    });
    return through;
}

// ---------------------------------------------------------------- normals, textures

Vec geometric_normal(const Prim& p, Vec q) {
    if (p.kind == Kind::Sphere) return (q - p.a) / p.r0;
    if (p.kind == Kind::Cone) {
        Vec o = q - p.a, across = o - dot(o, p.g) * p.g;
        Real rho = length(across);
        if (rho == 0) return p.slope < 0 ? p.g : -p.g;  // an apex has no normal; this one faces its eyes
        return unit(across / rho - p.slope * p.g);
    }
    return p.g;
}

Vec shading_normal(const Scene& s, const Prim& p, Vec q, Vec g) {
    if (p.kind != Kind::Triangle) return g;
    const Vec *v = &s.vertices[static_cast<size_t>(p.first)], *m = &s.normals[static_cast<size_t>(p.first)];
    Real area = dot(cross(v[1] - v[0], v[2] - v[0]), p.g);
    Real w1 = dot(cross(q - v[0], v[2] - v[0]), p.g) / area;
    Real w2 = dot(cross(v[1] - v[0], q - v[0]), p.g) / area;
    Vec n = (1 - w1 - w2) * m[0] + w1 * m[1] + w2 * m[2];
    Real len = length(n);
    return len > 64 * machine_eps * (length(m[0]) + length(m[1]) + length(m[2])) ? n / len : g;
}

uint32_t hash(int64_t x, int64_t y, int64_t z) {
    uint32_t h = static_cast<uint32_t>(x) * 0x8da6b343u ^ static_cast<uint32_t>(y) * 0xd8163841u ^
                 static_cast<uint32_t>(z) * 0xcb1ab31fu;
    h ^= h >> 15, h *= 0x2c1b3c6du, h ^= h >> 12, h *= 0x297a2d39u, h ^= h >> 15;
    return h;
}
Real lattice(int64_t x, int64_t y, int64_t z) { return static_cast<Real>(hash(x, y, z) >> 8) / 16777216; }

Real noise(Vec p) {
    Vec base{floor_of(p.x), floor_of(p.y), floor_of(p.z)}, f = p - base;
    auto smooth = [](Real x) { return x * x * (3 - 2 * x); };
    Real u = smooth(f.x), v = smooth(f.y), w = smooth(f.z), sum = 0;
    auto whole = [](Real x) { return static_cast<int64_t>(x); };
    int64_t x = whole(base.x), y = whole(base.y), z = whole(base.z);
    for (int c = 0; c < 8; ++c) {
        Real weight = (c & 1 ? u : 1 - u) * (c & 2 ? v : 1 - v) * (c & 4 ? w : 1 - w);
        sum += weight * lattice(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2));
    }
    return sum;
}

Real turbulence(Vec p) { return noise(p) + noise(2 * p) / 2 + noise(4 * p) / 4 + noise(8 * p) / 8; }

bool even(Real whole) { return whole == 2 * floor_of(whole / 2); }

Vec texel(const Image& m, Real s, Real t) {
    int x = std::min(m.width - 1, static_cast<int>(s * m.width));
    int y = std::min(m.height - 1, static_cast<int>(t * m.height));
    const uint8_t* c = &m.rgb[3 * static_cast<size_t>(y * m.width + x)];
    return Vec{Real(c[0]), Real(c[1]), Real(c[2])} / 255;
}

Vec surface_colour(const Scene& s, const Material& m, Vec q) {
    const Real e = Real(1) / 1024;
    Vec p = q / m.size;
    auto mix = [&](Real w) { return m.colour + w * (m.tex_colour - m.colour); };
    switch (m.tex) {
    case Tex::None: return m.colour;
    case Tex::Checker: return mix(even(floor_of(p.x + e) + floor_of(p.y + e) + floor_of(p.z + e)) ? 0 : 1);
    case Tex::Stripes: return mix(even(floor_of(dot(p, m.axis) + e)) ? 0 : 1);
    case Tex::Gradient: return mix(clamp01(dot(p, m.axis)));
    case Tex::Rings: return mix(even(floor_of(root(p.x * p.x + p.z * p.z) + e)) ? 0 : 1);
    case Tex::Noise: return mix(noise(p));
    case Tex::Marble: {
        Real w = frac(dot(p, m.axis) + 2 * turbulence(p)), t = 1 - magnitude(2 * w - 1);
        return mix(t * t * (3 - 2 * t));
    }
    case Tex::Wood: {
        Real w = frac(length(p - dot(p, m.axis) * m.axis) + noise(p) / 2);
        return mix(w * w);
    }
    case Tex::Brick: {
        Real h = even(floor_of(2 * p.y + e)) ? Real(0) : Real(0.5);
        bool mortar = frac(p.x + h + e) < Real(0.0625) || frac(p.z + h + e) < Real(0.0625) ||
                      frac(2 * p.y + e) < Real(0.125);
        return mix(mortar ? 1 : 0);
    }
    case Tex::Image: {
        Vec r = q - m.o;
        return texel(s.image(m), frac(dot(r, m.u) / dot(m.u, m.u)), frac(dot(r, m.v) / dot(m.v, m.v)));
    }
    case Tex::Globe: {
        Vec d = unit(q - m.o);
        return texel(s.image(m), frac(Real(0.5) + arc_tangent(d.x, d.z) / (2 * pi)),
                     Real(0.5) + arc_sine(d.y > 1 ? 1 : d.y < -1 ? -1 : d.y) / pi);
    }
    }
    return m.colour;
}

// ---------------------------------------------------------------- light

struct Settings {
    int max_depth = 5;
    Real cutoff = Real(0.0014L);
    int side = 1;         // a regular grid of side x side samples
    int levels = 0;       // adaptive sampling where > 0
    Real threshold = Real(0.0625);
};

// The points and directions that a light is, for that sample.
std::vector<Light> lamps(const Light& light, Sample sample) {
    if (!light.places) return {light};
    std::vector<Light> out;
    uint32_t h = hash(sample.x, sample.y, light.number);
    Real n = static_cast<Real>(light.places), a = (h % 65536 + Real(0.5)) / 65536, b = (h / 65536 + Real(0.5)) / 65536;
    for (int m = 0; m < light.places; ++m)
        for (int k = 0; k < light.places; ++k) {
            Light lamp;
            lamp.at = light.at + (2 * (k + a) / n - 1) * light.u + (2 * (m + b) / n - 1) * light.v;
            lamp.colour = light.colour / (n * n);
            out.push_back(lamp);
        }
    return out;
}

Vec trace(const Scene& s, const Settings& set, const Ray& ray, int depth, Real weight, Sample sample) {
    Hit hit = nearest(s, ray);
    if (hit.prim < 0) return s.background;
    const Prim& prim = s.prim(hit.prim);
    const Material& m = s.material(hit.prim);
    Vec d = ray.d, q = ray.o + hit.t * d;
    Vec g = geometric_normal(prim, q), n = shading_normal(s, prim, q, g);
    if (dot(n, d) > 0) n = -n;
    Vec base = surface_colour(s, m, q);

    Vec sum = m.emission * base + m.ambient * times(base, s.ambient);
    for (const Light& whole : s.lights) for (const Light& light : lamps(whole, sample)) {
        Vec to = light.sun ? light.at : light.at - q;
        Real distance = light.sun ? infinity : length(to);
        if (distance <= s.t_min) continue;
        Vec l = light.sun ? to : to / distance;
        Real nl = dot(n, l);
        if (!(nl > 0)) continue;
        Real through =
            s.shadows ? light_through(s, {q, l, hit.prim}, distance, light.sun ? nullptr : &light.at) : Real(1);
        if (through == 0) continue;
        Vec r = 2 * nl * n - l;
        Real rv = -dot(r, d);
        Real shine = m.highlight * power(rv > 0 ? rv : Real(0), m.shine);
        sum = sum + through * times(light.colour, m.diffuse * nl * base + Vec{shine, shine, shine});
    }
    if (depth >= set.max_depth) return sum;

    Real mirror = m.mirror, dn = dot(d, n);
    if (m.transmit > 0) {
        Real eta = dot(d, g) < 0 ? 1 / m.ior : m.ior;
        Vec across = d - dn * n;
        Real k = 1 - eta * eta * dot(across, across);
        if (k < 0) {
            mirror = std::min(Real(1), m.mirror + m.transmit);
        } else if (weight * m.transmit >= set.cutoff) {
            Vec refracted = unit(eta * d - (eta * dn + root(k)) * n);
            sum = sum + m.transmit * trace(s, set, {q, refracted, hit.prim}, depth + 1, weight * m.transmit, sample);
        }
    }
    if (mirror > 0 && weight * mirror >= set.cutoff)
        sum = sum + mirror * trace(s, set, {q, unit(d - 2 * dn * n), hit.prim}, depth + 1, weight * mirror, sample);
    return sum;
}

// ---------------------------------------------------------------- pixels

struct Camera {
    Vec eye, w, u, t;
    Real h = 0;
};

// At (px, py) in pixels, of those that are 1/side pixels wide.
Vec sample(const Scene& s, const Settings& set, const Camera& cam, Real px, Real py, int side) {
    Sample place{static_cast<uint32_t>(floor_of(px * side)), static_cast<uint32_t>(floor_of(py * side))};
    Real x = cam.h * s.width / s.height * (2 * px / s.width - 1), y = cam.h * (1 - 2 * py / s.height);
    Vec c = trace(s, set, {cam.eye, unit(cam.w + x * cam.u + y * cam.t), -1}, 1, 1, place);
    return {clamp01(c.x), clamp01(c.y), clamp01(c.z)};
}

// The mean over the square with that corner and side, cut in four.
Vec adaptive(const Scene& s, const Settings& set, const Camera& cam, Real px, Real py, Real side,
             int levels) {
    Real half = side / 2;
    Vec own[4], mean;
    for (int k = 0; k < 4; ++k)
        own[k] = sample(s, set, cam, px + (k % 2 + Real(0.5)) * half, py + (k / 2 + Real(0.5)) * half,
                        static_cast<int>(1 / half));
    for (int k = 0; k < 4; ++k) {
        Vec diff = own[k] - (own[(k + 1) % 4] + own[(k + 2) % 4] + own[(k + 3) % 4]) / 3;
        Real most = std::max(magnitude(diff.x), std::max(magnitude(diff.y), magnitude(diff.z)));
        Vec value = own[k];
        if (levels > 1 && most > set.threshold)
            value = adaptive(s, set, cam, px + (k % 2) * half, py + (k / 2) * half, half, levels - 1);
        mean = mean + value;
    }
    return mean / 4;
}

Vec pixel(const Scene& s, const Settings& set, const Camera& cam, int i, int j) {
    if (set.levels > 0) return adaptive(s, set, cam, Real(i), Real(j), Real(1), set.levels);
    Vec sum;
    for (int b = 0; b < set.side; ++b)
        for (int a = 0; a < set.side; ++a)
            sum = sum + sample(s, set, cam, i + (a + Real(0.5)) / set.side, j + (b + Real(0.5)) / set.side, set.side);
    return sum / (set.side * set.side);
}

int main(int argc, char** argv) {
    std::string scene_path, out;
    Settings set;
    int width = 0, height = 0, threads = static_cast<int>(std::thread::hardware_concurrency());
    for (int i = 1; i < argc; ++i) {
        std::string a = argv[i];
        auto value = [&] { if (++i >= argc) fail(a + " needs a value"); return std::string(argv[i]); };
        if (a == "-o") out = value();
        else if (a == "-s") {
            if (std::sscanf(value().c_str(), "%dx%d", &width, &height) != 2) fail("-s WxH");
        }
        else if (a == "-r") set.side = static_cast<int>(std::lround(std::sqrt(std::atof(value().c_str()))));
        else if (a == "-a") {
            std::string v = value();
            set.levels = std::atoi(v.c_str());
            size_t comma = v.find(',');
            if (comma != std::string::npos) set.threshold = parse_real(v.c_str() + comma + 1, nullptr);
        }
        else if (a == "-d") set.max_depth = std::atoi(value().c_str());
        else if (a == "--cutoff") set.cutoff = parse_real(value().c_str(), nullptr);
        else if (a == "-j") threads = std::atoi(value().c_str());
        else if (a == "-" || a[0] != '-') scene_path = a;
        else fail("unknown option " + a);
    }
    if (scene_path.empty() || out.empty()) fail("usage: oracle SCENE.nff -o out.ppm [options]");

    Scene s;
    Reader in(scene_path);
    read_scene(in, s);
    if (width > 0) s.width = width, s.height = height;
    prepare(s);
    if (s.dropped > 0) std::fprintf(stderr, "oracle: %d without extent dropped\n", s.dropped);

    Camera cam;
    cam.eye = s.from, cam.w = unit(s.at - s.from);
    cam.u = unit(cross(cam.w, s.up)), cam.t = cross(cam.u, cam.w);
    cam.h = tangent(s.angle * pi / 360);

    std::vector<uint8_t> bytes(3 * static_cast<size_t>(s.width) * static_cast<size_t>(s.height));
    std::atomic<int> next{0};
    auto work = [&] {
        for (int j; (j = next++) < s.height;)
            for (int i = 0; i < s.width; ++i) {
                Vec c = pixel(s, set, cam, i, j);
                size_t at = 3 * static_cast<size_t>(j * s.width + i);
                for (int k = 0; k < 3; ++k) {
                    Real level = floor_of(255 * c[k] + Real(0.5));
                    bytes[at + static_cast<size_t>(k)] = static_cast<uint8_t>(level);
                }
            }
    };
    std::vector<std::thread> pool;
    for (int k = 0; k < std::max(1, threads); ++k) pool.emplace_back(work);
    for (auto& t : pool) t.join();

    FILE* f = out == "-" ? stdout : std::fopen(out.c_str(), "wb");
    if (!f) fail("cannot write " + out);
    std::fprintf(f, "P6\n%d %d\n255\n", s.width, s.height);
    bool bad = std::fwrite(bytes.data(), 1, bytes.size(), f) != bytes.size();
    bad |= std::fflush(f) != 0 || (f != stdout && std::fclose(f) != 0);
    if (bad) fail("cannot write " + out);
    return 0;
}
