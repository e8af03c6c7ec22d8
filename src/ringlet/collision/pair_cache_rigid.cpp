// Rigid moves of the pair cache. Uncached pairs are at least their activation distance apart and keep more than half of it.
#include "ringlet/collision/pair_cache.h"

#include "ringlet/math/collect.h"

#include <algorithm>

namespace ringlet {

void PairCache::begin_rigid_move(const Move &move, const RigidMotion &motion, View<int> rigid) {
    bounds_.clear_escaped();
    transient_.clear(), reachable_.clear(), path_candidates_.clear(), impact_candidates_.clear();
    boxes_searched_ = false;
    fit_boxes(move);
    follow(move, motion, rigid, all_);
}

void PairCache::update_rigid_move(const Move &move, const RigidMotion &motion, View<int> rigid, View<unsigned char> changed) {
    const MeshSubset subset(mesh_, broad_phase_.incidence(), changed);
    boxes_.refit(move, subset.vertices);
    follow(move, motion, rigid, subset);
}

void PairCache::follow(const Move &move, const RigidMotion &motion, View<int> rigid, const MeshSubset &changed) {
    const double kept = RigidAdvection::kept_distance(motion);
    const bool bounded = state_ == State::Bounded && kept >= collision::least_kept_distance;
    const bool all_rigid =
        !rigid.empty() && std::all_of(rigid.begin(), rigid.end(), [&](int as) { return as >= 0 && as == rigid[0]; });
    paths_.set_changed(changed);
    advection_.begin(move, motion, rigid, paths_.changed_vertices(), bounded, bounds_);
    if (all_rigid && !bounds_.any_escaped()) return;
    paths_.measure(move, changed, bounds_.escaped());
    std::erase_if(transient_, [&](const CandidatePair &pair) { return paths_.changed(pair); });
    if (bounds_.any_escaped()) {
        Candidates found;
        if (boxes_searched_)
            broad_phase_.find_escaped(boxes_, boxes_, bounds_.escaped(), paths_.changed_vertices(), found);
        else
            broad_phase_.find(boxes_, found, bounds_.escaped());
        boxes_searched_ = true;
        merge(transient_, pairs_of(found));
    }
    if (all_rigid) return;
    impact_candidates_ = collect<CandidatePair *>(int(cached_.size()), [&](int k, auto &candidates) {
        CandidatePair &pair = cached_[k];
        if (!escaped(pair) && paths_.changed(pair) &&
            kept * pair.min_gap - advection_.deviation(pair) < collision::impact_distance * pair.d_hat &&
            boxes_.with_boxes(pair, may_overlap))
            candidates.push_back(&pair);
    });
    add_transient_candidates();
}

void PairCache::commit_rigid_move(View<Vec3> start, View<Vec3> end) {
    if (bounds_.any_escaped()) std::erase_if(cached_, [&](const CandidatePair &pair) { return escaped(pair); });
    for (CandidatePair &pair : transient_) pair.min_gap = 0.0;
    paths_.clear();
    reachable_.clear();
    if (state_ == State::OneMove) clear();
    complete_ = true;
    if (state_ == State::Empty) return;
    advection_.advect({start, end}, bounds_);
    broad_phase_.invalidate();
    reachable_ = collect<CandidatePair *>(int(cached_.size()), [&](int k, auto &reachable) {
        CandidatePair &pair = cached_[k];
        pair.min_gap -= advection_.advected_deviation(pair);
        if (pair.min_gap < pair.d_hat) reachable.push_back(&pair);
    });
}

} // namespace ringlet
