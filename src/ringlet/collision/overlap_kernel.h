// The inner loop of the broad phase on plain arrays, built for each instruction set.
#pragma once

#include "ringlet/math/simd.h"

namespace ringlet {

// Four boxes at the start of a motion, side by side: by axis, and lane k of each row is of box k. Which of them count, and
// which move: a sum of two is positive where neither does. All that is read of boxes that stay, it fills two cache lines. Up to
// seven numbers are read from where each row begins, so that something has to stand behind the last.
struct alignas(128) BoxQuad {
    float low[3][4], high[3][4];
    float counts[4], moves[4];
};

// The same boxes at its end.
struct alignas(32) EndQuad {
    float low[3][4], high[3][4];
};

// A tree of moving_tree.h.
struct BoxTree {
    const BoxQuad *nodes;
    const EndQuad *ends;
    int first_leaf, children_of_root;
};

struct BoxPair {
    int of[2];
};

// What is left to do of a descent through two trees, and what it has found: the pairs of boxes in leaves that overlap at some
// time. A node is named by its number, a box by its lane and four times the number of its leaf.
struct Descent {
    static constexpr int room = 1024; // a descent from one pair never leaves as many

    BoxTree a, b;
    bool one_tree; // a and b are one: each pair is found once
    bool still;    // nothing moves: boxes are the same at the end
    int left, found;
    BoxPair nodes[room], boxes[room];
};

// Descends until nothing is left or there might be no room for more, but visits no more pairs of nodes than that.
RINGLET_DECLARE(void descend(Descent &descent, int most_visits);)

} // namespace ringlet
