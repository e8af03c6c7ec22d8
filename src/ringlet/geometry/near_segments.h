// Pairs of segments of polylines within a distance of one another.
#pragma once

#include "ringlet/geometry/frames.h"

#include <array>
#include <vector>

namespace ringlet {

// All pairs of segments nearer than `within` [m], each once and in ascending order. A segment is identified by its first
// point. Two segments of one curve count if more than `along` [m] of the curve lies between them.
std::vector<std::array<int, 2>> near_segments(const CurveView &curves, double within, double along);

} // namespace ringlet
