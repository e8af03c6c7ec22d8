// Pairs that may come into contact on a move, for a line search that asks for contacts at many points of it.
#pragma once

#include "ringlet/collision/narrow_phase.h"

namespace ringlet {

struct ReachablePair : PrimitivePair {
    std::array<int, 2> object;
    double slack;                      // lower bound on the gap at the start, less d_hat [m]
    std::array<double, 2> path_length; // upper bound for each primitive [m]
};

using ReachablePairs = std::vector<ReachablePair>;

// Whether one of a pair's objects is marked; those beyond the end are not.
template <class Pair> bool any_marked(const Pair &pair, View<unsigned char> objects) {
    const auto marked = [&](int object) { return size_t(object) < objects.size() && objects[object] != 0; };
    return marked(pair.object[0]) || marked(pair.object[1]);
}

// The contact pairs with a marked object at `positions`, where each object has made at most the given fraction of its path.
// Objects beyond these are unmarked and at rest.
std::vector<ContactPair> contact_pairs(const CollisionMesh &mesh, const ReachablePairs &pairs, View<Vec3> positions,
                                       View<unsigned char> objects, View<double> fractions);

} // namespace ringlet
