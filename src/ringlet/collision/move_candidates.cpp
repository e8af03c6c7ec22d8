#include "ringlet/collision/move_candidates.h"

#include "ringlet/math/collect.h"

#include <algorithm>

namespace ringlet {
namespace {

// Culling of candidate pairs on a move: edges by separating axes, many at a time, points and triangles by boxes.

// Where the vertices of a move are allowed to be.
enum class Motion {
    in_triangles, // each anywhere in its triangle of start, end and apex
    straight      // all on their straight paths at one time
};

// Keeps the pairs that may come into contact, or with straight motion have an impact, in order.
template <class Pair> class PairCuller {
public:
    PairCuller(const SweptBoxes &boxes, Motion motion, std::vector<Pair *> &kept)
        : boxes_(boxes), motion_(motion), kept_(kept) {}
    ~PairCuller() { cull_edges(); }

    void keep(Pair &pair) {
        cull_edges();
        kept_.push_back(&pair);
    }

    void add(Pair &pair) {
        if (!pair.edge_edge) {
            if (boxes_.with_boxes(pair, motion_ == Motion::straight ? may_overlap : paths_overlap)) keep(pair);
            return;
        }
        pairs_[count_++] = &pair;
        if (count_ == MovingEdgePairs::room) cull_edges();
    }

private:
    void cull_edges() {
        if (count_ == 0) return;
        boxes_.gather(edges_, count_, [&](int k) { return pairs_[k]->primitive; });
        const bool straight = motion_ == Motion::straight;
        const double reach = straight ? collision::impact_reach : 1.0;
        for (int k = 0; k < count_; ++k) edges_.reach[k] = float(reach * pairs_[k]->d_hat) + boxes_.rounding();
        const unsigned separated =
            straight ? RINGLET_DISPATCH(separated_in_motion, edges_) : RINGLET_DISPATCH(separated_in_triangles, edges_);
        for (int k = 0; k < count_; ++k)
            if (!(separated >> k & 1u)) kept_.push_back(pairs_[k]);
        count_ = 0;
    }

    const SweptBoxes &boxes_;
    Motion motion_;
    std::vector<Pair *> &kept_;
    MovingEdgePairs edges_ = {};
    std::array<Pair *, MovingEdgePairs::room> pairs_;
    int count_ = 0; // pairs of edges that wait
};

} // namespace

MoveCandidates::MoveCandidates(Candidates &candidates)
    : candidates_(candidates), mesh_(candidates.mesh()), all_(mesh_), boxes_(mesh_), paths_(mesh_) {}

void MoveCandidates::begin(const Move &move) {
    const MotionBounds &bounds = candidates_.bounds();
    escaped_ = bounds.escaped(move);
    any_escaped_ = std::count(escaped_.begin(), escaped_.end(), 1) > 0;
    paths_.set_changed(all_);
    paths_.measure(move, all_, escaped_);
    find_moving();
    boxes_.fit(move, bounds.boxes().origin());
    transient_ = any_escaped_ ? candidates_.find_escaped(boxes_, escaped_, escaped_) : std::vector<CandidatePair>();
    std::vector<CandidatePair> &pairs = candidates_.pairs();
    reachable_ = collect_ranges<CandidatePair *>(int(pairs.size()), [&](int begin, int end, auto &kept) {
        PairCuller<CandidatePair> culler(boxes_, Motion::in_triangles, kept);
        for (int k = begin; k < end; ++k) {
            if (at_rest(pairs[k])) {
                if (pairs[k].min_gap < pairs[k].d_hat) culler.keep(pairs[k]);
            } else if (may_contact(pairs[k]) && !(any_escaped_ && paths_.escaped(pairs[k]))) {
                culler.add(pairs[k]);
            }
        }
    });
    path_candidates_ = collect<CandidatePair *>(int(reachable_.size()), [&](int k, auto &kept) {
        if (!at_rest(*reachable_[k]) && may_impact(*reachable_[k])) kept.push_back(reachable_[k]);
    });
    impact_candidates_ = cull_straight([](const CandidatePair &) { return true; });
    add_transient_candidates();
}

void MoveCandidates::find_moving() {
    moving_.assign(mesh_.objects.size(), 0);
    parallel_for(int(moving_.size()), [&](int object) {
        for (int v = mesh_.objects[object].first; v < mesh_.objects[object].end && !moving_[object]; ++v)
            moving_[object] = paths_.moves(v);
    });
}

MeshSubset MoveCandidates::refit(const Move &move, View<unsigned char> changed) {
    MeshSubset subset(mesh_, candidates_.incidence(), changed);
    paths_.measure(move, subset, escaped_);
    boxes_.refit(move, subset.vertices);
    return subset;
}

void MoveCandidates::shorten(const Move &move, View<unsigned char> changed) { refit(move, changed); }

void MoveCandidates::update(const Move &move, View<unsigned char> changed) {
    paths_.set_changed(refit(move, changed));
    if (any_escaped_) {
        std::erase_if(transient_, [&](const CandidatePair &pair) { return paths_.changed(pair); });
        merge(transient_, candidates_.find_escaped(boxes_, escaped_, changed));
    }
    impact_candidates_ = cull_straight([&](const CandidatePair &pair) { return paths_.changed(pair) && may_impact(pair); });
    add_transient_candidates();
}

template <class Filter> std::vector<CandidatePair *> MoveCandidates::cull_straight(const Filter &filter) const {
    return collect_ranges<CandidatePair *>(int(path_candidates_.size()), [&](int begin, int end, auto &kept) {
        PairCuller<CandidatePair> culler(boxes_, Motion::straight, kept);
        for (int k = begin; k < end; ++k)
            if (CandidatePair &pair = *path_candidates_[k]; filter(pair)) culler.add(pair);
    });
}

void MoveCandidates::add_transient_candidates() {
    const size_t cached = impact_candidates_.size();
    for (CandidatePair &pair : transient_)
        if (paths_.changed(pair)) impact_candidates_.push_back(&pair);
    std::inplace_merge(impact_candidates_.begin(), impact_candidates_.begin() + cached, impact_candidates_.end(),
                       [](const CandidatePair *a, const CandidatePair *b) { return before(*a, *b); });
}

void MoveCandidates::commit(View<Vec3> start, View<Vec3> end) {
    for (auto *pairs : {&candidates_.pairs(), &transient_})
        parallel_for(int(pairs->size()), [&](int k) {
            CandidatePair &pair = (*pairs)[k];
            if (pair.min_gap <= 0.0 || at_rest(pair) || paths_.length(pair) == 0.0) return;
            pair.min_gap -=
                with_vertices(mesh_, pair, [&](const auto &a, const auto &b) { return max_approach(a, b, start, end); });
        });
    paths_.clear();
}

std::vector<ContactPair> MoveCandidates::contact_pairs(View<Vec3> positions, View<unsigned char> objects) {
    const auto raise = [](CandidatePair &pair, double gap) { pair.min_gap = gap; };
    const auto find = [&](size_t count, const auto &pair_of) {
        return collect_ranges<ContactPair>(int(count), [&](int begin, int end, std::vector<ContactPair> &found) {
            NarrowPhase<CandidatePair, decltype(raise)> narrow_phase(mesh_, positions, raise, found);
            for (int k = begin; k < end; ++k)
                if (CandidatePair &pair = pair_of(k); any_marked(pair.object, objects) && may_contact(pair))
                    narrow_phase.add(pair);
        });
    };
    std::vector<ContactPair> all = find(reachable_.size(), [&](int k) -> CandidatePair & { return *reachable_[k]; });
    merge(all, find(transient_.size(), [&](int k) -> CandidatePair & { return transient_[k]; }));
    return all;
}

ReachablePairs MoveCandidates::reachable_pairs(View<unsigned char> objects) const {
    const auto consider = [&](const CandidatePair &pair, ReachablePairs &found) {
        if (any_marked(pair.object, objects) && may_contact(pair))
            found.push_back({pair, pair.object, pair.min_gap - pair.d_hat, paths_.lengths(pair)});
    };
    ReachablePairs all =
        collect<ReachablePair>(int(reachable_.size()), [&](int k, ReachablePairs &found) { consider(*reachable_[k], found); });
    ReachablePairs transient;
    for (const CandidatePair &pair : transient_) consider(pair, transient);
    merge(all, transient);
    return all;
}

} // namespace ringlet
