// Constants that decide how hinges behave, with their units.
#pragma once

#include <numbers>

namespace ringlet::hinge_settings {

inline constexpr double normal_sine = 2.6e-3; // a corner has a normal of its own from this sine on

// Corners that are too straight, or folded, to have a plane
inline constexpr double straight_angle = 0.15 * std::numbers::pi / 180;      // no twist below this angle [rad]
inline constexpr double straight_fade_angle = 0.30 * std::numbers::pi / 180; // full twist from here on (`history`) [rad]
inline constexpr double straight_rest_angle = 0.3 * std::numbers::pi / 180;  // no sign below (`least_energy`) [rad]
inline constexpr double excluded_energy = 1e30;                              // of a sign that may not be chosen [J]

} // namespace ringlet::hinge_settings
