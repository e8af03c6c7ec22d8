// Constants of the bounding volume hierarchy.
#pragma once

namespace ringlet::bvh_settings {

inline constexpr double rebuild_growth = 1.4;          // of the leaf boxes since the last build
inline constexpr int serial_nodes = 1 << 10;           // fewer are refitted by one thread
inline constexpr int traversal_tasks = 256;            // at least, where there are as many: the same for any number of threads
inline constexpr float time_rounding = 1e-6f;          // of the duration of a move
inline constexpr float coordinate_rounding = 0x1p-20f; // of the largest coordinate, in single precision

} // namespace ringlet::bvh_settings
