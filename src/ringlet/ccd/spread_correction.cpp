#include "ringlet/ccd/spread_correction.h"

#include <algorithm>
#include <queue>

namespace ringlet {
namespace {

// Visits vertices of cloths by decreasing weight, as Dijkstra's algorithm does.
template <class Spread>
void spread_over_cloths(const ConnectedMesh &connected, const std::vector<Correction> &corrections, const Spread &spread) {
    std::priority_queue<std::pair<double, int>> queue;
    for (int v = connected.cloths.front(); v < connected.cloths.back(); ++v)
        if (corrections[v].weight > 0.0) queue.emplace(corrections[v].weight, v);
    while (!queue.empty()) {
        const auto [weight, v] = queue.top();
        queue.pop();
        if (weight < corrections[v].weight) continue; // superseded by a larger weight
        for (const int next : connected.cloth_neighbours->of(v))
            if (spread(v, next)) queue.emplace(corrections[next].weight, next);
    }
}

} // namespace

void spread_correction(const ConnectedMesh &connected, View<Vec3> start, View<Vec3> end, const StrainLimit &limit,
                       View<int> strands, std::vector<Correction> &corrections) {
    const auto spread = [&](int from, int to, double strain) { // returns whether the weight at `to` grows
        const Correction &source = corrections[from];
        if (!connected.mesh.moves[to] || source.weight <= 0.0) return false;
        const double length = (start[to] - start[from]).norm(), change = (end[to] - start[to] - source.motion).norm();
        const double weight = source.weight - strain * length / std::max(change, 1e-30);
        if (weight <= corrections[to].weight) return false;
        corrections[to] = {weight, source.motion};
        return true;
    };
    const View<int> offsets = connected.strands;
#pragma omp parallel for schedule(static)
    for (const int s : strands) {
        for (int v = offsets[s]; v + 1 < offsets[s + 1]; ++v) spread(v, v + 1, limit.strand);
        for (int v = offsets[s + 1] - 1; v > offsets[s]; --v) spread(v, v - 1, limit.strand);
    }
    if (connected.cloths.size() > 1)
        spread_over_cloths(connected, corrections, [&](int from, int to) { return spread(from, to, limit.cloth); });
}

} // namespace ringlet
