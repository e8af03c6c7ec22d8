#include "ringlet/collision/motion_bounds.h"

#include "ringlet/math/collect.h"
#include "ringlet/math/parallel.h"

#include <algorithm>

namespace ringlet {
namespace {

// The corners of the section of a vertex's path that its bound encloses.
std::array<Vec3, 3> enclosed(const Move &move, double max_path, int v) {
    const Vec3 &start = move.start[v], &end = move.end[v], &apex = move.apex.empty() ? end : move.apex[v];
    const bool is_long = std::max((end - start).squaredNorm(), (apex - start).squaredNorm()) > max_path * max_path;
    if (is_long) return {start, start, start};
    return {start, end, apex};
}

} // namespace

std::vector<int> MotionBounds::outside(const Move &move, double max_path, double slack) const {
    return collect<int>(int(move.start.size()), [&](int v, std::vector<int> &vertices) {
        const std::array<Vec3, 3> corners = enclosed(move, max_path, v);
        if (std::any_of(corners.begin(), corners.end(), [&](const Vec3 &x) { return leaves(v, x, slack); }))
            vertices.push_back(v);
    });
}

void MotionBounds::fit_vertex(const Move &move, const Fit &how, int v) {
    const auto [a, b, c] = enclosed(move, how.max_path, v);
    low_[v] = a.cwiseMin(b).cwiseMin(c).array() - how.margin;
    high_[v] = a.cwiseMax(b).cwiseMax(c).array() + how.margin;
}

void MotionBounds::fit(const Move &move, const Fit &how) {
    low_.resize(move.start.size()), high_.resize(move.start.size());
    parallel_for(int(low_.size()), [&](int v) { fit_vertex(move, how, v); });
    boxes_.fit_static(low_, high_);
}

void MotionBounds::fit(const Move &move, const Fit &how, const std::vector<int> &vertices) {
    parallel_for(int(vertices.size()), [&](int k) { fit_vertex(move, how, vertices[k]); });
    boxes_.refit({low_, high_}, vertices);
}

std::vector<unsigned char> MotionBounds::escaped(const Move &move) const {
    std::vector<unsigned char> escaped(move.start.size());
    parallel_for(int(escaped.size()), [&](int v) {
        escaped[v] = leaves(v, move.start[v]) || leaves(v, move.end[v]) || (!move.apex.empty() && leaves(v, move.apex[v]));
    });
    return escaped;
}

void MotionBounds::move_rigidly(const RigidMotion &motion, View<Vec3> from) {
    const Vec3 turned = (motion.rotation.transpose() - Mat3::Identity()).cwiseAbs().rowwise().sum();
    parallel_for(int(from.size()), [&](int v) {
        const Vec3 below = from[v] - low_[v], above = high_[v] - from[v], to = motion(from[v]);
        const Vec3 lost = turned * below.cwiseMax(above).maxCoeff();
        low_[v] = to - below + lost;
        high_[v] = to + above - lost;
    });
    boxes_.fit_static(low_, high_);
}

} // namespace ringlet
