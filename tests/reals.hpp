// Vectors of real numbers: of double, long double and __float128.
#pragma once

#include <cmath>
#include <type_traits>

#include <qray/vector/vec.hpp>

namespace qray::test {

template <class R>
Vec<R> operator*(const Vec<R>& a, std::type_identity_t<R> k)
{
    return {a.x * k, a.y * k, a.z * k};
}
template <class R>
R dot(const Vec<R>& a, const Vec<R>& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class R>
Vec<R> cross(const Vec<R>& a, const Vec<R>& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class R>
R root(R v)
{
    return std::sqrt(v);
}
// The 64 bits of long double's root, doubled by a Newton step.
inline __float128 root(__float128 v)
{
    if (!(v > 0))
        return 0;
    const __float128 s = static_cast<__float128>(std::sqrt(static_cast<long double>(v)));
    return (s + v / s) / 2;
}
template <class R>
R length(const Vec<R>& a)
{
    return root(dot(a, a));
}
template <class R>
Vec<R> unit(const Vec<R>& a)
{
    return a * (R(1) / length(a));
}

} // namespace qray::test
