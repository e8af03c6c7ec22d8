// Which objects the search has not moved, and what is tried with them.
#pragma once

#include "ringlet/solver/block_set.h"

#include <vector>

namespace ringlet {

// A cluster that has not moved is cautious until it moves: it takes the search direction itself. An object that does not move
// in that, nor in an extra iteration, is stuck: nothing helps it (docs/decisions/stalled_search.md).
class Stall {
public:
    explicit Stall(int objects) : moved_(objects, 0), cautious_(objects, 0), stuck_(objects, 0) {}

    // Takes the step length that the search has found for each object.
    void add_steps(const BlockSet &blocks, const std::vector<int> &cluster, const std::vector<double> &step, bool extra);

    const std::vector<unsigned char> &cautious() const { return cautious_; }

    // Objects that are not at rest in the step, and yet have not moved; `largest` is that of their last direction [m].
    std::vector<unsigned char> stalled(const std::vector<double> &largest, double tolerance) const;
    // Those of them that more iterations may help.
    std::vector<unsigned char> may_move(const std::vector<double> &largest, double tolerance) const;

private:
    std::vector<unsigned char> moved_, cautious_, stuck_; // objects
};

} // namespace ringlet
