#include "ringlet/solver/scene_progress.h"

#include <algorithm>
#include <cmath>

namespace ringlet {

SceneProgress::SceneProgress(const SceneSystem &system)
    : system_(system), way_(system.vertices.parts()), left_(way_.size(), 1.0), edge_(system.vertices.strands),
      held_(way_.size(), 0) {
    const StrandModel &model = system.model;
    for (int s = 0; s < system.vertices.strands; ++s) {
        const int first = model.offsets[s], edges = model.offsets[s + 1] - first - 1;
        edge_[s] = std::accumulate(&model.rest_length[first], &model.rest_length[first] + edges, 0.0) / edges;
    }
}

void SceneProgress::moved(View<Vec3> now, View<Vec3> wanted, View<Vec3> to) {
    std::fill(way_.begin(), way_.end(), 0.0);
    std::fill(left_.begin(), left_.end(), 1.0);
    for (int v = 0; v < system_.vertices.moving_vertices(); ++v) {
        const int part = system_.vertices.part_of(v);
        const double way = (wanted[v] - now[v]).norm();
        way_[part] = std::max(way_[part], way);
        if (way > 0.0) left_[part] = std::min(left_[part], (to[v] - now[v]).norm() / way);
    }
}

void SceneProgress::cut(const std::vector<double> &step) {
    for (size_t p = 0; p < step.size(); ++p) left_[p] *= step[p];
}

void SceneProgress::judge(double tolerance) {
    constexpr double most_of_it = 0.9, far = 0.2; // of an edge: one that has yet to go so far has not settled
    for (int s = 0; s < system_.vertices.strands; ++s)
        if (system_.is_active(s))
            held_[s] = way_[s] > tolerance && (left_[s] < most_of_it || (held_[s] && way_[s] > far * edge_[s]));
}

bool SceneProgress::all_went() const {
    constexpr double rounding = 1e-9;
    return std::all_of(left_.begin(), left_.end(), [](double left) { return left > 1.0 - rounding; });
}

bool SceneProgress::is_stretched(int strand, View<Vec3> now) const {
    constexpr double tolerated = 0.03;
    const StrandModel &model = system_.model;
    for (int v = model.offsets[strand]; v + 1 < model.offsets[strand + 1]; ++v)
        if ((now[v + 1] - now[v]).norm() > (1.0 + tolerated) * model.rest_length[v]) return true;
    return false;
}

bool SceneProgress::narrow(SceneSystem &system, View<Vec3> now) {
    std::fill(system.active.begin(), system.active.end(), 0);
    bool any = false;
    for (int s = 0; s < system_.vertices.strands; ++s) {
        held_[s] = held_[s] && is_stretched(s, now);
        if (held_[s]) system.active[system_.unit_of(s)] = any = true;
    }
    for (const Contact &c : system_.contacts.contacts()) {
        const int a = system_.vertices.part_of(c.vertex[0]), b = system_.vertices.part_of(c.vertex[3]);
        if (a >= 0 && b >= 0 && (held_[a] || held_[b])) system.active[system.unit_of(a)] = system.active[system.unit_of(b)] = 1;
    }
    return any;
}

} // namespace ringlet
