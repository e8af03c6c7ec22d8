// Blue-noise samples by weighted sample elimination.
#pragma once

#include "ringlet/math/types.h"

#include <vector>

namespace ringlet {

// Eliminates, one by one, the most crowded of a dense cloud of `candidates` on a surface of `area` [m²] until `count` are left
// (Yuksel, "Sample elimination for generating Poisson disk sample sets", CGF 34(2), 2015). One sample fewer removes one and
// moves none. Returns ascending indices.
std::vector<int> thin_out(View<Vec3> candidates, double area, int count);

} // namespace ringlet
