// Constants that decide how strands behave, with their units.
#pragma once

#include <numbers>

namespace ringlet::strand_settings {

// Line search
inline constexpr double max_edge_change = 2.0; // largest change of an edge vector in a Newton step, by its length
inline constexpr double min_edge_ratio = 0.1;  // smallest length of an edge along a curved path, by that at its start
inline constexpr double zero_length = 1e-300;  // shorter vectors have no direction [m]
inline constexpr double shortest_edge = 1e-6;  // shorter edges count as this long, by their rest length
inline constexpr double curved_angle = 0.06; // from corners of that angle at rest on an edge rotates with all of its spin [rad]
inline constexpr double rotation_sine = 1e-6; // three held vertices define a rotation from this sine of their angle on

// In a scene
inline constexpr double contact_stretch = 0.1;  // of the stretch stiffness, in that against contacts
inline constexpr double refined_strain = 0.03;  // of an edge: limited strands that are stretched further get more iterations
inline constexpr double settled_fraction = 0.2; // of the mean edge: a move that short has settled

// Material frames
inline constexpr double frame_stiffness = 1e-8;      // regularises a free frame, by its bend stiffness over l̄²
inline constexpr double frame_stiffness_min = 1e-15; // and at least by this much [N/m]
inline constexpr int frame_iterations = 100;         // Newton iterations that relax the frames of strands at rest, at most
inline constexpr double frame_tolerance = 1e-14;     // of that relaxation [m]
inline constexpr double bent_angle = 1e-6;           // the first director is the corner's normal from this angle on [rad]

} // namespace ringlet::strand_settings
