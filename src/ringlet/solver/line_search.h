// Backtracking Armijo line search along the limited path, with one step length per cluster of objects in contact.
#pragma once

#include "ringlet/collision/narrow_phase.h"
#include "ringlet/solver/objective.h"
#include "ringlet/solver/search_path.h"

namespace ringlet {

struct LineSearchResult {
    int cuts = 0;             // of step lengths
    std::vector<double> step; // per object; 0: it found none on which the energy falls
};

// Moves x along the path as far as each object may. One that touches nothing dynamic halves its step, later quarters it, until
// its energy decreases sufficiently. Of a cluster only the sum of energies must. Else those whose own energy rises take a
// shorter step, and with them those that they touch: a direction's effects on both sides of a contact belong together. A
// cluster whose limited path leads uphill stays. `accepted` objects take their whole path, whatever their energy. `pairs` are
// those that may come into contact on the path.
LineSearchResult line_search(Objective &objective, const ReachablePairs &pairs, const SearchPath &path,
                             const std::vector<unsigned char> &accepted, AlignedVector &x);

} // namespace ringlet
