// The map of space that a prescribed motion makes: between bodies, what is near one moves along with it.
#pragma once

#include "ringlet/geometry/rigid_motion.h"
#include "ringlet/scene/prescribed_motion.h"

namespace ringlet {

// Patches of bodies, and of the pins of cloths, move as rigidly as they can, and the space between them by inverse-distance
// weights (Shepard 1968). The map is continuous: as long as bodies do not come much closer to one another, nothing meets on it,
// even where what follows one body rigidly would run into another.
class SpaceMap {
public:
    explicit SpaceMap(const PrescribedMotion &motion);

    Vec3 operator()(const Vec3 &point) const;

private:
    struct Patch {
        std::vector<int> vertices;
        RigidMotion motion; // from their middle
    };
    std::vector<Patch> patches_;
};

} // namespace ringlet
