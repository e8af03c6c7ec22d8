// Bound on what a repair does to a curve.
#pragma once

#include "ringlet/math/types.h"

#include <span>

namespace ringlet {

// A repair never destroys a curve. One that became longer or shorter than before by more than the factor `largest_stretch`
// stays as it was. In others, where an edge lost nearly all of its length, the points are spread again along the curve.
void keep_form(View<Vec3> before, double largest_stretch, std::span<Vec3> points);

} // namespace ringlet
