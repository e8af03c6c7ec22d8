#include "ringlet/collision/pairs_in_reach.h"

#include "ringlet/collision/collect.h"

namespace ringlet {

std::vector<Touch> touching(const CollisionMesh &mesh, const PairsInReach &pairs, View<Vec3> positions,
                            View<unsigned char> objects, View<double> gone) {
    const auto way = [&](const PairInReach &pair, int k) {
        return size_t(pair.objects[k]) < gone.size() ? gone[pair.objects[k]] * pair.ways[k] : 0.0;
    };
    const auto nothing = [](const PairInReach &, double) {};
    return collect_parts<Touch>(int(pairs.size()), [&](int begin, int end, std::vector<Touch> &found) {
        Touching<PairInReach, decltype(nothing)> some(mesh, positions, nothing, found);
        for (int k = begin; k < end; ++k)
            if (either_counts(pairs[k], objects) && pairs[k].between < way(pairs[k], 0) + way(pairs[k], 1))
                some.look_at(pairs[k]);
    });
}

} // namespace ringlet
