// Damping of relative motion in the search direction (Levenberg 1944): neighbours move together before they part.
#pragma once

#include "ringlet/contact/pair_force.h"

namespace ringlet {

// It has a Hessian alone, so that it changes no solution.
struct Damping {
    double coefficient = 0.0; // [N/m]

    double energy(const Vec3 &) const { return 0.0; }
    PairValue value(const Vec3 &) const { return {0.0, Vec3::Zero(), coefficient * Mat3::Identity()}; }
};
static_assert(PairForce<Damping>);

} // namespace ringlet
