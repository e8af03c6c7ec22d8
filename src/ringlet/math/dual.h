// Dual number (forward-mode automatic differentiation): a value with its derivatives by up to eight variables.
// A formula that is a template of its number type gives its derivatives when T is Dual.
#pragma once

#include "ringlet/math/pack.h"

namespace ringlet::RINGLET_SIMD {

struct Dual {
    static constexpr int variables = 8;
    typedef double Derivatives __attribute__((vector_size(variables * sizeof(double))));

    double value;
    Derivatives by; // derivative by each variable
};

template <> struct Traits<Dual> {
    using Mask = bool;
    static constexpr int lanes = 1;
};

// A constant, whose derivatives are zero.
inline Dual dual_constant(double value) { return {value, Dual::Derivatives{}}; }

// The variable of this index, whose derivative by itself is 1.
inline Dual dual_variable(double value, int index) {
    Dual x = dual_constant(value);
    x.by[index] = 1.0;
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
inline Dual operator/(double a, Dual b) { return dual_constant(a) / b; }

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
