// Pairs of segments of polylines that are near one another.
#pragma once

#include "ringlet/geometry/frames.h"

#include <array>
#include <vector>

namespace ringlet {

// All pairs of segments nearer than `within` [m], each once and in ascending order; a segment is named by its first point.
// Two of the same curve count where more than `along` [m] of it is between them.
std::vector<std::array<int, 2>> near_segments(const CurveView &curves, double within, double along);

} // namespace ringlet
