// What draws a vertex out of a body that it began in.
#pragma once

#include "ringlet/math/types.h"

#include <algorithm>

namespace ringlet {

// Energy ½ k (h − n · x)² below the plane n · x = h, none above: implicit, it lifts no farther than that, however stiff.
struct Lift {
    int vertex;
    Vec3 normal; // n
    double height, stiffness;

    double below(const Vec3 &x) const { return std::max(height - normal.dot(x), 0.0); } // [m]
};

} // namespace ringlet
