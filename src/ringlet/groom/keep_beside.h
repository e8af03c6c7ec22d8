// Keeps hairs on the side of surfaces where their lock is.
#pragma once

#include "ringlet/geometry/triangle_mesh.h"
#include "ringlet/groom/hairs.h"

#include <cstdint>

namespace ringlet {

// Hairs are spread wider than what holds their lock off a surface. A point of a hair that the surface parts from its place on
// the lock is drawn towards that place, until it is `margin` [m] short of the surface; the points beside it follow, less and
// less over 6 mm. Where an edge of the hair still goes through, its ends are drawn nearer, down to the lock if need be. So no
// edge goes through that the lock does not go through, but for those that stand on their root (`layout.hold`), which stay,
// and for corners of the lock that hairs of fewer points cut. `hairs`: what warp_hairs wrote. Returns how many it moved.
// `shares`: where there is room for it, gets what part of the way from the lock is left at each point of these, 255 for all.
int keep_beside(View<Vec3f> lock_points, View<int> lock_offsets, const HairLayout &layout, const TriangleMesh &surface,
                double margin, std::span<float> hairs, std::span<std::uint8_t> shares = {});

} // namespace ringlet
