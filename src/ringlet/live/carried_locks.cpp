#include "ringlet/live/carried_locks.h"

#include <stdexcept>

namespace ringlet {

CarriedLocks::CarriedLocks(View<Vec3> points, View<int> vertex, View<double> weight, CurveView rods, View<Vec3> axes)
    : points_(points.begin(), points.end()), rods_(rods.points.begin(), rods.points.end()), axes_(axes.begin(), axes.end()),
      vertex_(vertex.begin(), vertex.end()), offsets_(rods.offsets.begin(), rods.offsets.end()),
      weight_(weight.begin(), weight.end()) {
    if (vertex_.size() != points_.size() || weight_.size() != points_.size() || int(axes_.size()) != rods.count())
        throw std::invalid_argument("carried locks: arrays do not fit one another");
    for (const int v : vertex_)
        if (v < 0 || v + 1 >= int(rods_.size())) throw std::invalid_argument("carried locks: there is no such vertex");
    frames(View<Vec3>(rods_), Mat3::Identity(), frames_);
}

void CarriedLocks::frames(View<Vec3> rods, const Mat3 &turn, std::vector<Mat3> &frames) const {
    if (rods.size() != rods_.size()) throw std::invalid_argument("carried locks: the rods have other vertices");
    frames.resize(rods.size());
    std::vector<Vec3> tangent(rods.size()), across(rods.size());
    const CurveView curves{rods, View<int>(offsets_)};
    for (int i = 0; i < curves.count(); ++i) {
        const size_t begin = offsets_[i], count = curves[i].size();
        const std::span<Vec3> t = std::span(tangent).subspan(begin, count), a = std::span(across).subspan(begin, count);
        tangents(curves[i], t);
        transport(curves[i], t, turn * axes_[i], a);
        for (size_t k = 0; k < count; ++k) frames[begin + k] << a[k], t[k].cross(a[k]), t[k];
    }
}

std::vector<VertexMotion> CarriedLocks::motions(View<Vec3> rods, const Mat3 &turn) const {
    std::vector<Mat3> now;
    frames(rods, turn, now);
    std::vector<VertexMotion> motions(rods.size());
    for (size_t v = 0; v < rods.size(); ++v) {
        motions[v].rotation = now[v] * frames_[v].transpose();
        motions[v].shift = rods[v] - motions[v].rotation * rods_[v];
    }
    return motions;
}

void CarriedLocks::carry(View<VertexMotion> motions, std::span<Vec3> result) const {
    for (size_t i = 0; i < points_.size(); ++i) {
        const VertexMotion &a = motions[vertex_[i]], &b = motions[vertex_[i] + 1];
        const double w = weight_[i];
        result[i] = (1 - w) * (a.rotation * points_[i] + a.shift) + w * (b.rotation * points_[i] + b.shift);
    }
}

} // namespace ringlet
