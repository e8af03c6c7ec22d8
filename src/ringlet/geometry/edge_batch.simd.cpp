#include "ringlet/geometry/edge_batch.h"

#include "ringlet/geometry/closest_of_edges.h"

#include <cstring>

namespace ringlet::RINGLET_SIMD {

unsigned find_closest(EdgeBatch &pairs) {
    unsigned exact = 0;
    for (int from = 0; from < EdgeBatch::room; from += lanes) {
        const auto read = [&](int end) {
            Vec<Pack> x;
            for (int axis = 0; axis < 3; ++axis) std::memcpy(&x[axis], pairs.ends[end][axis] + from, sizeof(Pack));
            return x;
        };
        const ClosestOfEdges<Pack> closest = closest_of_edges(read(0), read(1), read(2), read(3));
        std::memcpy(pairs.s + from, &closest.s, sizeof(Pack));
        std::memcpy(pairs.t + from, &closest.t, sizeof(Pack));
        std::memcpy(pairs.distance2 + from, &closest.distance2, sizeof(Pack));
        for (int lane = 0; lane < lanes; ++lane) exact |= unsigned(closest.askew[lane] & 1) << (from + lane);
    }
    return exact;
}

} // namespace ringlet::RINGLET_SIMD
