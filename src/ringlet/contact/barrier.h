// The contact barrier: a potential of the gap, C¹ at the activation distance and C² below it.
#pragma once

#include <algorithm>
#include <cmath>

namespace ringlet {

// A potential with its first and second derivative.
struct Potential {
    double value, first, second;
};

// Two-stage barrier at a gap g with activation distance d̂ (Chen et al. 2025), with an end:
//   ½ (d̂ − g)²                         d̂/2 ≤ g < d̂
//   −(d̂²/4) (ln(2g/d̂) − ½)             end ≤ g < d̂/2     logarithmic: its force grows as 1/g, its stiffness as 1/g²
//   the parabola that continues it     g < end           bounded, for a direction that leads beyond
inline Potential barrier(double g, double d_hat, double end) {
    if (g >= d_hat) return {0.0, 0.0, 0.0};
    if (g >= 0.5 * d_hat) return {0.5 * (d_hat - g) * (d_hat - g), g - d_hat, 1.0};
    const double s = 0.25 * d_hat * d_hat, d = std::max(g, std::min(end, 0.5 * d_hat));
    const double value = -s * (std::log(2.0 * d / d_hat) - 0.5), first = -s / d, second = s / (d * d);
    const double below = g - d;
    return {value + first * below + 0.5 * second * below * below, first + second * below, second};
}

// The activation distance with which the barrier, per stiffness, pushes with force f at gap g: −b'(g) = f [m].
inline double activation_distance(double f, double g) { return f <= g ? g + f : 2.0 * std::sqrt(f * g); }

} // namespace ringlet
