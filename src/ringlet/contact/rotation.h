// The rotation of a pair of primitives in a move.
#pragma once

#include "ringlet/contact/stencil.h"

namespace ringlet {

// The rotation by which a move from `start` to `end` turns a pair that it leaves rigid. It turns with the triangle or with both
// edges; where these are almost parallel, with an edge and the line to the other. The normal does not tell: it also turns as
// the closest points wander over a surface.
Mat3 pair_rotation(const Stencil &pair, View<Vec3> start, View<Vec3> end);

} // namespace ringlet
