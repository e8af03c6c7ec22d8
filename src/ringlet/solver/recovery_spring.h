// A one-sided spring that draws a vertex out of a body that it began in.
#pragma once

#include "ringlet/math/types.h"

#include <algorithm>

namespace ringlet {

// Energy ½ k (h − n · x)² below the plane n · x = h, none above. Implicit, it lifts no farther, however stiff it is.
struct RecoverySpring {
    int vertex;
    Vec3 normal;              // n
    double height, stiffness; // h [m], k [N/m]

    double depth(const Vec3 &x) const { return std::max(height - normal.dot(x), 0.0); } // [m]
    double energy(const Vec3 &x) const { return 0.5 * stiffness * depth(x) * depth(x); }
};

} // namespace ringlet
