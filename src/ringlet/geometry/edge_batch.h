// Pairs of edges side by side, for kernels that are built for each instruction set.
#pragma once

#include "ringlet/math/simd.h"

namespace ringlet {

struct alignas(64) EdgeBatch {
    static constexpr int room = 8;
    double ends[4][3][room]; // a0 a1, b0 b1; by axis; a pair to a column [m]

    double s[room], t[room]; // where they are closest, as in ClosestOfEdges
    double distance2[room];  // [m²]
};

// Says for which, one to a bit, it is exact.
RINGLET_DECLARE(unsigned find_closest(EdgeBatch &pairs);)

} // namespace ringlet
