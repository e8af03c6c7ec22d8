// One contact: two primitives that are near one another, linearised.
#pragma once

#include "ringlet/contact/potential.h"
#include "ringlet/math/types.h"

#include <array>
#include <cstdint>

namespace ringlet {

// With c_a − c_b = Σ wᵢ xᵢ between the points that touch: gap g = n · (c_a − c_b), shear u = (1 − n nᵀ) of what c_a − c_b
// changed by in the step, and the shear that was there before. Energy k φ(g) + μ N ψ(‖u‖), N being what the contact is
// expected to bear (lagged): convex in the positions.
struct Contact {
    std::array<int, 4> vertex;
    std::array<double, 4> weight; // those of the first primitive sum to 1, of the second to −1
    int first;                    // vertices of the first primitive: 2 of an edge, 1 of a point
    Vec3 normal;                  // n, from the second to the first
    double distance;              // r: the contact is active below this gap [m]
    double barrier_end;           // below this gap the barrier ends in a parabola [m]
    double room;                  // the part of its distance in which it comes to bear: 1, less where the pair began nearer
    double stiffness;             // k [N/m]
    double friction;              // μ
    double give;                  // a contact that is sheared less than this sticks [m]
    Vec3 start;                   // c_a − c_b as the step began, less the shear that was there [m]
    double gap = 0.0;             // where it was linearised [m]
    double force = 0.0;           // with which it pushes there [N]
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

// The same where it was linearised.
inline double push_energy_where_found(const Contact &c) {
    return c.stiffness * contact_potential(c.gap, c.distance, c.barrier_end).value;
}

// The same as a Newton step has it: expanded to second order where it was linearised.
inline double expanded_push_energy(const Contact &c, const Vec3 &separation) {
    const Potential push = contact_potential(c.gap, c.distance, c.barrier_end);
    const double nearer = c.normal.dot(separation) - c.gap;
    return c.stiffness * (push.value + nearer * (push.first + 0.5 * nearer * push.second));
}

// u, how far the two are sheared at a separation c_a − c_b [m].
inline Vec3 shear(const Contact &c, const Vec3 &separation) {
    const Vec3 moved = separation - c.start;
    return moved - c.normal.dot(moved) * c.normal;
}

inline double friction_energy(const Contact &c, const Vec3 &separation) {
    if (!(c.friction > 0.0 && c.grip > 0.0)) return 0.0;
    return c.friction * c.grip * friction_potential(shear(c, separation).norm(), c.give).value;
}

inline double contact_energy(const Contact &c, const Vec3 &separation) {
    return push_energy(c, separation) + friction_energy(c, separation);
}

inline ContactValue contact_value(const Contact &c, const Vec3 &separation) {
    const Potential push = contact_potential(c.normal.dot(separation), c.distance, c.barrier_end);
    ContactValue value{c.stiffness * push.value, c.stiffness * push.first * c.normal,
                       c.stiffness * push.second * c.normal * c.normal.transpose()};
    if (!(c.friction > 0.0 && c.grip > 0.0)) return value;
    const Vec3 sheared = shear(c, separation);
    const double length = sheared.norm(), most = c.friction * c.grip;
    const Potential rub = friction_potential(length, c.give);
    value.energy += most * rub.value;
    const Mat3 plane = Mat3::Identity() - c.normal * c.normal.transpose();
    if (length < 1e-9 * c.give) {
        value.hessian += (4.0 * most / c.give) * plane; // ψ'/y → 4/give
        return value;
    }
    const Vec3 way = sheared / length;
    value.gradient += most * rub.first * way;
    value.hessian += most * (rub.first / length * (plane - way * way.transpose()) + rub.second * way * way.transpose());
    return value;
}

} // namespace ringlet
