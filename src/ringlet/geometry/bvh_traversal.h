// Traversal of two bounding volume hierarchies on plain arrays: the inner loop of the broad phase, built per instruction set.
#pragma once

#include "ringlet/math/simd.h"

namespace ringlet {

// Four boxes at the start of a motion: by axis, and lane k of each row is of box k. Of `active` and `moves` a sum of two is
// positive where neither is set. It fills two cache lines and is all that static boxes need. Up to seven numbers are read from
// the begin of each row, so something has to follow the last.
struct alignas(128) BoxQuad {
    float low[3][4], high[3][4];
    float active[4], moves[4];
};

// The same boxes at the end of the motion.
struct alignas(32) EndQuad {
    float low[3][4], high[3][4];
};

// The nodes of a Bvh.
struct BvhNodes {
    const BoxQuad *starts;
    const EndQuad *ends;
    int first_leaf, children_of_root;
};

// Two nodes by their numbers, or two boxes of leaves: each its lane and four times the number of its leaf.
struct NodePair {
    int of[2];
};

// A traversal in progress: the pairs of nodes that are left, and the pairs of leaf boxes found so far that overlap at some
// time.
struct Traversal {
    static constexpr int room = 1024; // the descent from one pair never needs as many

    BvhNodes a, b;
    bool one_tree;  // a and b are the same: each pair is found once
    bool is_static; // boxes are the same at the end
    int left, found;
    NodePair nodes[room], boxes[room];
};

// Visits pairs of nodes until none is left, the buffers might overflow, or `max_visits` are made.
RINGLET_DECLARE(void traverse(Traversal &traversal, int max_visits);)

} // namespace ringlet
