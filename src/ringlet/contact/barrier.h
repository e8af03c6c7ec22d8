// The contact barrier: a potential of the gap, C² down to its end, that pushes along the normal.
#pragma once

#include "ringlet/contact/pair_force.h"
#include "ringlet/contact/settings.h"

#include <algorithm>
#include <cmath>

namespace ringlet {

// Two-stage barrier at a gap g with activation distance r (Chen et al. 2025), with an end:
//   ½ (r − g)²                        r/2 ≤ g < r
//   −(r²/4) (ln(2g/r) − ½)            end ≤ g < r/2     logarithmic: its force grows as 1/g, its stiffness as 1/g²
//   the parabola that continues it    g < end           bounded, for a direction that leads beyond
inline Potential two_stage_barrier(double g, double r, double end) {
    if (g >= r) return {0.0, 0.0, 0.0};
    if (g >= 0.5 * r) return {0.5 * (r - g) * (r - g), g - r, 1.0};
    const double s = 0.25 * r * r, d = std::max(g, std::min(end, 0.5 * r));
    const double value = -s * (std::log(2.0 * d / r) - 0.5), first = -s / d, second = s / (d * d);
    const double below = g - d;
    return {value + first * below + 0.5 * second * below * below, first + second * below, second};
}

// The two-stage barrier with r = d̂ − a/2 and an onset: (d̂ − g)³ / 6a for d̂ − a ≤ g < d̂, where a is a fraction of d̂. Where the
// stiffness jumps from 0 to 1, contacts that are to open hold on to each other for an iteration of Newton's method each.
inline Potential barrier(double g, double d_hat, double end) {
    const double a = contact_settings::barrier_onset * d_hat, depth = d_hat - g;
    if (depth <= 0.0) return {0.0, 0.0, 0.0};
    if (depth < a) return {depth * depth * depth / (6.0 * a), -0.5 * depth * depth / a, depth / a};
    const Potential below = two_stage_barrier(g, d_hat - 0.5 * a, end);
    return {below.value + a * a / 24.0, below.first, below.second};
}

// The activation distance with which the barrier, per stiffness, pushes with force f at gap g: −b'(g) = f [m].
inline double activation_distance(double f, double g) {
    constexpr double a = contact_settings::barrier_onset, r = 1.0 - 0.5 * a;
    const double d_hat = (f <= g ? g + f : 2.0 * std::sqrt(f * g)) / r;
    return g <= (1.0 - a) * d_hat ? d_hat : g + a * f + std::sqrt(a * f * (2.0 * g + a * f));
}

// k b(n · s).
struct Barrier {
    Vec3 normal;       // n, from the second primitive to the first
    double stiffness;  // k [N/m]
    double d_hat, end; // activation distance; gap below which it is a parabola [m]

    Potential at(double gap) const { return barrier(gap, d_hat, end); }
    double force(double gap) const { return -stiffness * at(gap).first; } // [N]
    double energy_at(double gap) const { return stiffness * at(gap).value; }

    double energy(const Vec3 &s) const { return energy_at(normal.dot(s)); }
    PairValue value(const Vec3 &s) const {
        const Potential push = at(normal.dot(s));
        return {stiffness * push.value, stiffness * push.first * normal, stiffness * push.second * normal * normal.transpose()};
    }
};
static_assert(PairForce<Barrier>);

} // namespace ringlet
