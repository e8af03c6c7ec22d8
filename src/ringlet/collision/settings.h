// Constants that decide which pairs collision detection returns.
#pragma once

namespace ringlet::collision {

// Activation distance of two primitives of one object, or of two that cannot yield, as a fraction.
inline constexpr double rest_fraction = 0.9;         // of their distance at rest, at most
inline constexpr double yield_fraction = 0.25;       // of the lengths over which both yield, or else of that distance
inline constexpr double least_d_hat_fraction = 0.01; // of the sum of their radii, at least: else rounding picks a side

// Culling of candidate pairs.
inline constexpr double impact_distance = 0.5; // of d_hat: pairs that keep more have no impact
inline constexpr double impact_reach = 0.6;    // of d_hat: culling for impacts is conservative

} // namespace ringlet::collision
