// Evenly spread samples without a pattern (blue noise).
#pragma once

#include "ringlet/math/types.h"

#include <vector>

namespace ringlet {

// Thins a dense cloud of `candidates` on a surface of `area` [m²] to `count` that keep their distance: takes away, one by one,
// the candidate most crowded by the others (Yuksel, "Sample elimination for generating Poisson disk sample sets", CGF 34(2),
// 2015). Asking for one sample fewer removes one and moves none. Returns indices, ascending.
std::vector<int> thin_out(View<Vec3> candidates, double area, int count);

} // namespace ringlet
