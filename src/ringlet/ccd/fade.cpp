#include "ringlet/ccd/fade.h"

#include <algorithm>
#include <queue>

namespace ringlet {
namespace {

// Over cloths from vertex to vertex, what pulls hardest first.
template <class PassOn> void fade_over_cloths(const FilterScene &scene, const std::vector<Pull> &pulls, const PassOn &pass_on) {
    std::priority_queue<std::pair<double, int>> queue;
    for (int v = scene.cloths.front(); v < scene.cloths.back(); ++v)
        if (pulls[v].part > 0.0) queue.emplace(pulls[v].part, v);
    while (!queue.empty()) {
        const auto [part, v] = queue.top();
        queue.pop();
        if (part < pulls[v].part) continue; // it has been pulled harder since
        for (const int next : scene.neighbours->of(v))
            if (pass_on(v, next)) queue.emplace(pulls[next].part, next);
    }
}

} // namespace

void fade(const FilterScene &scene, View<Vec3> start, View<Vec3> end, const FadeStrain &most, View<int> strands,
          std::vector<Pull> &pulls) {
    const auto pass_on = [&](int from, int to, double strain) { // says whether `to` is pulled harder now
        if (!scene.mesh.moves[to] || pulls[from].part <= 0.0) return false;
        const double length = (start[to] - start[from]).norm(), way = (end[to] - start[to] - pulls[from].motion).norm();
        const double left = pulls[from].part - strain * length / std::max(way, 1e-30);
        if (left <= pulls[to].part) return false;
        pulls[to] = {left, pulls[from].motion};
        return true;
    };
#pragma omp parallel for schedule(static)
    for (const int s : strands) {
        for (int v = scene.offsets[s]; v + 1 < scene.offsets[s + 1]; ++v) pass_on(v, v + 1, most.strand);
        for (int v = scene.offsets[s + 1] - 1; v > scene.offsets[s]; --v) pass_on(v, v - 1, most.strand);
    }
    if (scene.cloths.size() > 1)
        fade_over_cloths(scene, pulls, [&](int from, int to) { return pass_on(from, to, most.cloth); });
}

} // namespace ringlet
