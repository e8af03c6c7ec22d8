#include "ringlet/live/carried_locks.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace ringlet {
namespace {

constexpr double narrowest = 0.25; // coil that is drawn out, by its radius
constexpr double straight = 0.95;  // rise of a coil that is nearly straight: what is straighter gets no narrower

std::vector<double> lengths_about_vertices(CurveView rods) {
    std::vector<double> lengths(rods.points.size());
    for (int i = 0; i < rods.count(); ++i)
        for (int v = rods.offsets[i] + 1; v < rods.offsets[i + 1]; ++v) {
            const double half = 0.5 * (rods.points[v] - rods.points[v - 1]).norm();
            lengths[v - 1] += half;
            lengths[v] += half;
        }
    return lengths;
}

} // namespace

double narrowing(double longer, double rise) {
    const double sine = std::min(rise, straight), left = std::max(1 - longer * longer * sine * sine, 0.0);
    return std::max(std::sqrt(left / (1 - sine * sine)), narrowest);
}

CarriedLocks::CarriedLocks(View<Vec3> points, View<int> vertex, View<double> weight, CurveView rods, View<Vec3> axes,
                           View<double> rises)
    : points_(points.begin(), points.end()), rods_(rods.points.begin(), rods.points.end()), axes_(axes.begin(), axes.end()),
      vertex_(vertex.begin(), vertex.end()), offsets_(rods.offsets.begin(), rods.offsets.end()),
      weight_(weight.begin(), weight.end()), rises_(rises.begin(), rises.end()), lengths_(lengths_about_vertices(rods)) {
    if (vertex_.size() != points_.size() || weight_.size() != points_.size() || int(axes_.size()) != rods.count() ||
        int(rises_.size()) != rods.count())
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
    const CurveView curves{rods, View<int>(offsets_)};
    const std::vector<double> lengths = lengths_about_vertices(curves);
    std::vector<VertexMotion> motions(rods.size());
    for (int i = 0; i < curves.count(); ++i)
        for (int v = offsets_[i]; v < offsets_[i + 1]; ++v) {
            const double along = lengths[v] / lengths_[v], across = narrowing(along, rises_[i]);
            motions[v].linear = now[v] * Vec3(across, across, along).asDiagonal() * frames_[v].transpose();
            motions[v].shift = rods[v] - motions[v].linear * rods_[v];
        }
    return motions;
}

void CarriedLocks::carry(View<VertexMotion> motions, std::span<Vec3> result) const {
    for (size_t i = 0; i < points_.size(); ++i) {
        const VertexMotion &a = motions[vertex_[i]], &b = motions[vertex_[i] + 1];
        const double w = weight_[i];
        result[i] = (1 - w) * (a.linear * points_[i] + a.shift) + w * (b.linear * points_[i] + b.shift);
    }
}

} // namespace ringlet
