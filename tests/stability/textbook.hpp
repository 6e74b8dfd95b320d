// The forms that textbooks and tutorials give, for comparison: b^2 - 4ac, a threshold on t, Moeller and
// Trumbore's triangle; in float and double, and in Q16.16 and Q8.24, whose every product is rounded. They
// know nothing of surfaces left: a hit nearer than the threshold is none, and a farther one than `farthest`
// is beyond the world.
#pragma once

#include <cmath>
#include <cstdint>

#include "../hostile/shapes.hpp"

namespace textbook {

inline constexpr double threshold = 1e-3, farthest = 250;

// 64 bits, so that nothing overflows; Frac of them behind the point after every operation.
template <int Frac>
struct Fixed {
    int64_t raw = 0;
    Fixed() = default;
    constexpr explicit Fixed(int64_t r) : raw(r) {}
    static Fixed of(double v) { return Fixed(std::llrint(std::ldexp(v, Frac))); }
    double value() const { return std::ldexp(static_cast<double>(raw), -Frac); }
    friend constexpr Fixed operator+(Fixed a, Fixed b) { return Fixed(a.raw + b.raw); }
    friend constexpr Fixed operator-(Fixed a, Fixed b) { return Fixed(a.raw - b.raw); }
    constexpr Fixed operator-() const { return Fixed(-raw); }
    friend constexpr Fixed operator*(Fixed a, Fixed b)
    {
        return Fixed(static_cast<int64_t>(static_cast<__int128>(a.raw) * b.raw >> Frac));
    }
    friend constexpr Fixed operator/(Fixed a, Fixed b)
    {
        if (b.raw == 0)
            return Fixed(0);
        return Fixed(static_cast<int64_t>((static_cast<__int128>(a.raw) << Frac) / b.raw));
    }
    friend constexpr bool operator<(Fixed a, Fixed b) { return a.raw < b.raw; }
    friend constexpr bool operator>(Fixed a, Fixed b) { return a.raw > b.raw; }
};
template <int Frac>
Fixed<Frac> root(Fixed<Frac> a)
{
    return Fixed<Frac>(qray::isqrt(static_cast<uint64_t>(a.raw) << Frac));
}

template <class F>
struct Real {
    F v = 0;
    static Real of(double x) { return {static_cast<F>(x)}; }
    double value() const { return static_cast<double>(v); }
    friend Real operator+(Real a, Real b) { return {a.v + b.v}; }
    friend Real operator-(Real a, Real b) { return {a.v - b.v}; }
    Real operator-() const { return {-v}; }
    friend Real operator*(Real a, Real b) { return {a.v * b.v}; }
    friend Real operator/(Real a, Real b) { return {a.v / b.v}; }
    friend bool operator<(Real a, Real b) { return a.v < b.v; }
    friend bool operator>(Real a, Real b) { return a.v > b.v; }
};
template <class F>
Real<F> root(Real<F> a)
{
    return {std::sqrt(a.v)};
}

using qray::Vec;
using qray::test::operator*;
using qray::test::cross;
using qray::test::dot;

template <class T>
struct Ray {
    Vec<T> o, d;
};
template <class T, class V>
Vec<T> vec(const V& v)
{
    const auto w = hostile::exact3<double>(v);
    return {T::of(w.x), T::of(w.y), T::of(w.z)};
}
// What the number systems store with more bits where it is small.
template <class T, class L, class Shape>
T fine(L length, const Shape& s)
{
    return T::of(std::ldexp(hostile::exact<double>(length), -s.fine));
}
template <class T, class N>
Ray<T> ray(const qray::Ray<N>& r)
{
    return {vec<T>(r.origin), vec<T>(r.direction)};
}

// The nearer root of a t^2 + b t + c beyond the threshold whose hit `holds`.
template <class T, class Holds>
bool solve(T a, T b, T c, T& t, Holds holds)
{
    const T four = T::of(4), two = T::of(2), zero = T::of(0), least = T::of(threshold);
    const T disc = b * b - four * a * c;
    if (disc < zero || !(a > zero || a < zero))
        return false;
    const T s = root(disc), t0 = (-b - s) / (two * a), t1 = (-b + s) / (two * a);
    const T near = t0 < t1 ? t0 : t1, far = t0 < t1 ? t1 : t0;
    if (near > least && holds(near)) {
        t = near;
        return true;
    }
    if (far > least && holds(far)) {
        t = far;
        return true;
    }
    return false;
}

template <class T>
struct Sphere {
    Vec<T> c;
    T r;
    template <class Trial>
    void look_at(const Trial& s)
    {
        c = vec<T>(s.shape.centre);
        r = fine<T>(s.shape.radius, s.shape);
    }
    bool hit(const Ray<T>& ray, T& t) const
    {
        const Vec<T> v = ray.o - c;
        const T b = T::of(2) * dot(v, ray.d);
        return solve(dot(ray.d, ray.d), b, dot(v, v) - r * r, t, [](T) { return true; });
    }
};

template <class T>
struct Disc {
    Vec<T> c, n;
    T r;
    template <class Trial>
    void look_at(const Trial& s)
    {
        c = vec<T>(s.shape.centre);
        n = vec<T>(s.shape.normal);
        r = T::of(hostile::exact<double>(s.shape.radius));
    }
    bool hit(const Ray<T>& ray, T& t) const
    {
        const T den = dot(ray.d, n), small = T::of(1e-6);
        if (!(den > small || den < -small))
            return false;
        t = dot(c - ray.o, n) / den;
        if (!(t > T::of(threshold) && t < T::of(farthest)))
            return false;
        const Vec<T> w = ray.o + ray.d * t - c;
        return !(dot(w, w) > r * r);
    }
};

// A cone around its axis from its base, in the world's frame: with v = p - base and h = v.axis,
// |v|^2 - h^2 = (r + slope h)^2.
template <class T>
struct Cone {
    Vec<T> base, axis;
    T r, slope, height;
    template <class Trial>
    void look_at(const Trial& s)
    {
        using hostile::exact;
        const auto a = hostile::exact3<double>(s.shape.axis);
        const double half = std::ldexp(exact<double>(s.shape.half), -s.shape.fine);
        const double rho = std::ldexp(exact<double>(s.shape.rho0), -s.shape.fine);
        const double sine = exact<double>(s.shape.sine), cosine = exact<double>(s.shape.cosine);
        const auto b = hostile::exact3<double>(s.shape.middle) - a * half;
        base = {T::of(b.x), T::of(b.y), T::of(b.z)};
        axis = {T::of(a.x), T::of(a.y), T::of(a.z)};
        r = T::of((rho - sine * half) / cosine);
        slope = T::of(sine / cosine);
        height = T::of(2 * half);
    }
    bool hit(const Ray<T>& ray, T& t) const
    {
        const Vec<T> v = ray.o - base;
        const T va = dot(v, axis), da = dot(ray.d, axis), two = T::of(2), zero = T::of(0);
        const T rv = r + slope * va, k = T::of(1) + slope * slope;
        const T a = dot(ray.d, ray.d) - k * da * da, b = two * (dot(v, ray.d) - va * da - slope * da * rv);
        const T c = dot(v, v) - va * va - rv * rv;
        return solve(a, b, c, t, [&](T at) {
            const T h = va + da * at;
            return h > zero && h < height;
        });
    }
};

// The plane's equation, then crossings around the hit in the plane of two axes.
template <class T>
struct Polygon {
    Vec<T> n, corners[16];
    uint32_t count = 0;
    template <class Trial>
    void look_at(const Trial& s)
    {
        n = vec<T>(s.shape.normal);
        count = s.figure.count;
        for (uint32_t i = 0; i < count; i++)
            corners[i] = vec<T>(s.bench.storage.vertices.data[i]);
    }
    bool hit(const Ray<T>& ray, T& t) const
    {
        const T den = dot(ray.d, n), small = T::of(1e-6), zero = T::of(0);
        if (!(den > small || den < -small))
            return false;
        t = dot(corners[0] - ray.o, n) / den;
        if (!(t > T::of(threshold) && t < T::of(farthest)))
            return false;
        const Vec<T> q = ray.o + ray.d * t;
        const auto size = [zero](T v) { return v < zero ? -v : v; };
        const T ax = size(n.x), ay = size(n.y), az = size(n.z);
        const int drop = ax > ay && ax > az ? 0 : ay > az ? 1 : 2;
        const auto u = [drop](const Vec<T>& v) { return drop == 0 ? v.y : v.x; };
        const auto w = [drop](const Vec<T>& v) { return drop == 2 ? v.y : v.z; };
        bool inside = false;
        for (uint32_t i = 0, j = count - 1; i < count; j = i++) {
            const Vec<T>&a = corners[i], &b = corners[j];
            if ((w(a) > w(q)) != (w(b) > w(q)) && u(q) < (u(b) - u(a)) * (w(q) - w(a)) / (w(b) - w(a)) + u(a))
                inside = !inside;
        }
        return inside;
    }
};

// Moeller and Trumbore, Fast, Minimum Storage Ray/Triangle Intersection, 1997.
template <class T>
struct Triangle {
    Vec<T> v0, e1, e2;
    template <class Trial>
    void look_at(const Trial& s)
    {
        const auto* v = s.bench.storage.vertices.data;
        v0 = vec<T>(v[0]);
        e1 = vec<T>(v[1]) - v0;
        e2 = vec<T>(v[2]) - v0;
    }
    bool hit(const Ray<T>& ray, T& t) const
    {
        const T zero = T::of(0), one = T::of(1), small = T::of(1e-6);
        const Vec<T> p = cross(ray.d, e2);
        const T det = dot(e1, p);
        if (!(det > small || det < -small))
            return false;
        const Vec<T> s = ray.o - v0, q = cross(s, e1);
        const T u = dot(s, p) / det, v = dot(ray.d, q) / det;
        if (u < zero || v < zero || u + v > one)
            return false;
        t = dot(e2, q) / det;
        return t > T::of(threshold) && t < T::of(farthest);
    }
};

} // namespace textbook
