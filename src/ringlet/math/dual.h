// Dual numbers: a value with its derivatives by some unknowns, so that a formula that is written for any T gives its derivative
// too. Forward mode; the derivatives stand side by side in one vector.
#pragma once

#include "ringlet/math/pack.h"

namespace ringlet::RINGLET_SIMD {

struct Dual {
    static constexpr int unknowns = 8;
    typedef double Derivatives __attribute__((vector_size(unknowns * sizeof(double))));

    double value;
    Derivatives by;
};

template <> struct Traits<Dual> {
    using Mask = bool;
    static constexpr int lanes = 1;
};

// A number that depends on nothing, and the unknown of some number.
inline Dual known(double value) { return {value, Dual::Derivatives{}}; }
inline Dual unknown(double value, int number) {
    Dual x = known(value);
    x.by[number] = 1.0;
    return x;
}

inline Dual operator-(Dual a) { return {-a.value, -a.by}; }
inline Dual operator+(Dual a, Dual b) { return {a.value + b.value, a.by + b.by}; }
inline Dual operator-(Dual a, Dual b) { return {a.value - b.value, a.by - b.by}; }
inline Dual operator*(Dual a, Dual b) { return {a.value * b.value, a.value * b.by + b.value * a.by}; }
inline Dual operator/(Dual a, Dual b) {
    const double ratio = a.value / b.value;
    return {ratio, (a.by - ratio * b.by) / b.value};
}
inline Dual &operator+=(Dual &a, Dual b) { return a = a + b; }

inline Dual operator+(Dual a, double b) { return {a.value + b, a.by}; }
inline Dual operator-(Dual a, double b) { return {a.value - b, a.by}; }
inline Dual operator+(double a, Dual b) { return b + a; }
inline Dual operator-(double a, Dual b) { return {a - b.value, -b.by}; }
inline Dual operator*(double a, Dual b) { return {a * b.value, a * b.by}; }
inline Dual operator/(double a, Dual b) { return known(a) / b; }

inline bool operator<(Dual a, Dual b) { return a.value < b.value; }
inline bool operator>(Dual a, Dual b) { return a.value > b.value; }
inline bool operator<(Dual a, double b) { return a.value < b; }

inline Dual select(bool mask, Dual a, Dual b) { return mask ? a : b; }
inline Dual sqrt(Dual x) {
    const double root = __builtin_sqrt(x.value);
    return {root, root > 0.0 ? x.by / (2.0 * root) : Dual::Derivatives{}};
}
inline Dual atan2(Dual y, Dual x) {
    const double size = x.value * x.value + y.value * y.value;
    return {atan2(y.value, x.value), size > 0.0 ? (x.value * y.by - y.value * x.by) / size : Dual::Derivatives{}};
}

} // namespace ringlet::RINGLET_SIMD
