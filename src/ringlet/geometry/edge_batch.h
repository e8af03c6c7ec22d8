// Batch of edge pairs in structure-of-arrays layout, for the distance kernel of each instruction set.
#pragma once

#include "ringlet/math/simd.h"

namespace ringlet {

struct alignas(64) EdgeBatch {
    static constexpr int room = 8;
    double ends[4][3][room]; // positions of a0, a1, b0, b1 by axis; one column per pair [m]

    double s[room], t[room]; // fractions of the closest points, as in ClosestOfEdges
    double distance2[room];  // squared distance [m²]
};

// Fills s, t and distance2. Returns a bit mask of the pairs for which they are exact.
RINGLET_DECLARE(unsigned find_closest(EdgeBatch &pairs);)

} // namespace ringlet
