// FLIP: how different two pictures look to someone who flips between them, for each pixel in [0, 1].
//   P. Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström, M. D. Fairchild: FLIP: A Difference Evaluator
//   for Alternating Images. Proceedings of the ACM in Computer Graphics and Interactive Techniques 3(2), 2020.
// The version for pictures of low dynamic range, with the paper's constants. Both pictures are blurred as the eye blurs
// what it sees from that far away; what is left of their colours' difference is raised where edges or points differ.
//
// Pictures are bytes of red, green and blue, row after row, and are taken as sRGB. qray writes light as it is, without
// gamma, but whoever looks at a PPM, or sends its bytes to a display, sees them as sRGB: judged is what is seen.
//
// Double precision, with its own exponential and logarithm: no library, and the same on every machine.
#pragma once

#include <stddef.h>
#include <stdint.h>

namespace qray::study {

namespace flip {

constexpr double magnitude(double x) { return x < 0 ? -x : x; }
constexpr double larger(double a, double b) { return a > b ? a : b; }
constexpr double clamped(double x) { return x < 0 ? 0 : x > 1 ? 1 : x; }
inline double root(double x) { return __builtin_sqrt(x); }

// e^x for x < 700, to a relative 1e-15; 0 below -700.
constexpr double exponential(double x)
{
    if (x < -700)
        return 0;
    const double halves = x * 1.4426950408889634 + (x < 0 ? -0.5 : 0.5);
    const auto power = static_cast<int64_t>(halves);
    // ln 2 in two parts, of which the first has few bits.
    const double n = static_cast<double>(power), r = x - n * 0.693147180369123816 - n * 1.90821492927058770e-10;
    double sum = 1;
    for (int k = 14; k > 0; k--)
        sum = 1 + sum * r / k;
    return sum * __builtin_bit_cast(double, static_cast<uint64_t>(1023 + power) << 52);
}

// The natural logarithm of a normal number above 0, to 1e-15 of it or of 1, whichever is larger.
constexpr double logarithm(double x)
{
    const auto bits = __builtin_bit_cast(uint64_t, x);
    auto power = static_cast<int64_t>(bits >> 52) - 1023;
    double m = __builtin_bit_cast(double, (bits & 0xfffffffffffff) | uint64_t{1023} << 52);
    if (m > 1.4142135623730951) {
        m /= 2;
        power++;
    }
    // 2 artanh(s), |s| < 0.172.
    const double s = (m - 1) / (m + 1), square = s * s;
    double sum = 0;
    for (int k = 23; k > 0; k -= 2)
        sum = sum * square + 1.0 / k;
    return static_cast<double>(power) * 0.69314718055994531 + 2 * s * sum;
}

// x^e for x in [0, 1000], e in [0, 3].
constexpr double power(double x, double e)
{
    return x < 1e-300 ? (e > 0 ? 0 : 1) : exponential(e * logarithm(x));
}

struct Colour {
    double x, y, z;
};

// Linear RGB to XYZ, each over that of white (D65): white is (1, 1, 1). And back.
constexpr Colour xyz_of(Colour c)
{
    return {(10135552 * c.x + 8788810 * c.y + 4435075 * c.z) / 23359437,
            (2613072 * c.x + 8788810 * c.y + 887015 * c.z) / 12288897,
            (1425312 * c.x + 8788810 * c.y + 70074185 * c.z) / 80288307};
}
constexpr Colour rgb_of(Colour c)
{
    return {3.080341988280461 * c.x - 1.5373989694887855 * c.y - 0.5429430187916751 * c.z,
            -0.9211783961651236 * c.x + 1.875929983695176 * c.y + 0.04524841246994758 * c.z,
            0.05288129287554325 * c.x - 0.20401120612390997 * c.y + 1.1511299132483668 * c.z};
}

// The light of a byte in sRGB.
constexpr double light_of(uint32_t byte)
{
    const double v = byte / 255.0;
    return v > 0.04045 ? power((v + 0.055) / 1.055, 2.4) : v / 12.92;
}

// XYZ over white to L*a*b*, whose a and b count for less in the dark (Hunt).
constexpr Colour lab_of(Colour c)
{
    constexpr auto f = [](double t) {
        constexpr double delta = 6.0 / 29;
        return t > delta * delta * delta ? power(t, 1.0 / 3) : t / (3 * delta * delta) + 4.0 / 29;
    };
    const double y = f(c.y), lightness = 116 * y - 16;
    return {lightness, 5 * lightness * (f(c.x) - y), 2 * lightness * (y - f(c.z))};
}

// How far two such colours are apart (HyAB), and what is left of it in FLIP, [0, 1]: the largest difference, of green
// and blue, is 1, and what is above 0.4 of it is pressed into the last 0.05.
inline double distance(Colour a, Colour b)
{
    const double da = a.y - b.y, db = a.z - b.z;
    return magnitude(a.x - b.x) + root(da * da + db * db);
}
inline double most() { return power(distance(lab_of(xyz_of({0, 1, 0})), lab_of(xyz_of({0, 0, 1}))), 0.7); }
inline double share_of(double distance, double most)
{
    const double e = power(distance, 0.7) / most;
    return e < 0.4 ? e * 0.95 / 0.4 : 0.95 + (e - 0.4) / 0.6 * 0.05;
}

} // namespace flip

class Flip {
public:
    // The paper's: a monitor of 0.7 m and 3840 pixels, seen from 0.7 m.
    static constexpr double default_pixels_per_degree = 67;
    static constexpr double min_pixels_per_degree = 1, max_pixels_per_degree = 230;

