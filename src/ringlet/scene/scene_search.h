// The line search of a scene.
#pragma once

#include "ringlet/scene/scene_system.h"

namespace ringlet {

// The largest coordinate of each part's direction [m]; those of parts that are not active stay as they are in `reach`. A part
// whose direction is not finite, its system being too ill-conditioned to solve, stays: its direction becomes zero.
void measure(const SceneSystem &system, AlignedVector &direction, std::vector<double> &reach);

// Every part goes only so much of its direction.
void shorten(const SceneSystem &system, const std::vector<double> &parts, AlignedVector &direction);

// Per part, how much of its direction from x is worth going. No edge of a strand is to change by more than twice its length, as
// it does when it turns round: of what goes further, what is linear says nothing.
std::vector<double> worth_going(const SceneSystem &system, const AlignedVector &x, const AlignedVector &direction);

// These parts, and those that touch one of them.
std::vector<unsigned char> with_touched(const SceneSystem &system, const std::vector<unsigned char> &parts);

struct SceneSearch {
    bool moved = false;       // false: no part found a way on which the energy falls
    int cuts = 0;             // times that a part went less far
    std::vector<double> step; // per part: how much of its direction it went
};

// Goes from x along the direction, which is that of the last move, every part as far as is good for it. One that touches
// nothing that moves goes half as far, later a quarter, until its energy falls as it should. The energies of a cluster,
// contacts shared out evenly, need only fall in sum; where they do not, those whose own rises go less far, and so do those that
// they touch: what a direction does on both sides of a contact belongs together. A cluster stays where what the filter left of
// its direction leads nowhere down. Parts that are to go `all_of_it` do, whatever the energy; without `near`, by contacts
// alone, they are yet to be searched, and what the others have to do with them does not count.
SceneSearch search(SceneSystem &system, const NearPairs *near, const AlignedVector &direction,
                   const std::vector<unsigned char> &all_of_it, AlignedVector &x);

} // namespace ringlet
