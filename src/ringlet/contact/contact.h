// A contact: a barrier and friction between two primitives, linearised at their closest points.
#pragma once

#include "ringlet/contact/friction.h"
#include "ringlet/contact/settings.h"
#include "ringlet/math/types.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace ringlet {

// With the separation s = c_a − c_b = Σ wᵢ xᵢ of the closest points: gap g = n · s, slip u = (1 − n nᵀ)(s − s₀). The energy
// k b(g) + μ N f(‖u‖) is convex in the positions; the normal force N of friction is lagged.
struct Contact {
    std::array<int, 4> vertex;
    std::array<double, 4> weight; // sum to 1 over the first primitive, to −1 over the second
    int first;                    // vertices of the first primitive: 2 of an edge, 1 of a point
    Vec3 normal;                  // n, from the second primitive to the first
    double d_hat;                 // activation distance [m]
    double barrier_end;           // below this gap the barrier is a parabola [m]
    double loaded_fraction;       // of d̂, over which the contact takes up its load; below 1 for initial overlaps
    double stiffness;             // k [N/m]
    double friction;              // μ
    double stick_length;          // slip below which friction sticks [m]
    Vec3 reference;               // s₀: the separation as the step began, less the slip of the friction state [m]
    double gap = 0.0;             // g where it was linearised [m]
    double force = 0.0;           // normal force there [N]
    double lagged_force = 0.0;    // N [N]
    uint64_t pair = 0;            // name of the pair of primitives, and of the place on it
    double damping = 0.0;         // of relative motion, in the search direction alone [N/m]
    double tied_length = -1.0;    // of a tie: see tie.h [m]; negative of a contact

    bool edge_edge() const { return first == 2; }
    bool is_tie() const { return tied_length >= 0.0; }
};

// Energy of a contact with its derivatives by the separation; the Hessian is positive semi-definite.
struct ContactValue {
    double energy;
    Vec3 gradient;
    Mat3 hessian;
};

inline Vec3 separation(const Contact &c, View<Vec3> positions) {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < 4; ++i) sum += c.weight[i] * positions[c.vertex[i]];
    return sum;
}

inline double normal_force(const Contact &c, const Vec3 &separation) {
    return -c.stiffness * barrier(c.normal.dot(separation), c.d_hat, c.barrier_end).first;
}

inline double barrier_energy(const Contact &c, double gap) { return c.stiffness * barrier(gap, c.d_hat, c.barrier_end).value; }

inline Vec3 slip(const Contact &c, const Vec3 &separation) { // [m]
    const Vec3 moved = separation - c.reference;
    return moved - c.normal.dot(moved) * c.normal;
}

inline double friction_energy(const Contact &c, const Vec3 &separation) {
    if (!(c.friction > 0.0 && c.lagged_force > 0.0)) return 0.0;
    return c.friction * c.lagged_force * friction_potential(slip(c, separation).norm(), c.stick_length).value;
}

inline double tie_energy(const Contact &c, const Vec3 &separation) {
    const double stretch = separation.norm() - c.tied_length;
    return 0.5 * c.stiffness * stretch * stretch;
}

// The energy of a known contact without its barrier.
inline double kept_energy(const Contact &c, const Vec3 &separation) {
    return c.is_tie() ? tie_energy(c, separation) : friction_energy(c, separation);
}

inline double contact_energy(const Contact &c, const Vec3 &separation) {
    return kept_energy(c, separation) + (c.is_tie() ? 0.0 : barrier_energy(c, c.normal.dot(separation)));
}

// Across a tie that is pressed together the Hessian is 0 where the exact one is negative.
inline ContactValue tie_value(const Contact &c, const Vec3 &separation) {
    const double length = separation.norm();
    if (!(length > 0.0)) return {tie_energy(c, separation), Vec3::Zero(), c.stiffness * Mat3::Identity()};
    const Vec3 along = separation / length;
    const Mat3 outer = along * along.transpose();
    const double across = std::max(0.0, 1.0 - c.tied_length / length);
    return {tie_energy(c, separation), c.stiffness * (length - c.tied_length) * along,
            c.stiffness * (outer + across * (Mat3::Identity() - outer))};
}

inline ContactValue contact_value(const Contact &c, const Vec3 &separation) {
    if (c.is_tie()) return tie_value(c, separation);
    const Potential push = barrier(c.normal.dot(separation), c.d_hat, c.barrier_end);
    ContactValue value{c.stiffness * push.value, c.stiffness * push.first * c.normal,
                       c.stiffness * push.second * c.normal * c.normal.transpose()};
    if (!(c.friction > 0.0 && c.lagged_force > 0.0)) return value;
    const Vec3 u = slip(c, separation);
    const double length = u.norm(), limit = c.friction * c.lagged_force;
    const Potential rub = friction_potential(length, c.stick_length);
    value.energy += limit * rub.value;
    const Mat3 plane = Mat3::Identity() - c.normal * c.normal.transpose();
    if (length < contact_settings::zero_slip * c.stick_length) {
        value.hessian += (4.0 * limit / c.stick_length) * plane; // f'/y → 4 / stick length
        return value;
    }
    const Vec3 along = u / length;
    value.gradient += limit * rub.first * along;
    value.hessian +=
        limit * (rub.first / length * (plane - along * along.transpose()) + rub.second * along * along.transpose());
    return value;
}

} // namespace ringlet
