#include "ringlet/collision/candidates.h"

#include "ringlet/math/parallel.h"

#include <algorithm>

namespace ringlet {

std::vector<CandidatePair> Candidates::with_gaps(const std::vector<PrimitivePair> &found) const {
    std::vector<CandidatePair> pairs(found.size());
    parallel_for(int(found.size()), [&](int k) {
        with_vertices(mesh_, found[k], [&](const auto &a, const auto &b) {
            pairs[k] = {found[k], 0.0, {mesh_.object[a[0]], mesh_.object[b[0]]}};
        });
    });
    if (!mesh_.exempt.empty())
        std::erase_if(pairs, [&](const CandidatePair &pair) {
            return std::binary_search(mesh_.exempt.begin(), mesh_.exempt.end(), pair, before<PrimitivePair>);
        });
    return pairs;
}

void Candidates::enclose(const Move &move, const MotionBounds::Fit &how, Serve serve) {
    const std::vector<int> outside = bounds_.outside(move, how.max_path, of_one_move_ ? how.margin : 0.0);
    const bool most = empty() || 2 * outside.size() > move.start.size(); // then a search for all takes no longer
    if (most || of_one_move_) {
        of_one_move_ = most && refitted_all_ && serve == Serve::this_move;
        refitted_all_ = true;
        bounds_.fit(move, {of_one_move_ ? 0.0 : how.margin, how.max_path});
        pairs_ = with_gaps(of_one_move_ ? find_in_triangles(move) : broad_phase_.find(bounds_.boxes()));
        return;
    }
    refitted_all_ = false;
    if (outside.empty()) return;
    bounds_.fit(move, how, outside);
    std::vector<unsigned char> refitted(move.start.size(), 0);
    for (const int v : outside) refitted[v] = 1;
    std::erase_if(pairs_, [&](const CandidatePair &pair) {
        return with_vertices(mesh_, pair,
                             [&](const auto &a, const auto &b) { return any_of(refitted, a) || any_of(refitted, b); });
    });
    merge(pairs_, with_gaps(broad_phase_.find_changed(bounds_.boxes(), refitted)));
}

std::vector<PrimitivePair> Candidates::find_in_triangles(const Move &move) {
    SweptBoxes boxes(mesh_);
    boxes.fit(move, bounds_.boxes().origin());
    return broad_phase_.find(bounds_.boxes(), boxes);
}

void Candidates::move_rigidly(const RigidMotion &motion, View<Vec3> from) {
    if (empty()) return;
    if (of_one_move_) return clear();
    bounds_.move_rigidly(motion, from);
    broad_phase_.fit(bounds_.boxes());
}

} // namespace ringlet
