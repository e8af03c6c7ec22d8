// Rest shape of strands: the lengths and angles of a polyline at which the elastic energy is zero.
#pragma once

#include "ringlet/math/types.h"

#include <vector>

namespace ringlet {

// One row per vertex of the packed strands; values of an edge are in the row of its first vertex. Unused rows are zero.
struct RestShape {
    std::vector<double> length;   // l̄ of the edge [m]
    std::vector<double> angle;    // θ̄ at the vertex [rad], 0 = straight
    std::vector<double> dihedral; // φ̄ of the edge [rad], in (−π, π]
    std::vector<Vec3> normal;     // of the corner; for a straight corner, parallel transport of a neighbour's
};

RestShape measure_rest_shape(View<int> offsets, View<Vec3> points);

} // namespace ringlet
