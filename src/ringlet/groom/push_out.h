// Keeps curves out of a body.
#pragma once

#include "ringlet/geometry/frames.h"
#include "ringlet/groom/places.h"

#include <vector>

namespace ringlet {

// Leads curves around a body, at least `margin` [m] from it; near the root, which is on the surface, from half the length along
// the curve on. Each curve is followed from its root, which stays: where it comes too near, all that follows moves out along
// the surface's smooth normal, and returns over a length that is long beside a curl. So a curve goes around on the side where
// it came in, and its curls keep their form. `allowed`: roots may be in the body as deep as that says.
std::vector<Vec3> push_out(const CurveView &curves, const Solid &body, double margin, const Allowed &allowed = {});

} // namespace ringlet
