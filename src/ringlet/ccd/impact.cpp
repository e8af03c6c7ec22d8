#include "ringlet/ccd/impact.h"

#include "ringlet/ccd/time_of_impact.h"
#include "ringlet/math/collect.h"

#include <algorithm>
#include <cmath>

namespace ringlet {
namespace {

template <size_t N, size_t M>
double time_of_impact(CandidatePair &pair, const std::array<int, N> &a, const std::array<int, M> &b, View<Vec3> start,
                      View<Vec3> end) {
    const double approach = max_approach(a, b, start, end);
    if (pair.min_gap - ccd::separation_of_d_hat * pair.d_hat > approach) return no_impact;
    const ClosestPoints nearest = closest_points(start, a, b);
    pair.min_gap = std::sqrt(nearest.distance2);
    const double separation = ccd::min_separation(pair.d_hat, pair.min_gap);
    if (pair.min_gap - separation > approach) return no_impact;
    Vec3 x[4], p[4];
    for (size_t i = 0; i < 4; ++i) {
        const int v = i < N ? a[i] : b[i - N];
        x[i] = start[v];
        p[i] = end[v] - start[v];
    }
    return accd::toi<N>(x, p, separation, nearest);
}

} // namespace

double time_of_impact(const CollisionMesh &mesh, CandidatePair &pair, View<Vec3> start, View<Vec3> end) {
    return with_vertices(mesh, pair, [&](const auto &a, const auto &b) { return time_of_impact(pair, a, b, start, end); });
}

std::vector<Impact> find_impacts(const CollisionMesh &mesh, const std::vector<CandidatePair *> &pairs, View<Vec3> start,
                                 View<Vec3> end) {
    return collect<Impact>(int(pairs.size()), [&](int k, std::vector<Impact> &impacts) {
        with_vertices(mesh, *pairs[k], [&](const auto &a, const auto &b) {
            const double toi = time_of_impact(*pairs[k], a, b, start, end);
            if (toi > 1.0) return;
            impacts.push_back({{}, toi, pairs[k]->min_gap < ccd::separation_of_d_hat * pairs[k]->d_hat});
            std::copy(b.begin(), b.end(), std::copy(a.begin(), a.end(), impacts.back().vertices.begin()));
        });
    });
}

void mark_vertices(const CollisionMesh &mesh, const std::vector<Impact> &impacts, std::vector<unsigned char> &marked) {
    for (const Impact &impact : impacts)
        for (const int v : impact.vertices) marked[v] = mesh.moves[v];
}

double truncate_before_first(const std::vector<Impact> &impacts, View<Vec3> start, std::vector<Vec3> &end) {
    double fraction = 1.0;
    for (const Impact &impact : impacts) fraction = std::min(fraction, ccd::before_first_impact * impact.toi);
    for (size_t v = 0; v < end.size(); ++v) end[v] = start[v] + fraction * (end[v] - start[v]);
    return fraction;
}

} // namespace ringlet
