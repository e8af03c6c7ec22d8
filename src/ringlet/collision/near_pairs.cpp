#include "ringlet/collision/near_pairs.h"

#include "ringlet/collision/collect.h"

#include <limits>

namespace ringlet {
namespace {

// Of some pairs, in order, those that may touch wherever in the triangles of their ways they are, or may meet while all go
// straight together. Edges are looked at many at a time.
class MayTouch {
public:
    MayTouch(const PathBoxes &ways, bool together, std::vector<NearPair *> &found)
        : ways_(ways), together_(together), found_(found) {}
    ~MayTouch() { look_at_edges(); }

    void look_at(NearPair &pair) {
        if (!pair.of_edges) {
            look_at_edges();
            if (ways_.with_boxes(pair, together_ ? may_meet : ways_overlap)) found_.push_back(&pair);
            return;
        }
        pairs_[count_++] = &pair;
        if (count_ == EdgeWays::room) look_at_edges();
    }

private:
    void look_at_edges() {
        if (count_ == 0) return;
        ways_.put(edges_, count_, [&](int k) { return pairs_[k]->of; });
        // Two meet at half their distance, and who asks when they do takes care not to be late.
        const double part = together_ ? 0.6 : 1.0;
        for (int k = 0; k < count_; ++k) edges_.reach[k] = float(part * pairs_[k]->distance) + ways_.lost();
        const unsigned apart = together_ ? RINGLET_DISPATCH(apart_together, edges_) : RINGLET_DISPATCH(apart_anywhere, edges_);
        for (int k = 0; k < count_; ++k)
            if (!(apart >> k & 1u)) found_.push_back(pairs_[k]);
        count_ = 0;
    }

