// A tie between vertices of two objects: a spring.
#pragma once

#include "ringlet/contact/pair_force.h"
#include "ringlet/contact/stencil.h"

#include <algorithm>

namespace ringlet {

// ½ k (‖s‖ − L)².
struct Tie {
    Tie(int a, int b, double length_, double stiffness_)
        : at{{a, b, b, b}, {1.0, -1.0, 0.0, 0.0}, 1}, length(length_), stiffness(stiffness_) {}

    Stencil at;
    double length;    // L, at rest [m]
    double stiffness; // k [N/m]

    double energy(const Vec3 &s) const {
        const double stretch = s.norm() - length;
        return 0.5 * stiffness * stretch * stretch;
    }

    // Pressed together, the Hessian across is 0 where the exact one is negative.
    PairValue value(const Vec3 &s) const {
        const double distance = s.norm();
        if (!(distance > 0.0)) return {energy(s), Vec3::Zero(), stiffness * Mat3::Identity()};
        const Vec3 along = s / distance;
        const Mat3 outer = along * along.transpose();
        const double across = std::max(0.0, 1.0 - length / distance);
        return {energy(s), stiffness * (distance - length) * along, stiffness * (outer + across * (Mat3::Identity() - outer))};
    }
};
static_assert(PairForce<Tie>);

} // namespace ringlet
