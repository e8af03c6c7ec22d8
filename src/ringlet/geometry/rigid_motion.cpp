#include "ringlet/geometry/rigid_motion.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>

namespace ringlet {

RigidMotion mean_motion(const std::vector<int> &told, View<Vec3> start, View<Vec3> end) {
    constexpr double hardly = 1e-9;
    RigidMotion motion;
    for (const int v : told) motion.from += start[v] / double(told.size()), motion.to += end[v] / double(told.size());
    Mat3 spread = Mat3::Zero();
    double size = 0.0;
    for (const int v : told) {
        const Vec3 before = start[v] - motion.from, after = end[v] - motion.to;
        spread += after * before.transpose();
        size += before.squaredNorm();
    }
    if (size == 0.0) return motion;
    const Eigen::JacobiSVD<Mat3> svd(spread + hardly * size * Mat3::Identity(), Eigen::ComputeFullU | Eigen::ComputeFullV);
    const double mirror = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
    motion.turn = svd.matrixU() * Vec3(1.0, 1.0, mirror).asDiagonal() * svd.matrixV().transpose();
    return motion;
}

RigidMotion common_motion(std::vector<int> told, View<Vec3> start, View<Vec3> end) {
    constexpr int rounds = 4;
    RigidMotion motion = mean_motion(told, start, end);
    for (int round = 0; round < rounds; ++round) {
        const auto strays = [&](int v) { return (end[v] - motion(start[v])).squaredNorm(); };
        const auto half = told.begin() + (told.size() + 1) / 2;
        std::nth_element(told.begin(), half, told.end(), [&](int v, int w) { return strays(v) < strays(w); });
        motion = mean_motion({told.begin(), half}, start, end);
    }
    return motion;
}

} // namespace ringlet