    const PathBoxes &ways_;
    bool together_;
    std::vector<NearPair *> &found_;
    EdgeWays edges_ = {};
    std::array<NearPair *, EdgeWays::room> pairs_;
    int count_ = 0; // of edges, not looked at yet
};

} // namespace

NearPairs::NearPairs(const CollisionMesh &mesh)
    : mesh_(mesh), all_(mesh), broad_phase_(mesh), ways_of_(mesh), homes_(mesh), vertices_(mesh.moves.size()),
      edges_(mesh.edges.size()), triangles_(mesh.triangles.size()), quick_(mesh.moves.size()), changed_(mesh.moves.size()),
      changed_edges_(mesh.edges.size()), changed_triangles_(mesh.triangles.size()),
      least_radius_(std::numeric_limits<double>::infinity()) {
    for (size_t v = 0; v < mesh.moves.size(); ++v)
        if (mesh.moves[v]) least_radius_ = std::min(least_radius_, mesh.radius[v]);
}

bool NearPairs::any_of(const NearPair &pair, View<unsigned char> vertices) const {
    return with_vertices(mesh_, pair, [&](const auto &a, const auto &b) {
        return ringlet::any_of(vertices, a) || ringlet::any_of(vertices, b);
    });
}

// With the distances at which they touch.
std::vector<NearPair> NearPairs::pairs_of(const Candidates &found) const {
    const int edges = int(found.edge_edge.size()), all = edges + int(found.point_triangle.size());
    std::vector<NearPair> pairs(all);
#pragma omp parallel for schedule(static)
    for (int k = 0; k < all; ++k) {
        NearPair &pair = pairs[k] = {k < edges ? found.edge_edge[k] : found.point_triangle[k - edges], k < edges, 0.0, 0.0, {}};
        with_vertices(mesh_, pair, [&](const auto &a, const auto &b) {
            pair.distance = contact_distance(mesh_, a, b);
            pair.objects = {mesh_.object[a[0]], mesh_.object[b[0]]};
        });
    }
    return pairs;
}

std::vector<NearPair> NearPairs::look_for_quick(View<unsigned char> changed) {
    Candidates found;
    if (low_.empty())
        broad_phase_.find(ways_of_, found, changed);
    else
        broad_phase_.find_quick(ways_of_, homes_, quick_, changed, found);
    return pairs_of(found);
}

void NearPairs::forget() {
    knows_all_here_ = false;
    known_.clear();
    noted_ = Noted::some;
    low_.clear(), high_.clear();
    may_touch_.clear(), may_come_near_.clear();
}

void NearPairs::note(View<Vec3> start, View<Vec3> end, double margin, double far, View<Vec3> via, bool lasts) {
    const bool anew = low_.empty(), have_left = knows_all_here_; // as one: all boxes are still where they were
    knows_all_here_ = false;
    low_.resize(start.size()), high_.resize(start.size());
    const auto places = [&](size_t v) -> std::array<Vec3, 3> {
        const Vec3 &other = via.empty() ? end[v] : via[v];
        const bool goes_far = std::max((end[v] - start[v]).squaredNorm(), (other - start[v]).squaredNorm()) > far * far;
        if (goes_far) return {start[v], start[v], start[v]};
        return {start[v], end[v], other};
    };
    const auto fit = [&](size_t v, double margin) {
        const auto [at, to, or_to] = places(v);
        low_[v] = at.cwiseMin(to).cwiseMin(or_to).array() - margin;
        high_[v] = at.cwiseMax(to).cwiseMax(or_to).array() + margin;
    };
    const double missing = noted_ == Noted::this_move ? margin : 0.0; // of the corridors there are
    std::vector<unsigned char> stray(start.size(), 0);
    std::vector<int> strays;
    for (size_t v = 0; v < start.size(); ++v) {
        const std::array<Vec3, 3> way = places(v);
        stray[v] = anew || std::any_of(way.begin(), way.end(), [&](const Vec3 &to) { return leaves(int(v), to, missing); });
        if (stray[v]) strays.push_back(int(v));
    }
    if (strays.empty() && noted_ != Noted::this_move) {
        noted_ = Noted::some;
        return;
    }
    passing_.clear();
    for (auto *ways : {&vertices_, &edges_, &triangles_}) std::fill(ways->begin(), ways->end(), Way{});
    Candidates found;
    const bool most = anew || 2 * strays.size() > start.size(); // for them it takes no longer to look for all
    if (most && noted_ != Noted::some && !lasts)
        noted_ = Noted::this_move;
    else
        noted_ = most || have_left || noted_ == Noted::this_move ? Noted::all : Noted::some;
    if (noted_ != Noted::some) {
        const bool for_one_move = noted_ == Noted::this_move;
        for (size_t v = 0; v < start.size(); ++v) fit(v, for_one_move ? 0.0 : margin);
        homes_.fit_within(low_, high_);
        if (for_one_move) fit_ways(start, end, via);
        broad_phase_.find(homes_, found, {}, for_one_move ? &ways_of_ : nullptr);
        known_ = pairs_of(found);
    } else {
        for (const int v : strays) fit(v, margin);
        homes_.fit_anew(low_, high_, strays);
        broad_phase_.find_quick(homes_, homes_, stray, stray, found);
        std::erase_if(known_, [&](const NearPair &pair) { return any_of(pair, stray); });
        merge(known_, pairs_of(found));
    }
    may_touch_.clear();
    for (NearPair &pair : known_) may_touch_.push_back(&pair);
}

void NearPairs::fit_ways(View<Vec3> start, View<Vec3> end, View<Vec3> via) {
    if (!low_.empty())
        ways_of_.fit(start, end, homes_.origin(), 0.0, via);
    else if (!start.empty())
        ways_of_.fit(start, end, {start[0], end[0]}, 0.0, via);
}

// Of what has changed.
void NearPairs::measure_ways(View<Vec3> start, View<Vec3> end, const Affected &changed, View<Vec3> via) {
#pragma omp parallel for schedule(static)
    for (int k = 0; k < int(changed.vertices.size()); ++k) {
        const int v = changed.vertices[k];
        double far = (end[v] - start[v]).squaredNorm();
        if (!via.empty()) far = std::max(far, (via[v] - start[v]).squaredNorm());
        const float way = float(std::sqrt(far));
        vertices_[v] = {way + way * std::numeric_limits<float>::epsilon(), quick_[v] != 0};
    }
    const auto of_primitives = [&](const std::vector<int> &numbers, const auto &primitives, std::vector<Way> &ways) {
#pragma omp parallel for schedule(static)
        for (int k = 0; k < int(numbers.size()); ++k) {
            Way way;
            for (const int v : primitives[numbers[k]]) {
                way.length = std::max(way.length, vertices_[v].length);
                way.quick |= vertices_[v].quick;
            }
            ways[numbers[k]] = way;
        }
    };
    of_primitives(changed.edges, mesh_.edges, edges_);
    of_primitives(changed.triangles, mesh_.triangles, triangles_);
}

void NearPairs::mark_changed(const Affected &changed) {
    const auto mark = [](const std::vector<int> &numbers, std::vector<unsigned char> &all) {
        std::fill(all.begin(), all.end(), 0);
        for (const int i : numbers) all[i] = 1;
    };
    mark(changed.vertices, changed_), mark(changed.edges, changed_edges_), mark(changed.triangles, changed_triangles_);
}

void NearPairs::set_out(View<Vec3> start, View<Vec3> end, View<Vec3> via) {
    knows_all_here_ = false;
    bool any_quick = false;
    const bool nothing_known = low_.empty();
#pragma omp parallel for schedule(static) reduction(|| : any_quick)
    for (int v = 0; v < int(start.size()); ++v) {
        quick_[v] =
            nothing_known ? mesh_.moves[v] : leaves(v, start[v]) || leaves(v, end[v]) || (!via.empty() && leaves(v, via[v]));
        any_quick = any_quick || quick_[v];
    }
    any_quick_ = any_quick;
    mark_changed(all_);
    measure_ways(start, end, all_, via);
    fit_ways(start, end, via);
    passing_ = any_quick_ ? look_for_quick(quick_) : std::vector<NearPair>();
    may_touch_ = collect_parts<NearPair *>(int(known_.size()), [&](int begin, int end, std::vector<NearPair *> &found) {
        MayTouch some(ways_of_, false, found);
        for (int k = begin; k < end; ++k)
            if (NearPair &pair = known_[k]; !quick(pair) && reach(pair)) {
                const bool looked_at = noted_ == Noted::this_move && pair.of_edges; // as it was found
                looked_at ? found.push_back(&pair) : some.look_at(pair);
            }
    });
    may_come_near_ = collect<NearPair *>(int(may_touch_.size()), [&](int k, std::vector<NearPair *> &may_come_near) {
        if (comes_near(*may_touch_[k])) may_come_near.push_back(may_touch_[k]);
    });
    may_meet_ = find_may_meet([](const NearPair &) { return true; });
    meet_passing();
}

void NearPairs::set_out_anew(View<Vec3> start, View<Vec3> end, View<unsigned char> changed, View<Vec3> via) {
    const Affected some(mesh_, broad_phase_.incidence(), changed);
    mark_changed(some);
    measure_ways(start, end, some, via);
    ways_of_.fit_anew(start, end, some.vertices, via);
    if (any_quick_) {
        std::erase_if(passing_, [&](const NearPair &pair) { return has_changed(pair); });
        merge(passing_, look_for_quick(changed));
    }
    may_meet_ = find_may_meet([&](const NearPair &pair) { return has_changed(pair) && comes_near(pair); });
    meet_passing();
}

// Of what may come near.
template <class Counts> std::vector<NearPair *> NearPairs::find_may_meet(const Counts &counts) const {
    return collect_parts<NearPair *>(int(may_come_near_.size()), [&](int begin, int end, std::vector<NearPair *> &found) {
        MayTouch some(ways_of_, true, found);
        for (int k = begin; k < end; ++k)
            if (NearPair &pair = *may_come_near_[k]; counts(pair)) some.look_at(pair);
    });
}

// All of them that have changed, among those that may meet, in order.
void NearPairs::meet_passing() {
    const size_t known = may_meet_.size();
    for (NearPair &pair : passing_)
        if (has_changed(pair)) may_meet_.push_back(&pair);
    std::inplace_merge(may_meet_.begin(), may_meet_.begin() + known, may_meet_.end(),
                       [](const NearPair *a, const NearPair *b) { return before(*a, *b); });
}

void NearPairs::arrive(View<Vec3> start, View<Vec3> end) {
    for (auto *pairs : {&known_, &passing_})
#pragma omp parallel for schedule(static)
        for (int k = 0; k < int(pairs->size()); ++k) {
            NearPair &pair = (*pairs)[k];
            if (pair.apart <= 0.0 || way(pair) == 0.0) continue;
            pair.apart -=
                with_vertices(mesh_, pair, [&](const auto &a, const auto &b) { return most_nearer(a, b, start, end); });
        }
    for (auto *ways : {&vertices_, &edges_, &triangles_})
        for (Way &way : *ways) way.length = 0.0f;
}

PairsInReach NearPairs::in_reach(View<unsigned char> objects) const {
    const auto look_at = [&](const NearPair &pair, PairsInReach &found) {
        if (reach(pair) && either_counts(pair, objects))
            found.push_back({pair.of,
                             pair.of_edges,
                             pair.objects,
                             pair.distance,
                             pair.apart - pair.distance,
                             {first(pair).length, second(pair).length}});
    };
    PairsInReach all =
        collect<PairInReach>(int(may_touch_.size()), [&](int k, PairsInReach &found) { look_at(*may_touch_[k], found); });
    PairsInReach passing;
    for (const NearPair &pair : passing_) look_at(pair, passing);
    merge(all, passing);
    return all;
}

std::vector<Touch> NearPairs::touching(View<Vec3> positions) {
    const auto note = [](const NearPair &pair, double apart) { pair.apart = apart; };
    const auto touching = [&](size_t count, const auto &pair_of) {
        return collect_parts<Touch>(int(count), [&](int begin, int end, std::vector<Touch> &found) {
            Touching<NearPair, decltype(note)> some(mesh_, positions, note, found);
            for (int k = begin; k < end; ++k)
                if (const NearPair &pair = pair_of(k); reach(pair)) some.look_at(pair);
        });
    };
    std::vector<Touch> all = touching(may_touch_.size(), [&](int k) -> const NearPair & { return *may_touch_[k]; });
    merge(all, touching(passing_.size(), [&](int k) -> const NearPair & { return passing_[k]; }));
    return all;
}

} // namespace ringlet
