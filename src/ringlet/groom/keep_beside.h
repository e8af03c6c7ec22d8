// Collision of hairs with surfaces at render time: each hair stays on its lock's side.
#pragma once

#include "ringlet/geometry/triangle_mesh.h"
#include "ringlet/groom/hairs.h"

#include <cstdint>

namespace ringlet {

// Retracts hairs towards their lock where a surface separates the two. A hair is wider off its lock than the contact distance
// of the lock, so it may pass through a surface that the lock does not.
//
// A point behind a surface moves towards its place on the lock until it is `margin` [m] in front of the surface. The points
// beside it follow, by less and less over 6 mm. The ends of an edge that still pierces the surface move further, if need be
// onto the lock. Then no edge pierces a surface that the lock does not pierce, with two exceptions: points that follow their
// root (`layout.hold`) do not move, and hairs with fewer points cut corners of the lock.
//
// `hairs`: the output of warp_hairs, changed in place. `shares`: if not empty, receives for each point of the hairs that moved
// the fraction of its offset from the lock that is left, 255 for all of it. Returns the number of hairs that moved.
int keep_beside(View<Vec3f> lock_points, View<int> lock_offsets, const HairLayout &layout, const TriangleMesh &surface,
                double margin, std::span<float> hairs, std::span<std::uint8_t> shares = {});

} // namespace ringlet
