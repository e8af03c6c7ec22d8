// Pairs of boxes of two bounding volume hierarchies, or of one, that overlap.
#pragma once

#include "ringlet/geometry/bvh.h"

#include <limits>
#include <vector>

namespace ringlet {

Traversal traversal(const Bvh &a, const Bvh &b, bool is_static);

// The pairs of nodes from which tasks descend, the same for any number of threads.
std::vector<NodePair> split(const Bvh &a, const Bvh &b, bool is_static);

// Descends from a pair of nodes. Calls work() with some pairs found at a time, in order; they stand in the traversal.
template <class Work> void descend(Traversal &from, const NodePair &start, const Work &work) {
    from.nodes[0] = start;
    for (from.left = 1; from.left > 0; from.found = 0) {
        RINGLET_DISPATCH(traverse, from, std::numeric_limits<int>::max());
        work();
    }
}

} // namespace ringlet
