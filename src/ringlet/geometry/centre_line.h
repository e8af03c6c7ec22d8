// Centre line of a coil.
#pragma once

#include "ringlet/math/types.h"

namespace ringlet {

// Mean of a polyline of evenly spaced points over `window` points about each, taken twice; half a window from its ends the line
// goes on straight. A window of one turn takes a helix to its axis, and the second mean what is left where the pitch varies.
// A window below 2 leaves the points. The window is at most two thirds of the points.
void centre_line(View<Vec3> points, int window, std::span<Vec3> result);

} // namespace ringlet
