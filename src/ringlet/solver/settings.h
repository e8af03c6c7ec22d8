// Constants that decide how the solver iterates, with their units. Without a unit they are fractions or counts.
#pragma once

#include "ringlet/dynamics/armijo.h"

#include <utility>

namespace ringlet::solver_settings {

// Motion bounds (collision/motion_bounds.h)
inline constexpr double max_bound_length = 0.3; // [m]: longer bounds hold too many pairs
inline constexpr double bound_margin = 0.2;     // of the radius of strands

// Damping of relative motion (Levenberg 1944), as a part of the stiffness of contacts: it comes to nothing, so that the
// solution is that of the objective
inline constexpr double first_damping = 0.2;
inline constexpr double damping_decay = 0.35;
inline constexpr double least_damping = 1e-3;

// Search path
inline constexpr double near_impact = 0.05;  // of the path: what has an impact before takes the straight path
inline constexpr double straight_part = 0.5; // of the direction that it then takes

// Line search: halvings, then quarterings, then 0
inline constexpr RINGLET_SIMD::ArmijoSettings armijo{1e-4, 1e-13};
inline constexpr int halvings = 4, max_cuts = 8;
inline constexpr int max_object_cuts = 12; // then a cluster is cut as a whole

// Lagged normal forces
inline constexpr double closest_gap = 0.05; // of d̂: the largest force that is expected is that at this gap

// Coarse space: smaller clusters have little joint motion and are solved as fast without; in a cluster whose objects touch more
// than so many others on average, so many of them share their columns
inline constexpr std::pair<double, size_t> aggregate_sizes[] = {{5.0, 4}, {12.0, 16}};
inline constexpr size_t least_cluster = 4;       // objects
inline constexpr double coarse_rounding = 1e-10; // of the largest diagonal entry of a block of E

// Conjugate gradients
inline constexpr int error_delay = 2;           // iterations by which the estimate of the error comes late
inline constexpr double residual_share = 0.25;  // of the tolerance: what is left of a residual, where that decides
inline constexpr double loose_tolerance = 0.05; // from there on, small clusters get at most
inline constexpr int max_loose_iterations = 8;

// Refinement
inline constexpr int refined_rings = 3;       // of objects that touch one another, about one that is stretched
inline constexpr double full_move = 0.9;      // a move that keeps less of its length was limited
inline constexpr double move_rounding = 1e-9; // of a move
inline constexpr int max_linear_iterations = 2000;

} // namespace ringlet::solver_settings
