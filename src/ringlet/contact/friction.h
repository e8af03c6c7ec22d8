// Coulomb friction as a potential of the slip, smooth around zero (after Li et al. 2020).
#pragma once

#include "ringlet/contact/barrier.h"

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

} // namespace ringlet
