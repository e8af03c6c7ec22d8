// What a contact costs by its gap, and friction by how far it slid.
#pragma once

#include <algorithm>
#include <cmath>

namespace ringlet {

// A value and its first and second derivative.
struct Potential {
    double value, first, second;
};

// Contact at gap g, active below r (two-stage activation, Chen et al. 2025, with an end):
//   ½ (r − g)²                        r/2 ≤ g < r
//   −(r²/4) (ln(2g/r) − ½)            end ≤ g < r/2     a barrier: its force grows as 1/g, its stiffness as 1/g²
//   the parabola that touches it      g < end, also where g < 0: gaps are those of planes that may be overstepped for now
// Convex and C² everywhere but at r, where it is C¹.
inline Potential contact_potential(double g, double r, double end) {
    if (g >= r) return {0.0, 0.0, 0.0};
    if (g >= 0.5 * r) return {0.5 * (r - g) * (r - g), g - r, 1.0};
    const double s = 0.25 * r * r, d = std::max(g, std::min(end, 0.5 * r));
    const double value = -s * (std::log(2.0 * d / r) - 0.5), first = -s / d, second = s / (d * d);
    const double below = g - d;
    return {value + first * below + 0.5 * second * below * below, first + second * below, second};
}

// The r from which on it pushes with that force per stiffness f at gap g: −φ' = f [m].
inline double distance_to_bear(double f, double g) { return f <= g ? g + f : 2.0 * std::sqrt(f * g); }

// Friction per force μN of a contact that is sheared by a distance y ≥ 0: |force| rises smoothly to 1 at y = give and stays
// there (after Li et al. 2020, steeper at the start: what holds gives way by less than half of its part of the most, times
// `give`, up to 0.9 of it). `first` is that force, `second` its slope.
inline Potential friction_potential(double y, double give) {
    if (y >= give) return {y, 1.0, 0.0};
    const double q = y / give, left = 1.0 - q, left3 = left * left * left;
    return {give * (q + left3 * left * left / 5.0), 1.0 - left3 * left, 4.0 * left3 / give};
}

// How far a contact is sheared that holds with that part of its most force, in parts of `give`.
inline double sheared_to_hold(double part) { return 1.0 - std::pow(std::max(1.0 - part, 0.0), 0.25); }

} // namespace ringlet
