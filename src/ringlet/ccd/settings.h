// Constants that decide what continuous collision detection returns. Without a unit they are fractions or counts.
#pragma once

#include "ringlet/collision/mesh.h"

#include <algorithm>

namespace ringlet::ccd {

// Additive conservative advancement (time_of_impact.h), as fractions of gap − minimum separation. A head-on approach stops
// after two advancements: were what they leave the limit itself, rounding would decide whether there is a third.
inline constexpr double advancement_rest = 0.09; // left by one advancement
inline constexpr double convergence = 0.01;      // where it stops, of the value at the start
inline constexpr double zero_distance = 1e-100;  // [m]; below it a pair has no separating direction
inline constexpr int max_advancements = 200;     // per pair

// Minimum separation: the lesser of the first two, but at least the third, and in any case at most the fourth.
inline constexpr double separation_of_d_hat = collision::impact_distance; // of the activation distance
inline constexpr double separation_of_gap = 0.2;                          // of the gap at the start
inline constexpr double d_hat_per_separation = 250;                       // divides the activation distance
inline constexpr double separation_limit = 0.9;                           // of the gap at the start

// Both resolution loops.
inline constexpr double max_strain = 0.05;         // that spreading a correction puts into an edge
inline constexpr double before_first_impact = 0.9; // of the first time of impact, where a whole move is truncated

// limit_move
inline constexpr double before_impact = 0.98; // of the time at which an object meets one that goes less far
inline constexpr int whole_rounds = 8;        // then whole objects with impacts rest
inline constexpr int local_rounds = 2;        // in which whole objects that could hardly move are corrected locally
inline constexpr int spread_rounds = 16;      // in which local corrections are spread; then all of an object takes them
inline constexpr int spare_rounds = 16;       // beyond one for each object
inline constexpr double hardly_moves = 0.2;   // a whole object that keeps no more of its motion is corrected locally

// resolve_impact_zones
inline constexpr int zone_rounds = 6;
inline constexpr int own_motion_rounds = 3; // in which zones keep their own motion up to the impact

// truncate_locally
inline constexpr int partial_rounds = 4; // in which vertices go up to 0.9 of their impacts; then they stay
inline constexpr int vertex_rounds = 24; // then whole objects stay
inline constexpr int object_rounds = 32; // then bodies stay

// Least distance [m] that a pair keeps on a move which it begins at a distance of `gap`.
inline double min_separation(double d_hat, double gap) {
    return std::min(
        {separation_of_d_hat * d_hat, std::max(separation_of_gap * gap, d_hat / d_hat_per_separation), separation_limit * gap});
}

} // namespace ringlet::ccd
