#include "ringlet/collision/narrow_phase.h"

#include "ringlet/math/collect.h"

namespace ringlet {

std::vector<ContactPair> contact_pairs(const CollisionMesh &mesh, const ReachablePairs &pairs, View<Vec3> positions,
                                       View<unsigned char> objects, View<double> fractions) {
    const auto path = [&](const ReachablePair &pair, int k) {
        return size_t(pair.object[k]) < fractions.size() ? fractions[pair.object[k]] * pair.path_length[k] : 0.0;
    };
    const auto ignore = [](const ReachablePair &, double) {};
    return collect_ranges<ContactPair>(int(pairs.size()), [&](int begin, int end, std::vector<ContactPair> &found) {
        NarrowPhase<const ReachablePair, decltype(ignore)> narrow_phase(mesh, positions, ignore, found);
        for (int k = begin; k < end; ++k)
            if (any_marked(pairs[k], objects) && pairs[k].slack < path(pairs[k], 0) + path(pairs[k], 1))
                narrow_phase.add(pairs[k]);
    });
}

} // namespace ringlet
