// The impacts of many pairs at once.
#pragma once

#include "ringlet/contact/broad_phase.h"

namespace ringlet {

// For each candidate, edges first, the time until which its distance stays above `fraction` of that at the start, or
// `no_impact` (impact.h), on the straight paths from `start` to `end`: positions [m] of all vertices.
void impacts(const CollisionMesh &mesh, View<Vec3> start, View<Vec3> end, const Candidates &candidates, double fraction,
             std::vector<double> &times);

} // namespace ringlet