    // `pixels_per_degree` of what is seen, from the least to the most.
    explicit Flip(double pixels_per_degree = default_pixels_per_degree)
    {
        constexpr double pi = 3.14159265358979324;
        // The paper writes its Gaussians as e^(-pi^2 x^2 / b), x in degrees.
        constexpr auto deviation = [](double b) { return flip::root(b / (2 * pi * pi)); };
        constexpr double b[] = {0.0047, 0.0053, 0.04, 0.025}, feature = 0.082;
        reach = at_least(3 * deviation(b[2]) * pixels_per_degree);
        double sums[blurs];
        for (int i = 0; i < blurs; i++)
            sums[i] = gaussian(kernels[i], reach, deviation(b[i]) * pixels_per_degree);
        // Blue and yellow are blurred by two Gaussians, that are added.
        const double one = 34.1 * flip::root(pi / b[2]) * sums[2] * sums[2];
        const double other = 13.5 * flip::root(pi / b[3]) * sums[3] * sums[3];
        first_share = one / (one + other);
        // Edges and points are where a Gaussian's first and second derivative find something.
        const double sigma = 0.5 * feature * pixels_per_degree;
        feature_reach = at_least(3 * sigma);
        gaussian(kernels[smooth], feature_reach, sigma);
        double above[2] = {}, below = 0;
        for (int i = -feature_reach; i <= feature_reach; i++) {
            const double weight = kernels[smooth][i + feature_reach], x = i / sigma;
            const double slope = -x * weight, bend = (x * x - 1) * weight;
            kernels[edge][i + feature_reach] = slope;
            kernels[point][i + feature_reach] = bend;
            above[0] += flip::larger(slope, 0);
            above[1] += flip::larger(bend, 0);
            below += flip::larger(-bend, 0);
        }
        for (int i = 0; i <= 2 * feature_reach; i++) {
            kernels[edge][i] /= above[0];
            kernels[point][i] /= kernels[point][i] > 0 ? above[1] : below;
        }
        for (uint32_t i = 0; i < 256; i++)
            light[i] = flip::light_of(i);
        most = flip::most();
    }

    // Doubles that row() works in.
    static constexpr size_t room(uint32_t width) { return size_t{2 * planes} * width; }

    // FLIP of each pixel of row y, of two pictures of the same size. Beyond an edge a picture goes on as it is there.
    void row(const uint8_t* reference, const uint8_t* test, uint32_t width, uint32_t height, uint32_t y, double* work,
             double* out) const
    {
        const auto w = static_cast<int>(width), h = static_cast<int>(height), at = static_cast<int>(y);
        double* const other = work + room(width) / 2;
        columns(reference, w, h, at, work);
        columns(test, w, h, at, other);
        for (int x = 0; x < w; x++) {
            const Seen a = seen_at(work, w, x), b = seen_at(other, w, x);
            const double colours = flip::share_of(flip::distance(a.lab, b.lab), most);
            const double features = flip::larger(flip::magnitude(a.edge - b.edge), flip::magnitude(a.point - b.point));
            out[x] = flip::power(colours, 1 - flip::root(features * 0.70710678118654752));
        }
    }

