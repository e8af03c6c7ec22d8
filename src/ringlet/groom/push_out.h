// Keeps curves out of a body.
#pragma once

#include "ringlet/geometry/frames.h"
#include "ringlet/geometry/triangle_mesh.h"

#include <vector>

namespace ringlet {

// Moves every point that is inside the closed or nearly closed mesh, or nearer than `margin` [m] to it, out along the surface's
// smooth normal. Near the root, which is on the surface, the margin grows from 0 with half the distance along the curve; roots
// stay. The push of each point is shared with its neighbours, so that a curve bends away instead of breaking.
std::vector<Vec3> push_out(const CurveView &curves, const TriangleMesh &body, double margin);

} // namespace ringlet
