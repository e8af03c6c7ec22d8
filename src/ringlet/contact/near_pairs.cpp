#include "ringlet/contact/near_pairs.h"

#include "ringlet/contact/collect.h"

#include <cmath>
#include <type_traits>

namespace ringlet {
namespace {

template <class Pair> bool before(const Pair &a, const Pair &b) { return a.of_edges != b.of_edges ? a.of_edges : a.of < b.of; }

// Puts `more` among `pairs`, both in order.
template <class Pair> void merge(std::vector<Pair> &pairs, const std::vector<Pair> &more) {
    const size_t size = pairs.size();
    pairs.insert(pairs.end(), more.begin(), more.end());
    std::inplace_merge(pairs.begin(), pairs.begin() + size, pairs.end(), before<Pair>);
}

} // namespace

bool many_are_away(View<Vec3> from, View<Vec3> now, double budget) {
    constexpr size_t few = 16; // one in
    size_t away = 0;
    for (size_t v = 0; v < from.size(); ++v) away += (now[v] - from[v]).squaredNorm() > budget * budget;
    return few * away > from.size();
}

NearPairs::NearPairs(const CollisionMesh &mesh)
    : mesh_(mesh), broad_phase_(mesh), vertices_(mesh.moves.size()), edges_(mesh.edges.size()),
      triangles_(mesh.triangles.size()), quick_(mesh.moves.size()) {}

bool NearPairs::any_of(const NearPair &pair, View<unsigned char> vertices) const {
    const auto any = [&](const auto &primitive) {
        return std::any_of(primitive.begin(), primitive.end(), [&](int v) { return vertices[v] != 0; });
    };
    return with_vertices(mesh_, pair, [&](const auto &a, const auto &b) { return any(a) || any(b); });
}

// With the distances at which they touch.
std::vector<NearPair> NearPairs::pairs_of(const Candidates &found) const {
    const int edges = int(found.edge_edge.size()), all = edges + int(found.point_triangle.size());
    std::vector<NearPair> pairs(all);
#pragma omp parallel for schedule(static)
    for (int k = 0; k < all; ++k) {
        NearPair &pair = pairs[k] = {k < edges ? found.edge_edge[k] : found.point_triangle[k - edges], k < edges, 0.0, 0.0};
        pair.distance = with_vertices(mesh_, pair, [&](const auto &a, const auto &b) { return contact_distance(mesh_, a, b); });
    }
    return pairs;
}

std::vector<NearPair> NearPairs::look_for_quick(View<Vec3> start, View<Vec3> end, View<unsigned char> changed) {
    Candidates found;
    if (noted_at_.empty())
        broad_phase_.find(start, end, 0.0, found, changed);
    else
        broad_phase_.find_quick(start, end, quick_, changed, found);
    return pairs_of(found);
}

void NearPairs::note(View<Vec3> positions, double budget) {
    budget_ = budget;
    noted_at_.assign(positions.begin(), positions.end());
    passing_.clear();
    for (auto *ways : {&vertices_, &edges_, &triangles_}) std::fill(ways->begin(), ways->end(), Way{});
    Candidates candidates;
    broad_phase_.find(positions, positions, 2.0 * budget, candidates);
    const std::vector<NearPair> found = pairs_of(candidates);
    known_ = collect<NearPair>(int(found.size()), [&](int k, std::vector<NearPair> &known) {
        NearPair pair = found[k];
        pair.apart = with_vertices(
            mesh_, pair, [&](const auto &a, const auto &b) { return std::sqrt(closest_points(positions, a, b).distance2); });
        if (pair.apart < pair.distance + 2.0 * budget) known.push_back(pair);
    });
}

bool NearPairs::are_away(View<Vec3> positions) const {
    return noted_at_.empty() || many_are_away(noted_at_, positions, budget_);
}

void NearPairs::measure_ways(View<Vec3> start, View<Vec3> end) {
#pragma omp parallel for schedule(static)
    for (int v = 0; v < int(start.size()); ++v) vertices_[v] = {(end[v] - start[v]).norm(), quick_[v] != 0};
    const auto of_primitives = [&](const auto &primitives, std::vector<Way> &ways) {
#pragma omp parallel for schedule(static)
        for (int i = 0; i < int(primitives.size()); ++i) {
            ways[i] = {};
            for (const int v : primitives[i]) {
                ways[i].length = std::max(ways[i].length, vertices_[v].length);
                ways[i].quick |= vertices_[v].quick;
            }
        }
    };
    of_primitives(mesh_.edges, edges_);
    of_primitives(mesh_.triangles, triangles_);
}

void NearPairs::set_out(View<Vec3> start, View<Vec3> end) {
    bool any_quick = false;
    const bool nothing_known = noted_at_.empty();
#pragma omp parallel for schedule(static) reduction(|| : any_quick)
    for (int v = 0; v < int(start.size()); ++v) {
        const auto is_far = [&](const Vec3 &x) { return !((x - noted_at_[v]).squaredNorm() <= budget_ * budget_); };
        quick_[v] = nothing_known ? mesh_.moves[v] : is_far(start[v]) || is_far(end[v]);
        any_quick = any_quick || quick_[v];
    }
    any_quick_ = any_quick;
    measure_ways(start, end);
    passing_ = any_quick_ ? look_for_quick(start, end, quick_) : std::vector<NearPair>();
    may_meet_ = collect<NearPair *>(int(known_.size()), [&](int k, std::vector<NearPair *> &may_meet) {
        NearPair &pair = known_[k];
        if (pair.apart - way(pair) < 0.5 * pair.distance && !quick(pair)) may_meet.push_back(&pair);
    });
    for (NearPair &pair : passing_) may_meet_.push_back(&pair);
}

void NearPairs::set_out_anew(View<Vec3> start, View<Vec3> end, View<unsigned char> changed) {
    measure_ways(start, end);
    if (any_quick_) {
        std::erase_if(passing_, [&](const NearPair &pair) { return any_of(pair, changed); });
        merge(passing_, look_for_quick(start, end, changed));
    }
    may_meet_ = collect<NearPair *>(int(known_.size()), [&](int k, std::vector<NearPair *> &may_meet) {
        NearPair &pair = known_[k];
        if (pair.apart - way(pair) < 0.5 * pair.distance && !quick(pair) && any_of(pair, changed)) may_meet.push_back(&pair);
    });
    for (NearPair &pair : passing_)
        if (any_of(pair, changed)) may_meet_.push_back(&pair);
}

void NearPairs::arrive(View<Vec3> start, View<Vec3> end) {
    for (auto *pairs : {&known_, &passing_})
#pragma omp parallel for schedule(static)
        for (int k = 0; k < int(pairs->size()); ++k) {
            NearPair &pair = (*pairs)[k];
            pair.apart -=
                with_vertices(mesh_, pair, [&](const auto &a, const auto &b) { return most_nearer(a, b, start, end); });
        }
    for (auto *ways : {&vertices_, &edges_, &triangles_})
        for (Way &way : *ways) way.length = 0.0;
}

// Pairs that may be changed are noted to be as far apart as they are found to be.
template <class Pairs, class Counts>
std::vector<Touch> NearPairs::touching(Pairs &known, Pairs &passing, const NearPairs &near, View<Vec3> at,
                                       const Counts &counts) {
    const auto among = [&](Pairs &pairs, bool are_known) {
        return collect<Touch>(int(pairs.size()), [&](int k, std::vector<Touch> &touching) {
            auto &pair = pairs[k];
            if (!(pair.apart - near.way(pair) < pair.distance) || (are_known && near.quick(pair)) || !counts(pair)) return;
            const ClosestPoints nearest =
                with_vertices(near.mesh_, pair, [&](const auto &a, const auto &b) { return closest_points(at, a, b); });
            const double apart = std::sqrt(nearest.distance2);
            if constexpr (!std::is_const_v<Pairs>) pair.apart = apart;
            if (apart < pair.distance) touching.push_back({pair.of, pair.of_edges, pair.distance, nearest});
        });
    };
    std::vector<Touch> all = among(known, true);
    merge(all, among(passing, false));
    return all;
}

std::vector<Touch> NearPairs::touching(View<Vec3> positions) {
    return touching(known_, passing_, *this, positions, [](const NearPair &) { return true; });
}

std::vector<Touch> NearPairs::would_touch(View<Vec3> on_the_way, View<unsigned char> objects) const {
    return touching(known_, passing_, *this, on_the_way, [&](const NearPair &pair) {
        const auto counts = [&](int v) {
            const auto object = size_t(mesh_.object[v]);
            return object < objects.size() && objects[object] != 0;
        };
        return with_vertices(mesh_, pair, [&](const auto &a, const auto &b) { return counts(a[0]) || counts(b[0]); });
    });
}

} // namespace ringlet
