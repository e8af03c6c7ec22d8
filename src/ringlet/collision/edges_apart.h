// Pairs of edges of which it is quickly told that they never touch, many at a time, built for each instruction set.
#pragma once

#include "ringlet/math/simd.h"

namespace ringlet {

// Pairs of edges whose ends may be anywhere in boxes: by end, the first two being those of the first edge, axis and pair.
struct alignas(64) EdgePairs {
    static constexpr int room = 16;
    float low[4][3][room], high[4][3][room];
    float reach[room]; // at which a pair touches
};

// Pairs of edges on their ways: where their ends are at the start, where at the end, and where else they may be told to go.
struct alignas(64) EdgeWays {
    static constexpr int room = 16;
    float at[3][4][3][room];
    float reach[room];
};

// Of which pairs, one to a bit, it is certain that they do not touch, wherever in their boxes they are; of others nothing is
// said.
RINGLET_DECLARE(unsigned apart(const EdgePairs &pairs);)
// The same wherever each end is in the triangle of its three places.
RINGLET_DECLARE(unsigned apart_anywhere(const EdgeWays &pairs);)
// The same while all ends go straight from start to end together.
RINGLET_DECLARE(unsigned apart_together(const EdgeWays &pairs);)

} // namespace ringlet
