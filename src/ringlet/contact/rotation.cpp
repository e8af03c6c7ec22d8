#include "ringlet/contact/rotation.h"

#include <Eigen/Geometry>

namespace ringlet {
namespace {

// An orthonormal frame with its first axis along u and its second across u and v; 0 where they are parallel.
Mat3 frame(const Vec3 &u, const Vec3 &v) {
    Mat3 axes;
    axes.col(0) = u.normalized();
    axes.col(1) = u.cross(v).normalized();
    axes.col(2) = axes.col(0).cross(axes.col(1));
    return axes;
}

} // namespace

Mat3 pair_rotation(const Stencil &pair, View<Vec3> start, View<Vec3> end) {
    const int p = pair.vertex[0], q = pair.vertex[1], r = pair.vertex[2], s = pair.vertex[3];
    const auto turned = [&](const auto &frame_of) { return Mat3(frame_of(end) * frame_of(start).transpose()); };
    if (!pair.edge_edge()) return turned([&](View<Vec3> x) { return frame(x[r] - x[q], x[s] - x[q]); });
    const auto almost_parallel = [&](View<Vec3> x) {
        const Vec3 a = x[q] - x[p], b = x[s] - x[r];
        return a.cross(b).squaredNorm() <= contact_settings::parallel_sine2 * a.squaredNorm() * b.squaredNorm();
    };
    if (almost_parallel(start) || almost_parallel(end))
        return turned([&](View<Vec3> x) { return frame(x[q] - x[p], pair.separation(x)); });
    return turned([&](View<Vec3> x) { return frame(x[q] - x[p], x[s] - x[r]); });
}

} // namespace ringlet
