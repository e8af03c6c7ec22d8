// How strands are dealt to the lanes of the kernels.
#pragma once

#include "ringlet/strand/strands.h"

#include <vector>

namespace ringlet {

StrandArrays arrays_of(const StrandModel &model, StrandState &state, View<Vec3> targets, View<Vec3> forces);

// Strands of like length together, so that few lanes carry vertices that are not there. A fixed order: the result of a strand
// does not depend on its group, and a group never on the threads.
std::vector<int> by_length(const StrandModel &model);

// The same, and of like length those together that stand near one another: what touches shares groups, so that fewer of these
// have something to do where little is left to be done.
std::vector<int> by_length_and_place(const StrandModel &model, View<Vec3> positions);

} // namespace ringlet
