#include "ringlet/rest/resolution.h"

#include <cmath>

namespace ringlet {

ResolutionFactors resolution_factors(double angle, double dihedral) {
    // The helix of which a unit edge is a chord: it turns by β about the axis and climbs h at radius R.
    const double C = std::cos(angle / 2), S = std::sin(angle / 2), q = std::cos(dihedral / 2),
                 z = std::abs(std::sin(dihedral / 2));
    const double D = 1 - C * C * q * q;
    const double beta = 2 * std::atan2(std::sqrt(D), C * q);
    if (angle < 1e-3 || angle > 2.4 || beta > 2) return {};
    const double h = C * z / std::sqrt(D);
    const double R = 0.5 * std::sqrt(1 - h * h) / std::sqrt(D);
    const double arc = std::hypot(R * beta, h), cos_pitch = R * beta / arc, sin_pitch = h / arc;

    // Axial compliance by twist, of the chord over that of the arc; by bend, the same, where the coil is steep enough to have
    // any.
    const double root = std::pow(D, 1.5);
    const double by_twist = std::pow(0.5 * C * q * S * S / root, 2) / (arc * R * R * cos_pitch * cos_pitch);
    const double by_bend = sin_pitch > 1e-6 ? std::pow(0.5 * z * S / root, 2) / (arc * R * R * sin_pitch * sin_pitch) : 1.0;
    return {std::pow(1 / arc, 1 - sin_pitch) * std::pow(by_bend, sin_pitch), by_twist, arc};
}

} // namespace ringlet
