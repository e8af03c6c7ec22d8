// The line search of a scene.
#pragma once

#include "ringlet/solver/scene_way.h"

namespace ringlet {

// These parts, and those that touch one of them.
std::vector<unsigned char> with_touched(const SceneSystem &system, const std::vector<unsigned char> &parts);

struct SceneSearch {
    bool moved = false;       // false: no part found a way on which the energy falls
    int cuts = 0;             // times that a part went less far
    std::vector<double> step; // per part: how much of its way it went
};

// Goes from x along the way, which is that of the last move, every part as far as is good for it. One that touches
// nothing that moves goes half as far, later a quarter, until its energy falls as it should. The energies of a cluster,
// contacts shared out evenly, need only fall in sum; where they do not, those whose own rises go less far, and so do those that
// they touch: what a direction does on both sides of a contact belongs together. A cluster stays where what the filter left of
// its way leads nowhere down. Parts that are to go `all_of_it` do, whatever the energy; without `near`, by contacts
// alone, they are yet to be searched, and what the others have to do with them does not count.
SceneSearch search(SceneSystem &system, const PairCache *near, const SceneWay &way, const std::vector<unsigned char> &all_of_it,
                   AlignedVector &x);

} // namespace ringlet
