// The last word on every move: nothing passes through anything.
#pragma once

#include "ringlet/ccd/filter_scene.h"
#include "ringlet/collision/near_pairs.h"

#include <vector>

namespace ringlet {

struct FilterReport {
    int candidates = 0; // pairs near one another's paths
    int violations = 0; // of them, how many would have met
    int zone_vertices = 0, rounds = 0;
    double fraction = 1.0; // of the move that everything goes; 1 unless no way out was found
};

// Changes where a move ends (`end`, rows of vertices that move) so that no pair meets while every vertex goes straight from
// `start` to `end`: none comes nearer than half its contact distance or, if that is less, a fifth of its distance at the start,
// but no more than a little below 1/250 of its contact distance. Where nothing kinematic moves, a strand that would meet
// another goes only as far as where they touch, as a whole, so that its shape is one on the way, and both go equally far, so
// that what one does for the other still fits; or it is held back near the pair alone if it could hardly move. Of a cloth only
// what is in the way is held back, and less and less around it. What is still in the way after some rounds stays. Else vertices
// of pairs that would meet form zones, which share one motion: that of the body they touch, or their mean. Along a strand and
// over a cloth the change fades out so slowly that no edge is strained by more than a few per cent. Zones grow while pairs at
// their border would meet. Where bodies leave no way out, everything goes only a part of its way.
//
// Only relative motion counts: a scene that moves as a whole is filtered alike. `near` may know pairs only where nothing
// kinematic moves; it sets out on the filtered move.
FilterReport filter_step(const FilterScene &scene, NearPairs &near, View<Vec3> start, std::vector<Vec3> &end);

} // namespace ringlet
