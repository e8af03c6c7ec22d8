// The line search of a scene.
#pragma once

#include "ringlet/scene/scene_system.h"

namespace ringlet {

struct SceneSearch {
    bool moved = false; // false: no way was found on which the energy falls
    double largest = 0; // coordinate of the direction [m]
    int cuts = 0;       // halvings
};

// Goes from x along the direction, every part as far as is good for it. One that touches nothing that moves goes half as far
// until its energy falls as it should. The energies of those that touch, contacts shared out evenly, need only fall in sum;
// where they do not, those whose own rises go half as far. A direction that nowhere exceeds the tolerance [m] is gone as it is;
// a part whose direction is not finite, its system being too ill-conditioned to solve, stays.
SceneSearch search(SceneSystem &system, AlignedVector &direction, double tolerance, AlignedVector &x);

} // namespace ringlet
