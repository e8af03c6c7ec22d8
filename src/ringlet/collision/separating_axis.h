// Separating-axis culling of pairs of edges, many at a time, built for each instruction set.
#pragma once

#include "ringlet/math/simd.h"

namespace ringlet {

// Pairs of edges whose ends are anywhere in boxes. Indices are the end, the first two being those of the first edge, the axis
// and the pair.
struct alignas(64) BoxedEdgePairs {
    static constexpr int room = 16;
    float low[4][3][room], high[4][3][room];
    float reach[room]; // distance below which a pair counts [m]
};

// Pairs of moving edges: the positions of their ends at the start and at the end of the move, and their apexes.
struct alignas(64) MovingEdgePairs {
    static constexpr int room = 16;
    float at[3][4][3][room];
    float reach[room];
};

// Each returns a bit for every pair that is certainly not nearer than its reach; other pairs may or may not be.
// Wherever in their boxes the ends are.
RINGLET_DECLARE(unsigned separated_in_boxes(const BoxedEdgePairs &pairs);)
// Wherever each end is in the triangle of its start, end and apex.
RINGLET_DECLARE(unsigned separated_in_triangles(const MovingEdgePairs &pairs);)
// While all ends move straight from start to end at one time.
RINGLET_DECLARE(unsigned separated_in_motion(const MovingEdgePairs &pairs);)

} // namespace ringlet
