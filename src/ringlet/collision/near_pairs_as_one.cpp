// Pairs while nearly everything moves as one body, as hair does on a head: what is known of them stays known.
#include "ringlet/collision/near_pairs.h"

#include "ringlet/collision/collect.h"

namespace ringlet {

double NearPairs::strays(const NearPair &pair) const {
    const auto most = [&](const auto &primitive) {
        double most = 0.0;
        for (const int v : primitive) most = std::max(most, strays_[v]);
        return most;
    };
    return with_vertices(mesh_, pair, [&](const auto &a, const auto &b) { return most(a) + most(b); });
}

// Two that go straight to where a rotation by θ leads them are never nearer than cos ½θ of what they were, less what they
// stray. So pairs that are not known, which are as far apart as they touch or farther, keep more than half of that.
void NearPairs::set_out_as_one(View<Vec3> start, View<Vec3> end, const RigidMotion &motion, View<int> rigid) {
    quick_.assign(start.size(), 0);
    passing_.clear(), may_touch_.clear(), may_come_near_.clear(), may_meet_.clear();
    any_quick_ = boxes_ways_ = false;
    fit_ways(start, end);
    go_as_one(start, end, motion, rigid, all_);
}

void NearPairs::set_out_as_one_anew(View<Vec3> start, View<Vec3> end, const RigidMotion &motion, View<int> rigid,
                                    View<unsigned char> changed) {
    const Affected some(mesh_, broad_phase_.incidence(), changed);
    ways_of_.fit_anew(start, end, some.vertices);
    go_as_one(start, end, motion, rigid, some);
}

void NearPairs::go_as_one(View<Vec3> start, View<Vec3> end, const RigidMotion &motion, View<int> rigid,
                          const Affected &changed) {
    constexpr double least_part = 0.75, hardly = 0.1; // of a distance; of the least radius
    const double part = 0.5 * std::sqrt(std::max(0.0, 1.0 + motion.turn.trace()));
    const bool known = !low_.empty() && noted_ != Noted::this_move && part >= least_part;
    bool any_quick = any_quick_, all_rigid = !rigid.empty();
    strays_.resize(start.size());
    mark_changed(changed);
#pragma omp parallel for schedule(static) reduction(|| : any_quick) reduction(&& : all_rigid)
    for (int v = 0; v < int(start.size()); ++v) {
        const int as = rigid.empty() ? -1 : rigid[v];
        all_rigid = all_rigid && as >= 0 && as == rigid[0];
        if (!changed_[v]) continue;
        strays_[v] = (end[v] - motion(start[v])).norm();
        const bool follows =
            known && (!mesh_.moves[v] || as >= 0) && strays_[v] <= std::min(hardly * least_radius_, room(v, start[v]));
        quick_[v] |= !follows && (known || mesh_.moves[v]);
        any_quick = any_quick || quick_[v];
    }
    any_quick_ = any_quick;
    if (all_rigid && !any_quick) return;
    measure_ways(start, end, changed);
    std::erase_if(passing_, [&](const NearPair &pair) { return has_changed(pair); });
    if (any_quick_) {
        Candidates found;
        if (boxes_ways_)
            broad_phase_.find_quick(ways_of_, ways_of_, quick_, changed_, found);
        else
            broad_phase_.find(ways_of_, found, quick_);
        boxes_ways_ = true;
        merge(passing_, pairs_of(found));
    }
    if (all_rigid) return;
    may_meet_ = collect<NearPair *>(int(known_.size()), [&](int k, std::vector<NearPair *> &may_meet) {
        NearPair &pair = known_[k];
        if (!quick(pair) && has_changed(pair) && part * pair.apart - strays(pair) < 0.5 * pair.distance &&
            ways_of_.with_boxes(pair, ringlet::may_meet))
            may_meet.push_back(&pair);
    });
    meet_passing();
}

void NearPairs::arrive_as_one(View<Vec3> start, View<Vec3> end) {
    if (any_quick_) std::erase_if(known_, [&](const NearPair &pair) { return quick(pair); });
    for (NearPair &pair : passing_) pair.apart = 0.0;
    for (auto *ways : {&vertices_, &edges_, &triangles_}) std::fill(ways->begin(), ways->end(), Way{});
    may_touch_.clear();
    if (noted_ == Noted::this_move) forget();
    knows_all_here_ = true;
    if (low_.empty()) return;
    // Of a corridor is left what holds however it turned: the cube within the ball around where the vertex was in it. What is
    // quick has none.
    const double half_side = 1.0 / std::sqrt(3.0);
#pragma omp parallel for schedule(static)
    for (int v = 0; v < int(start.size()); ++v) {
        const double left = quick_[v] ? -1.0 : half_side * (room(v, start[v]) - strays_[v]);
        low_[v] = end[v].array() - left;
        high_[v] = end[v].array() + left;
    }
    homes_.fit_within(low_, high_);
    broad_phase_.leave_homes();
    double most = 0.0; // any known vertex strays
    for (size_t v = 0; v < strays_.size(); ++v)
        if (!quick_[v]) most = std::max(most, strays_[v]);
    const bool all_alike = most < 0.001 * least_radius_;
    may_touch_ = collect<NearPair *>(int(known_.size()), [&](int k, std::vector<NearPair *> &may_touch) {
        NearPair &pair = known_[k];
        pair.apart -= all_alike ? 2.0 * most : strays(pair);
        if (pair.apart < pair.distance) may_touch.push_back(&pair);
    });
}

} // namespace ringlet
