#include "ringlet/rest/resolution.h"

#include <cmath>

namespace ringlet {

ResolutionFactors resolution_factors(double angle, double dihedral) {
    // Helix with a unit edge as its chord: rotation β about the axis, rise h, radius R.
    const double C = std::cos(angle / 2), S = std::sin(angle / 2), q = std::cos(dihedral / 2),
                 z = std::abs(std::sin(dihedral / 2));
    const double D = 1 - C * C * q * q;
    const double beta = 2 * std::atan2(std::sqrt(D), C * q);
    if (angle < 1e-3 || angle > 2.4 || beta > 2) return {};
    const double h = C * z / std::sqrt(D);
    const double R = 0.5 * std::sqrt(1 - h * h) / std::sqrt(D);
    const double arc = std::hypot(R * beta, h), cos_pitch = R * beta / arc, sin_pitch = h / arc;

    // Ratios of the axial compliance of the chord to that of the arc: by twist, and by bend if the coil is steep enough.
    const double root = std::pow(D, 1.5);
    const double by_twist = std::pow(0.5 * C * q * S * S / root, 2) / (arc * R * R * cos_pitch * cos_pitch);
    const double by_bend = sin_pitch > 1e-6 ? std::pow(0.5 * z * S / root, 2) / (arc * R * R * sin_pitch * sin_pitch) : 1.0;
    return {std::pow(1 / arc, 1 - sin_pitch) * std::pow(by_bend, sin_pitch), by_twist, arc};
}

} // namespace ringlet
