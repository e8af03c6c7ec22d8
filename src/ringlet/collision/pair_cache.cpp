#include "ringlet/collision/pair_cache.h"

#include "ringlet/collision/pair_culler.h"
#include "ringlet/math/collect.h"

#include <algorithm>

namespace ringlet {

PairCache::PairCache(const CollisionMesh &mesh)
    : mesh_(mesh), all_(mesh), broad_phase_(mesh), bounds_(mesh), boxes_(mesh), paths_(mesh) {}

void PairCache::clear() {
    state_ = State::Empty;
    complete_ = false;
    bounds_.clear();
    transient_.clear(), cached_.clear(), reachable_.clear(), path_candidates_.clear();
}

std::vector<CandidatePair> PairCache::pairs_of(const Candidates &found) const {
    const int edges = int(found.edge_edge.size()), all = edges + int(found.point_triangle.size());
    std::vector<CandidatePair> pairs(all);
#pragma omp parallel for schedule(static)
    for (int k = 0; k < all; ++k) {
        CandidatePair &pair = pairs[k];
        pair.primitive = k < edges ? found.edge_edge[k] : found.point_triangle[k - edges];
        pair.edge_edge = k < edges;
        pair.min_gap = 0.0;
        with_vertices(mesh_, pair, [&](const auto &a, const auto &b) {
            pair.d_hat = activation_distance(mesh_, a, b);
            pair.object = {mesh_.object[a[0]], mesh_.object[b[0]]};
        });
    }
    if (!mesh_.exempt.empty())
        std::erase_if(pairs, [&](const CandidatePair &pair) {
            return std::binary_search(mesh_.exempt.begin(), mesh_.exempt.end(), pair, before<PrimitivePair>);
        });
    return pairs;
}

void PairCache::update_bounds(const Move &move, const BoundsOptions &options) {
    complete_ = true;
    const double missing = state_ == State::OneMove ? options.margin : 0.0;
    const std::vector<int> outside = bounds_.outside(move, options.max_path, missing);
    if (outside.empty() && state_ == State::Bounded) {
        refitted_all_ = false;
        return;
    }
    transient_.clear();
    paths_.clear();
    const bool most = state_ == State::Empty || 2 * outside.size() > move.start.size(); // then a search for all takes no longer
    const bool again = state_ == State::OneMove || (state_ == State::Bounded && refitted_all_);
    const bool one_move = most && again && !options.lasting;
    refitted_all_ = most || worn_ || state_ == State::OneMove;
    Candidates found;
    if (refitted_all_) {
        worn_ = false;
        bounds_.fit(move, {one_move ? 0.0 : options.margin, options.max_path});
        state_ = one_move ? State::OneMove : State::Bounded;
        if (one_move) fit_boxes(move);
        broad_phase_.find(bounds_.boxes(), found, {}, one_move ? &boxes_ : nullptr);
        cached_ = pairs_of(found);
    } else {
        bounds_.fit(move, {options.margin, options.max_path}, outside);
        std::vector<unsigned char> refitted(move.start.size(), 0);
        for (const int v : outside) refitted[v] = 1;
        broad_phase_.find_escaped(bounds_.boxes(), bounds_.boxes(), refitted, refitted, found);
        std::erase_if(cached_, [&](const CandidatePair &pair) {
            return with_vertices(mesh_, pair,
                                 [&](const auto &a, const auto &b) { return any_of(refitted, a) || any_of(refitted, b); });
        });
        merge(cached_, pairs_of(found));
    }
    reachable_.clear();
    for (CandidatePair &pair : cached_) reachable_.push_back(&pair);
}

void PairCache::fit_boxes(const Move &move) {
    if (move.start.empty()) return;
    boxes_.fit(move, state_ == State::Empty ? SweptBoxes::Origin{move.start[0], move.end[0]} : bounds_.boxes().origin());
}

std::vector<CandidatePair> PairCache::find_transient(View<unsigned char> changed) {
    Candidates found;
    if (state_ == State::Empty)
        broad_phase_.find(boxes_, found, changed);
    else
        broad_phase_.find_escaped(boxes_, bounds_.boxes(), bounds_.escaped(), changed, found);
    return pairs_of(found);
}

void PairCache::begin_move(const Move &move) {
    deferred_.clear();
    bounds_.find_escaped(move);
    paths_.set_changed(all_);
    paths_.measure(move, all_, bounds_.escaped());
    fit_boxes(move);
    transient_ = bounds_.any_escaped() ? find_transient(bounds_.escaped()) : std::vector<CandidatePair>();
    reachable_ = collect_ranges<CandidatePair *>(int(cached_.size()), [&](int begin, int end, auto &kept) {
        PairCuller<CandidatePair> culler(boxes_, Motion::in_triangles, kept);
        for (int k = begin; k < end; ++k)
            if (CandidatePair &pair = cached_[k]; !escaped(pair) && may_contact(pair)) {
                const bool culled = state_ == State::OneMove && pair.edge_edge; // when it was found
                culled ? kept.push_back(&pair) : culler.add(pair);
            }
    });
    path_candidates_ = collect<CandidatePair *>(int(reachable_.size()), [&](int k, auto &kept) {
        if (may_impact(*reachable_[k])) kept.push_back(reachable_[k]);
    });
    impact_candidates_ = cull_straight([](const CandidatePair &) { return true; });
    add_transient_candidates();
}

void PairCache::update_move(const Move &move, View<unsigned char> changed) {
    if (!deferred_.empty()) {
        std::vector<unsigned char> all = std::move(deferred_);
        deferred_.clear();
        for (size_t v = 0; v < all.size(); ++v) all[v] |= changed[v];
        return update_move(move, all);
    }
    const MeshSubset subset(mesh_, broad_phase_.incidence(), changed);
    paths_.set_changed(subset);
    paths_.measure(move, subset, bounds_.escaped());
    boxes_.refit(move, subset.vertices);
    if (bounds_.any_escaped()) {
        std::erase_if(transient_, [&](const CandidatePair &pair) { return paths_.changed(pair); });
        merge(transient_, find_transient(changed));
    }
    impact_candidates_ = cull_straight([&](const CandidatePair &pair) { return paths_.changed(pair) && may_impact(pair); });
    add_transient_candidates();
}

template <class Filter> std::vector<CandidatePair *> PairCache::cull_straight(const Filter &filter) const {
    return collect_ranges<CandidatePair *>(int(path_candidates_.size()), [&](int begin, int end, auto &kept) {
        PairCuller<CandidatePair> culler(boxes_, Motion::straight, kept);
        for (int k = begin; k < end; ++k)
            if (CandidatePair &pair = *path_candidates_[k]; filter(pair)) culler.add(pair);
    });
}

void PairCache::add_transient_candidates() {
    const size_t cached = impact_candidates_.size();
    for (CandidatePair &pair : transient_)
        if (paths_.changed(pair)) impact_candidates_.push_back(&pair);
    std::inplace_merge(impact_candidates_.begin(), impact_candidates_.begin() + cached, impact_candidates_.end(),
                       [](const CandidatePair *a, const CandidatePair *b) { return before(*a, *b); });
}

void PairCache::commit_move(View<Vec3> start, View<Vec3> end) {
    for (auto *pairs : {&cached_, &transient_})
#pragma omp parallel for schedule(static)
        for (int k = 0; k < int(pairs->size()); ++k) {
            CandidatePair &pair = (*pairs)[k];
            if (pair.min_gap <= 0.0 || paths_.length(pair) == 0.0) continue;
            pair.min_gap -=
                with_vertices(mesh_, pair, [&](const auto &a, const auto &b) { return max_approach(a, b, start, end); });
        }
    paths_.clear();
    complete_ = true;
}

void PairCache::move_rigidly(View<Vec3> from, View<Vec3> to) {
    if (state_ == State::OneMove) clear();
    if (state_ == State::Empty) return;
    bounds_.move_rigidly(from, to);
    worn_ = true;
    broad_phase_.invalidate();
}

std::vector<ContactPair> PairCache::contact_pairs(View<Vec3> positions) {
    const auto raise = [](CandidatePair &pair, double gap) { pair.min_gap = gap; };
    const auto find = [&](size_t count, const auto &pair_of) {
        return collect_ranges<ContactPair>(int(count), [&](int begin, int end, std::vector<ContactPair> &found) {
            NarrowPhase<CandidatePair, decltype(raise)> narrow_phase(mesh_, positions, raise, found);
            for (int k = begin; k < end; ++k)
                if (CandidatePair &pair = pair_of(k); may_contact(pair)) narrow_phase.add(pair);
        });
    };
    std::vector<ContactPair> all = find(reachable_.size(), [&](int k) -> CandidatePair & { return *reachable_[k]; });
    merge(all, find(transient_.size(), [&](int k) -> CandidatePair & { return transient_[k]; }));
    return all;
}

ReachablePairs PairCache::reachable_pairs(View<unsigned char> objects) const {
    const auto consider = [&](const CandidatePair &pair, ReachablePairs &found) {
        if (may_contact(pair) && any_marked(pair, objects))
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
