#include "ringlet/ccd/spread_correction.h"

#include <algorithm>
#include <queue>

namespace ringlet {

// Visits vertices by decreasing weight, as Dijkstra's algorithm does.
void spread_correction(const Candidates &candidates, View<Vec3> start, View<Vec3> end, double max_strain,
                       std::vector<Correction> &corrections) {
    const CollisionMesh &mesh = candidates.mesh();
    std::priority_queue<std::pair<double, int>> queue;
    for (int v = 0; v < int(corrections.size()); ++v)
        if (corrections[v].weight > 0.0) queue.emplace(corrections[v].weight, v);
    while (!queue.empty()) {
        const auto [weight, v] = queue.top();
        queue.pop();
        const Correction source = corrections[v];
        if (weight < source.weight) continue; // superseded by a larger weight
        for (const int e : candidates.incidence().edges.of(v)) {
            const int next = mesh.edges[e][mesh.edges[e][0] == v];
            if (!mesh.moves[next]) continue;
            const double length = (start[next] - start[v]).norm(), change = (end[next] - start[next] - source.motion).norm();
            const double left = weight - max_strain * length / std::max(change, 1e-30);
            if (left <= corrections[next].weight) continue;
            corrections[next] = {left, source.motion};
            queue.emplace(left, next);
        }
    }
}

} // namespace ringlet
