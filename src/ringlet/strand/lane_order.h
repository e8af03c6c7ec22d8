// Order in which strands fill the lanes of the kernels.
#pragma once

#include "ringlet/strand/model.h"

#include <vector>

namespace ringlet {

// Longest first, so that strands of a group have similar lengths and few rows lie behind a tip. The order is fixed: the result
// of a strand depends neither on its group nor on the number of threads.
std::vector<int> order_by_length(const StrandModel &model);

// The same; of equal length, near strands follow one another, so that strands in contact share groups.
std::vector<int> order_by_length_and_position(const StrandModel &model, View<Vec3> positions);

} // namespace ringlet
