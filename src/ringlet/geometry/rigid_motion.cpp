#include "ringlet/geometry/rigid_motion.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>

namespace ringlet {

RigidMotion fit_rigid_motion(const std::vector<int> &vertices, View<Vec3> start, View<Vec3> end) {
    constexpr double regularisation = 1e-9; // of the spread: makes an undetermined rotation the identity
    constexpr double rounding = 1e-13;      // of the decomposition, which breaks the symmetry of mirror images
    RigidMotion motion;
    for (const int v : vertices)
        motion.from += start[v] / double(vertices.size()), motion.to += end[v] / double(vertices.size());
    Mat3 spread = Mat3::Zero();
    double size = 0.0;
    for (const int v : vertices) {
        const Vec3 before = start[v] - motion.from, after = end[v] - motion.to;
        spread += after * before.transpose();
        size += before.squaredNorm();
    }
    if (size == 0.0) return motion;
    const Eigen::JacobiSVD<Mat3> svd(spread + regularisation * size * Mat3::Identity(),
                                     Eigen::ComputeFullU | Eigen::ComputeFullV);
    const double mirror = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
    const Mat3 rotation = svd.matrixU() * Vec3(1.0, 1.0, mirror).asDiagonal() * svd.matrixV().transpose();
    if ((rotation - Mat3::Identity()).norm() > rounding) motion.rotation = rotation;
    return motion;
}

RigidMotion fit_rigid_motion_robust(std::vector<int> vertices, View<Vec3> start, View<Vec3> end) {
    constexpr int rounds = 4;
    RigidMotion motion = fit_rigid_motion(vertices, start, end);
    for (int round = 0; round < rounds; ++round) {
        const auto residual2 = [&](int v) { return (end[v] - motion(start[v])).squaredNorm(); };
        const auto half = vertices.begin() + (vertices.size() + 1) / 2;
        std::nth_element(vertices.begin(), half, vertices.end(), [&](int v, int w) { return residual2(v) < residual2(w); });
        motion = fit_rigid_motion({vertices.begin(), half}, start, end);
    }
    return motion;
}

} // namespace ringlet
