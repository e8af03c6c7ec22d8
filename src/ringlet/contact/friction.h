// Coulomb friction as a potential of the slip, smooth around zero (after Li et al. 2020).
#pragma once

#include "ringlet/contact/pair_force.h"
#include "ringlet/contact/settings.h"

#include <algorithm>
#include <cmath>

namespace ringlet {

// Per friction force μN, at slip y ≥ 0: the force rises smoothly to 1 at the stick length and stays there. It rises more
// steeply than IPC's quadratic: up to 0.9 of the largest force, the slip stays below half of that share of the stick length.
inline Potential friction_potential(double y, double stick_length) {
    if (y >= stick_length) return {y, 1.0, 0.0};
    const double q = y / stick_length, left = 1.0 - q, left3 = left * left * left;
    return {stick_length * (q + left3 * left * left / 5.0), 1.0 - left3 * left, 4.0 * left3 / stick_length};
}

// The slip, per stick length, at which friction holds with that fraction of its largest force: inverts the force above.
inline double slip_to_hold(double fraction) { return 1.0 - std::pow(std::max(1.0 - fraction, 0.0), 0.25); }

// μ N f(‖u‖) of the slip u = (1 − n nᵀ)(s − s₀). The normal force N is lagged.
struct Friction {
    Vec3 normal;               // n
    double coefficient;        // μ
    double stick_length;       // slip below which it sticks [m]
    Vec3 reference;            // s₀: the separation as the step began, less the slip that is remembered [m]
    double normal_force = 0.0; // N [N]

    double largest() const { return coefficient * normal_force; } // force [N]
    bool acts() const { return largest() > 0.0; }

    Vec3 slip(const Vec3 &s) const { // [m]
        const Vec3 moved = s - reference;
        return moved - normal.dot(moved) * normal;
    }

    // What the next step begins with, up to the stick length: what has slipped farther has slid.
    Vec3 kept_slip(const Vec3 &s) const {
        const Vec3 u = slip(s);
        const double length = u.norm();
        return length > stick_length ? Vec3(stick_length / length * u) : u;
    }

    // The slip at which it holds a force in its plane, at that normal force [N].
    Vec3 slip_that_holds(const Vec3 &force, double at_normal_force) const {
        const double limit = coefficient * at_normal_force, length = force.norm();
        if (!(limit > 0.0 && length > 0.0)) return Vec3::Zero();
        return -slip_to_hold(std::min(length / limit, 1.0)) * stick_length / length * force;
    }

    double energy(const Vec3 &s) const {
        return acts() ? largest() * friction_potential(slip(s).norm(), stick_length).value : 0.0;
    }

    PairValue value(const Vec3 &s) const {
        if (!acts()) return {};
        const Vec3 u = slip(s);
        const double length = u.norm();
        const Potential rub = friction_potential(length, stick_length);
        const Mat3 plane = Mat3::Identity() - normal * normal.transpose();
        if (length < contact_settings::zero_slip * stick_length) // f'/y → 4 / stick length
            return {largest() * rub.value, Vec3::Zero(), (4.0 * largest() / stick_length) * plane};
        const Vec3 along = u / length;
        const Mat3 outer = along * along.transpose();
        return {largest() * rub.value, largest() * rub.first * along,
                largest() * (rub.first / length * (plane - outer) + rub.second * outer)};
    }
};
static_assert(PairForce<Friction>);

} // namespace ringlet
