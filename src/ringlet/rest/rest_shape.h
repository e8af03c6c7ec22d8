// The strains of a polyline: what a strand at rest in that shape remembers.
#pragma once

#include "ringlet/math/types.h"

#include <vector>

namespace ringlet {

// One row per vertex of the packed strands; an edge's values stand where the edge begins. Rows without meaning are zero.
struct RestShape {
    std::vector<double> length;   // l̄ of the edge [m]
    std::vector<double> angle;    // θ̄ at the vertex [rad], 0 = straight
    std::vector<double> dihedral; // φ̄ of the edge [rad], in (−π, π]
    std::vector<Vec3> normal;     // of the corner; where it is straight, that of a neighbour carried along
};

RestShape measure_rest_shape(View<int> offsets, View<Vec3> points);

} // namespace ringlet
