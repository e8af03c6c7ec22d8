// A pair force: what two primitives do to one another, as an energy of the separation of their closest points. Each law is one,
// in a file of its own.
#pragma once

#include "ringlet/math/types.h"

#include <concepts>

namespace ringlet {

// A potential of one number, with its first and second derivative.
struct Potential {
    double value, first, second;
};

// An energy [J] with its derivatives by the separation s [m].
struct PairValue {
    double energy = 0.0;
    Vec3 gradient = Vec3::Zero(); // force on the second primitive [N]
    Mat3 hessian = Mat3::Zero();  // positive semi-definite, if need be by projection [N/m]

    PairValue &operator+=(const PairValue &other) {
        energy += other.energy, gradient += other.gradient, hessian += other.hessian;
        return *this;
    }
};

// What a law depends on besides s is frozen where contacts are found. What it remembers from step to step has the name of its
// contact.
template <class Law>
concept PairForce = requires(const Law law, const Vec3 s) {
    { law.energy(s) } -> std::same_as<double>;
    { law.value(s) } -> std::same_as<PairValue>;
};

} // namespace ringlet
