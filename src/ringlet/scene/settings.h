// Constants that decide how a scene steps, with their units. Without a unit they are counts.
#pragma once

namespace ringlet::scene_settings {

// Advection
inline constexpr int max_patches = 96;          // rigid patches of all bodies
inline constexpr int vertices_of_patch = 16;    // at least, to determine a rotation
inline constexpr double same_place2 = 1e-20;    // [m²]: vertices that follow a rigid motion end no farther from it
inline constexpr int motion_samples = 1000;     // vertices that determine the motion of most
inline constexpr double affine = 1e-3;          // deviation from an affine motion, of a body's extent
inline constexpr double thin2 = 1e-12;          // square of the thickness at which a body is flat, of its length
inline constexpr double dent_deviation = 0.2;   // of its surface from a body's own motion, relative to that of most
inline constexpr double least_part = 1.0 / 16;  // of their motions that bodies try to make at once
inline constexpr double guess_rounding = 1e-12; // [m]: a guess that moves a vertex less leaves it where it is

// Initial penetration and overlaps
inline constexpr double coincident = 1e-6;      // of the activation distance: nearer, a pair has no direction
inline constexpr double recovery_speed = 0.02;  // of vertices out of a body [m/s]
inline constexpr double recovered_height = 0.9; // of the contact distance
inline constexpr double separate_height = 0.5;  // of the contact distance, kept by the edges of a recovered vertex
inline constexpr int height_samples = 8;        // of an edge
inline constexpr double parting_speed = 1e-4;   // of overlaps that stay, out of a hundredth of their distance [m/s]

} // namespace ringlet::scene_settings
