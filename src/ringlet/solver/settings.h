// Constants that decide how the solver iterates, with their units. Without a unit they are fractions or counts.
#pragma once

#include "ringlet/dynamics/armijo.h"

namespace ringlet::solver_settings {

// Motion bounds (collision/motion_bounds.h)
inline constexpr double max_bound_length = 0.3; // [m]: longer bounds hold too many pairs
inline constexpr double bound_margin = 0.2;     // of the radius of strands

// Search path
inline constexpr double step_growth = 4.0;   // a step is at most so many times the last one, but where the direction is short
inline constexpr double near_impact = 0.05;  // of the path: what has an impact before takes the straight path
inline constexpr double straight_part = 0.5; // of the direction that it then takes

// Line search: halvings, then quarterings, then 0
inline constexpr RINGLET_SIMD::ArmijoSettings armijo{1e-4, 1e-13};
inline constexpr int halvings = 4, max_cuts = 8;
inline constexpr int max_object_cuts = 12; // then a cluster is cut as a whole

// Lagged normal forces
inline constexpr double closest_gap = 0.05; // of d̂: the largest force that is expected is that at this gap

// Refinement
inline constexpr double full_move = 0.9;      // a move that keeps less of its length was limited
inline constexpr double move_rounding = 1e-9; // of a move
inline constexpr int max_linear_iterations = 2000;

} // namespace ringlet::solver_settings
