// Orientation of surfaces: which triangles face the inside of what they enclose.
#pragma once

#include "ringlet/geometry/triangle_mesh.h"

#include <vector>

namespace ringlet {

// A connected surface has two consistent orientations, and outwards is the one in which it encloses a positive volume. Both are
// found as the connected parts of its double cover: each triangle, as it is wound and turned over, is joined to its neighbours
// as they agree with it. Points at one place are one, as along seams. Openings are closed by fans. An open sheet and a Möbius
// strip have no inside.
//
// For each triangle the number of the part that it belongs to as it is wound, or −1 where that does not face the inside of a
// closed surface, or of one with small openings.
std::vector<int> parts_facing_inside(const TriangleMesh &mesh);

} // namespace ringlet
