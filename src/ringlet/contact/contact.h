// One contact: two primitives that are near one another, linearised.
#pragma once

#include "ringlet/contact/potential.h"
#include "ringlet/math/types.h"

#include <array>
#include <cstdint>

namespace ringlet {

// With c_a − c_b = Σ wᵢ xᵢ between the points that touch: gap g = n · (c_a − c_b), slid distance u = (1 − n nᵀ) of what c_a −
// c_b changed by in the step. Energy k φ(g) + μ N ψ(‖u‖), N being what the contact is expected to bear (lagged):
// convex in the positions.
struct Contact {
    std::array<int, 4> vertex;
    std::array<double, 4> weight; // those of the first primitive sum to 1, of the second to −1
    int first;                    // vertices of the first primitive: 2 of an edge, 1 of a point
    Vec3 normal;                  // n, from the second to the first
    double distance;              // r: the contact is active below this gap [m]
    double barrier_end;           // below this gap the barrier ends in a parabola [m]
    double stiffness;             // k [N/m]
    double friction;              // μ
    double creep;                 // a contact that slid less in the step counts as sticking [m]
    Vec3 start;                   // c_a − c_b as the step began [m]
    double force = 0.0;           // with which it pushes where it was linearised [N]
    double grip = 0.0;            // N [N]
    uint64_t pair = 0;            // which two touch

    bool of_edges() const { return first == 2; }
};

struct ContactValue {
    double energy;
    Vec3 gradient; // by c_a − c_b
    Mat3 hessian;  // likewise, positive semi-definite
};

inline Vec3 separation(const Contact &c, View<Vec3> positions) {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < 4; ++i) sum += c.weight[i] * positions[c.vertex[i]];
    return sum;
}

// Force [N] with which the contact pushes at a separation c_a − c_b.
inline double contact_force(const Contact &c, const Vec3 &separation) {
    return -c.stiffness * contact_potential(c.normal.dot(separation), c.distance, c.barrier_end).first;
}

inline double push_energy(const Contact &c, const Vec3 &separation) {
    return c.stiffness * contact_potential(c.normal.dot(separation), c.distance, c.barrier_end).value;
}

inline double friction_energy(const Contact &c, const Vec3 &separation) {
    if (!(c.friction > 0.0 && c.grip > 0.0)) return 0.0;
    const Vec3 moved = separation - c.start, slid = moved - c.normal.dot(moved) * c.normal;
    return c.friction * c.grip * friction_potential(slid.norm(), c.creep).value;
}

inline double contact_energy(const Contact &c, const Vec3 &separation) {
    return push_energy(c, separation) + friction_energy(c, separation);
}

inline ContactValue contact_value(const Contact &c, const Vec3 &separation) {
    const Potential push = contact_potential(c.normal.dot(separation), c.distance, c.barrier_end);
    ContactValue value{c.stiffness * push.value, c.stiffness * push.first * c.normal,
                       c.stiffness * push.second * c.normal * c.normal.transpose()};
    if (!(c.friction > 0.0 && c.grip > 0.0)) return value;
    const Vec3 moved = separation - c.start, slid = moved - c.normal.dot(moved) * c.normal;
    const double length = slid.norm(), most = c.friction * c.grip;
    const Potential rub = friction_potential(length, c.creep);
    value.energy += most * rub.value;
    const Mat3 plane = Mat3::Identity() - c.normal * c.normal.transpose();
    if (length < 1e-9 * c.creep) {
        value.hessian += (4.0 * most / c.creep) * plane; // ψ'/y → 4/creep
        return value;
    }
    const Vec3 way = slid / length;
    value.gradient += most * rub.first * way;
    value.hessian += most * (rub.first / length * (plane - way * way.transpose()) + rub.second * way * way.transpose());
    return value;
}

} // namespace ringlet
