// The pairs that may touch on a move, which a search asks at many places of it.
#pragma once

#include "ringlet/collision/touching.h"

namespace ringlet {

struct PairInReach {
    std::array<int, 2> of;
    bool of_edges;
    std::array<int, 2> objects;
    double distance;            // r [m]
    double between;             // no less is between them at the start, less r [m]
    std::array<double, 2> ways; // how far each goes at most [m]
};

using PairsInReach = std::vector<PairInReach>;

// Whether one of the objects of a pair counts; those beyond the end do not.
template <class Pair> bool either_counts(const Pair &pair, View<unsigned char> objects) {
    const auto counts = [&](int object) { return size_t(object) < objects.size() && objects[object] != 0; };
    return counts(pair.objects[0]) || counts(pair.objects[1]);
}

// Those that touch there, in order, of pairs with one of the objects that count, each of which has gone that part of its way;
// objects beyond these neither count nor go.
std::vector<Touch> touching(const CollisionMesh &mesh, const PairsInReach &pairs, View<Vec3> positions,
                            View<unsigned char> objects, View<double> gone);

} // namespace ringlet
