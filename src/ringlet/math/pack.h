// Pack: a SIMD vector of doubles with one strand per lane. Formulas of kernels are templates of T = Pack or T = double.
// This header is compiled once per instruction set, each time in a namespace of its own (see cmake/Simd.cmake).
#pragma once

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#ifndef RINGLET_SIMD
#define RINGLET_SIMD baseline
#endif

namespace ringlet::RINGLET_SIMD {

#if defined(__AVX512F__)
inline constexpr int lanes = 8;
#elif defined(__AVX2__)
inline constexpr int lanes = 4;
#else
inline constexpr int lanes = 2;
#endif

typedef double Pack __attribute__((vector_size(lanes * sizeof(double))));
using Mask = decltype(Pack{} < Pack{}); // all bits set where true

template <class T> struct Traits;
template <> struct Traits<double> {
    using Mask = bool;
    static constexpr int lanes = 1;
};
template <> struct Traits<Pack> {
    using Mask = RINGLET_SIMD::Mask;
    static constexpr int lanes = RINGLET_SIMD::lanes;
};
template <class T> using MaskOf = typename Traits<T>::Mask;

template <class T> inline T constant(double value) { return T{} + value; }

inline double select(bool mask, double a, double b) { return mask ? a : b; }
inline Pack select(Mask mask, Pack a, Pack b) { return mask ? a : b; }

inline bool any(bool mask) { return mask; }
inline bool any(Mask mask) {
#if defined(__AVX512F__)
    return _mm512_test_epi64_mask((__m512i)mask, (__m512i)mask) != 0;
#endif
    auto some = mask[0];
    for (int lane = 1; lane < lanes; ++lane) some |= mask[lane];
    return some != 0;
}

inline double lane(double value, int) { return value; }
inline double lane(const Pack &value, int index) { return value[index]; }
inline void set_lane(double &value, int, double to) { value = to; }
inline void set_lane(Pack &value, int index, double to) { value[index] = to; }

inline double sqrt(double x) { return __builtin_sqrt(x); }
inline Pack sqrt(Pack x) {
#if defined(__AVX512F__)
    return (Pack)_mm512_sqrt_pd((__m512d)x);
#elif defined(__AVX2__)
    return (Pack)_mm256_sqrt_pd((__m256d)x);
#elif defined(__SSE2__)
    return (Pack)_mm_sqrt_pd((__m128d)x);
#else
    for (int lane = 0; lane < lanes; ++lane) x[lane] = __builtin_sqrt(x[lane]);
    return x;
#endif
}

template <class T> inline T min(T a, T b) { return select(a < b, a, b); }
template <class T> inline T max(T a, T b) { return select(a > b, a, b); }
template <class T> inline T abs(T x) { return select(x < 0.0, -x, x); }
template <class T> inline T sign(T x) { return select(x < 0.0, constant<T>(-1.0), constant<T>(1.0)); } // sign(0) = +1

inline constexpr double pi = 3.14159265358979323846;

// Nearest integer, for |x| < 2^51. The sum with 1.5·2^52 has no bits left for a fraction.
template <class T> inline T round(T x) {
    const double shift = 6755399441055744.0;
    return (x + shift) - shift;
}

// The angle brought to (−π, π].
template <class T> inline T wrap(T angle) { return angle - 2.0 * pi * round(angle * (0.5 / pi)); }

// atan2, accurate to two units in the last place; atan2(0, 0) = 0. The identity atan(r) = π/4 + atan((r − 1)/(r + 1)) reduces
// the argument to |q| ≤ tan(π/8). There atan is a polynomial in q², interpolated at Chebyshev nodes (error 4e-18).
template <class T> inline T atan2(T y, T x) {
    const double tan_pi_8 = 0.41421356237309504880;
    const T ax = abs(x), ay = abs(y);
    const T low = min(ax, ay), high = max(ax, ay);
    const auto far = low > tan_pi_8 * high;
    const T numerator = select(far, low - high, low);
    const T denominator = select(far, low + high, high);
    const T q = numerator / select(denominator > 0.0, denominator, constant<T>(1.0));
    const T z = q * q;
    T p = constant<T>(-0.017805397205419446);
    p = p * z + 0.03796525745386593;
    p = p * z - 0.05035102456601552;
    p = p * z + 0.05846878297330872;
    p = p * z - 0.06662951813629191;
    p = p * z + 0.07692045330902225;
    p = p * z - 0.09090896809064027;
    p = p * z + 0.11111110744919658;
    p = p * z - 0.14285714279250245;
    p = p * z + 0.19999999999940893;
    p = p * z - 0.3333333333333312;
    T angle = q + q * z * p;
    angle = select(far, angle + pi / 4, angle);
    angle = select(ay > ax, pi / 2 - angle, angle);
    angle = select(x < 0.0, pi - angle, angle);
    return select(y < 0.0, -angle, angle);
}

template <class T> struct SineCosine {
    T sine, cosine;
};

// Sine and cosine for |x| ≤ π/2 and a little beyond, by polynomials interpolated at Chebyshev nodes (errors 1e-16).
template <class T> inline SineCosine<T> sine_cosine_quarter(T x) {
    const T z = x * x;
    T sine = constant<T>(-7.374119385051447e-13);
    sine = sine * z + 1.6048146803827966e-10;
    sine = sine * z - 2.5051881272501282e-08;
    sine = sine * z + 2.755731659866929e-06;
    sine = sine * z - 0.00019841269824780153;
    sine = sine * z + 0.008333333333282452;
    sine = sine * z - 0.1666666666666607;
    T cosine = constant<T>(4.6088093988032985e-14);
    cosine = cosine * z - 1.1462886384313275e-11;
    cosine = cosine * z + 2.0876561258872958e-09;
    cosine = cosine * z - 2.755731637975365e-07;
    cosine = cosine * z + 2.48015872772945e-05;
    cosine = cosine * z - 0.0013888888888772296;
    cosine = cosine * z + 0.04166666666666386;
    cosine = cosine * z - 0.4999999999999997;
    return {x + x * z * sine, cosine * z + 1.0};
}

// Sine and cosine of any angle. Each half turn that is subtracted changes both signs.
template <class T> inline SineCosine<T> sine_cosine(T x) {
    const T half_turns = round(x * (1.0 / pi));
    const SineCosine<T> rest = sine_cosine_quarter(x - pi * half_turns);
    const auto odd = abs(half_turns - 2.0 * round(0.5 * half_turns)) > 0.5;
    return {select(odd, -rest.sine, rest.sine), select(odd, -rest.cosine, rest.cosine)};
}

template <class T> struct Vec {
    T x, y, z;
    T &operator[](int k) { return (&x)[k]; }
    const T &operator[](int k) const { return (&x)[k]; }
};

template <class T> inline Vec<T> operator+(Vec<T> a, Vec<T> b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
template <class T> inline Vec<T> operator-(Vec<T> a, Vec<T> b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
template <class T> inline Vec<T> operator-(Vec<T> a) { return {-a.x, -a.y, -a.z}; }
template <class T> inline Vec<T> operator*(T s, Vec<T> a) { return {s * a.x, s * a.y, s * a.z}; }
template <class T> inline T dot(Vec<T> a, Vec<T> b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
template <class T> inline Vec<T> cross(Vec<T> a, Vec<T> b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T> inline T norm(Vec<T> a) { return sqrt(dot(a, a)); }
template <class T> inline Vec<T> select(MaskOf<T> mask, Vec<T> a, Vec<T> b) {
    return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}

// Some unit vector perpendicular to the unit vector t.
template <class T> inline Vec<T> perpendicular(Vec<T> t) {
    const auto x_small = abs(t.x) < 0.6;
    const Vec<T> axis{select(x_small, constant<T>(1.0), T{}), select(x_small, T{}, constant<T>(1.0)), T{}};
    const Vec<T> p = cross(t, axis);
    return (1.0 / norm(p)) * p;
}

// Parallel transport of v: the smallest rotation that takes the unit vector a to the unit vector b, applied to v.
template <class T> inline Vec<T> transport(Vec<T> v, Vec<T> a, Vec<T> b) {
    const Vec<T> axis = cross(a, b);
    const T cosine = max(dot(a, b), constant<T>(-1.0 + 1e-9));
    return cosine * v + cross(axis, v) + (dot(axis, v) / (1.0 + cosine)) * axis;
}

} // namespace ringlet::RINGLET_SIMD
