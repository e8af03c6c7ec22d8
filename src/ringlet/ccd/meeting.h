// Which pairs would meet on a move.
#pragma once

#include "ringlet/ccd/filter_scene.h"
#include "ringlet/collision/near_pairs.h"

#include <array>
#include <vector>

namespace ringlet {

struct Met { // a pair that would meet
    std::array<int, 4> vertices;
    double time; // until when it keeps its distance
};

// Until when a pair keeps its distance; above 1: to the end. What is known of how far it is apart may say so; else
// this is noted anew, as at the start.
double meeting_time(const CollisionMesh &mesh, const NearPair &pair, View<Vec3> start, View<Vec3> end);

// Of those that may meet, in order.
std::vector<Met> find_met(const FilterScene &scene, const NearPairs &near, View<Vec3> start, View<Vec3> end);

} // namespace ringlet