    // The threshold of seeing: FLIP of two plain greys that are a just noticeable difference apart, which is 2.3 in
    // CIELAB (M. Mahy, L. Van Eycken, A. Oosterlinck: Evaluation of Uniform Color Spaces Developed after the Adoption
    // of CIELAB and CIELUV. Color Research and Application 19(2), 1994). About 0.103.
    double threshold() const { return flip::share_of(2.3, most); }

private:
    // Of CSF filters: light, red-green, blue-yellow in two parts; and of features.
    enum Kernel { blurs = 4, smooth = 4, edge, point, planes };
    static constexpr int max_reach = 32;
    struct Seen {
        flip::Colour lab;
        double edge, point;
    };

    static constexpr int at_least(double x)
    {
        const int whole = static_cast<int>(x);
        return whole < x ? whole + 1 : whole;
    }
    // Returns the sum before it is made 1.
    static constexpr double gaussian(double* kernel, int radius, double sigma)
    {
        double sum = 0;
        for (int i = -radius; i <= radius; i++)
            sum += kernel[i + radius] = flip::exponential(-i * i / (2 * sigma * sigma));
        for (int i = 0; i <= 2 * radius; i++)
            kernel[i] /= sum;
        return sum;
    }
    static constexpr int within(int i, int n) { return i < 0 ? 0 : i < n ? i : n - 1; }

    // Each kernel down the columns of a row, into a plane each. Filters are separable, and linear: as their weights
    // have the sum 1, Y, Cx and Cz are filtered as y, x - y and y - z, without the paper's factors.
    void columns(const uint8_t* rgb, int width, int height, int y, double* to) const
    {
        for (int x = 0; x < width; x++) {
            double sums[planes] = {};
            for (int i = -reach; i <= reach; i++) {
                const uint8_t* const p = rgb + 3 * (static_cast<ptrdiff_t>(within(y + i, height)) * width + x);
                const flip::Colour c = flip::xyz_of({light[p[0]], light[p[1]], light[p[2]]});
                const double channels[blurs] = {c.y, c.x - c.y, c.y - c.z, c.y - c.z};
                for (int k = 0; k < blurs; k++)
                    sums[k] += kernels[k][i + reach] * channels[k];
                if (i >= -feature_reach && i <= feature_reach)
                    for (int k = smooth; k < planes; k++)
                        sums[k] += kernels[k][i + feature_reach] * c.y;
            }
            for (int k = 0; k < planes; k++)
                to[k * width + x] = sums[k];
        }
    }
    // A kernel along the row of a plane.
    double along(Kernel kernel, const double* plane, int width, int x) const
    {
        const int radius = kernel < blurs ? reach : feature_reach;
        double sum = 0;
        for (int i = -radius; i <= radius; i++)
            sum += kernels[kernel][i + radius] * plane[within(x + i, width)];
        return sum;
    }
    Seen seen_at(const double* from, int width, int x) const
    {
        const auto filtered = [=, this](int along_row, int along_column) {
            return along(static_cast<Kernel>(along_row), from + along_column * width, width, x);
        };
        const auto length = [&filtered](int kernel) {
            const double right = filtered(kernel, smooth), up = filtered(smooth, kernel);
            return flip::root(right * right + up * up);
        };
        const double light_seen = filtered(0, 0);
        const double blue = first_share * filtered(2, 2) + (1 - first_share) * filtered(3, 3);
        const flip::Colour c = flip::rgb_of({light_seen + filtered(1, 1), light_seen, light_seen - blue});
        const flip::Colour shown = {flip::clamped(c.x), flip::clamped(c.y), flip::clamped(c.z)};
        return {flip::lab_of(flip::xyz_of(shown)), length(edge), length(point)};
    }

    double kernels[planes][2 * max_reach + 1], light[256], first_share, most;
    int reach, feature_reach;
};

} // namespace qray::study
