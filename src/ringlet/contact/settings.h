// Constants that decide how contacts act, with their units. Without a unit they are fractions or counts.
#pragma once

namespace ringlet::contact_settings {

// Contact points and barriers
inline constexpr double parallel_sine2 = 0.01;       // sin² of the angle of edges that push at their ends below
inline constexpr double barrier_onset = 0.15;        // of d̂, over which the stiffness of the barrier rises from 0
inline constexpr double d_hat_per_barrier_end = 100; // divides d̂: below that gap the barrier is a parabola

// Friction
inline constexpr double zero_slip = 1e-9; // of the stick length: a smaller slip has no direction

// Initial overlaps
inline constexpr double least_gap = 0.01;          // of d̂: closer pairs can hardly move, and part first
inline constexpr double least_loaded_depth = 0.01; // of d̂: a shallower overlap that carries a load does so no more stiffly

// Stiffness levels of strands
inline constexpr double softest_level = 0.001; // of the largest stiffness, between strands
inline constexpr double firm_level = 0.01;     // where a cloth or a body takes part
inline constexpr double level_factor = 10.0;
inline constexpr double load_half_life = 0.25; // [s]

} // namespace ringlet::contact_settings
