#include "ringlet/ccd/meeting.h"

#include "ringlet/ccd/impact.h"
#include "ringlet/collision/collect.h"

#include <algorithm>
#include <cmath>

namespace ringlet {
namespace {

template <size_t N, size_t M> bool move_as_one(View<int> rigid, const std::array<int, N> &a, const std::array<int, M> &b) {
    bool same = rigid[a[0]] >= 0;
    for (const int v : a) same &= rigid[v] == rigid[a[0]];
    for (const int v : b) same &= rigid[v] == rigid[a[0]];
    return same;
}

template <size_t N, size_t M>
double impact_time(const NearPair &pair, const std::array<int, N> &a, const std::array<int, M> &b, View<Vec3> start,
                   View<Vec3> end) {
    const double nearer = most_nearer(a, b, start, end);
    if (pair.apart - 0.5 * pair.distance > nearer) return no_impact;
    const ClosestPoints nearest = closest_points(start, a, b);
    pair.apart = std::sqrt(nearest.distance2);
    const double kept = std::min({0.5 * pair.distance, std::max(0.2 * pair.apart, pair.distance / 250), 0.9 * pair.apart});
    if (pair.apart - kept > nearer) return no_impact;
    Vec3 x[4], p[4];
    for (size_t i = 0; i < 4; ++i) {
        const int v = i < N ? a[i] : b[i - N];
        x[i] = start[v];
        p[i] = end[v] - start[v];
    }
    return impact::time<N>(x, p, kept, nearest);
}

} // namespace

double meeting_time(const CollisionMesh &mesh, const NearPair &pair, View<Vec3> start, View<Vec3> end) {
    return with_vertices(mesh, pair, [&](const auto &a, const auto &b) { return impact_time(pair, a, b, start, end); });
}

std::vector<Met> find_met(const FilterScene &scene, const NearPairs &near, View<Vec3> start, View<Vec3> end) {
    const std::vector<NearPair *> &pairs = near.may_meet();
    return collect<Met>(int(pairs.size()), [&](int k, std::vector<Met> &met) {
        with_vertices(scene.mesh, *pairs[k], [&](const auto &a, const auto &b) {
            if (!scene.rigid.empty() && move_as_one(scene.rigid, a, b)) return;
            const double time = impact_time(*pairs[k], a, b, start, end);
            if (time > 1.0) return;
            met.push_back({{}, time});
            std::copy(b.begin(), b.end(), std::copy(a.begin(), a.end(), met.back().vertices.begin()));
        });
    });
}

} // namespace ringlet
