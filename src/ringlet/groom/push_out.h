// Deformation of curves that takes them out of bodies.
#pragma once

#include "ringlet/geometry/frames.h"
#include "ringlet/groom/places.h"

#include <vector>

namespace ringlet {

// Moves curves to a distance of at least `margin` [m] from the union of bodies. Near the root, which lies on a surface and does
// not move, half the arc length is enough. Each curve is traversed from its root. Where it is too near, it moves along the
// smooth normal of the surface, and so does the rest of it, by an amount that decays over a length much longer than a curl. So
// a curve passes a body on the side where it enters, and curls keep their form. `allowed`: depth that roots may have in a body.
std::vector<Vec3> push_out(const CurveView &curves, View<const Solid *> bodies, double margin, const Allowed &allowed = {});

} // namespace ringlet
