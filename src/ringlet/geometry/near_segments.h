// Pairs of segments of polylines that touch, each as thick as its curve is there.
#pragma once

#include "ringlet/geometry/frames.h"

#include <array>
#include <vector>

namespace ringlet {

// All pairs of segments nearer than the sum of their radii [m], each once and in ascending order. A segment is identified by
// its first point and has the radius of that point. Two segments of one curve count if more than `along` times that sum of the
// curve lies between them.
std::vector<std::array<int, 2>> near_segments(const CurveView &curves, View<double> radius, double along);

} // namespace ringlet
