#include "ringlet/collision/rigid_advection.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ringlet {

RigidAdvection::RigidAdvection(const CollisionMesh &mesh)
    : mesh_(mesh), least_radius_(std::numeric_limits<double>::infinity()), deviation_(mesh.moves.size()) {
    for (size_t v = 0; v < mesh.moves.size(); ++v)
        if (mesh.moves[v]) least_radius_ = std::min(least_radius_, mesh.radius[v]);
}

double RigidAdvection::kept_distance(const RigidMotion &motion) {
    return 0.5 * std::sqrt(std::max(0.0, 1.0 + motion.rotation.trace()));
}

void RigidAdvection::begin(const Move &move, const RigidMotion &motion, View<int> rigid, View<unsigned char> changed,
                           bool bounded, MotionBounds &bounds) {
    bounds.add_escaped([&](int v) {
        if (!changed[v]) return false;
        deviation_[v] = (move.end[v] - motion(move.start[v])).norm();
        const bool shares = !mesh_.moves[v] || (!rigid.empty() && rigid[v] >= 0);
        const auto largest = [&] {
            return std::min(collision::max_deviation * least_radius_, bounds.clearance(v, move.start[v]));
        };
        const bool follows = bounded && shares && deviation_[v] <= largest();
        return !follows && (bounded || mesh_.moves[v]);
    });
}

void RigidAdvection::advect(const Move &move, MotionBounds &bounds) {
    const double half_side = 1.0 / std::sqrt(3.0); // of the cube in a ball of radius 1
    const View<unsigned char> escaped = bounds.escaped();
    bounds.set_cubes(
        move.end, [&](int v) { return escaped[v] ? -1.0 : half_side * (bounds.clearance(v, move.start[v]) - deviation_[v]); });
    largest_ = 0.0;
    for (size_t v = 0; v < deviation_.size(); ++v)
        if (!escaped[v]) largest_ = std::max(largest_, deviation_[v]);
    nearly_exact_ = largest_ < collision::equal_deviation * least_radius_;
}

double RigidAdvection::deviation(const PrimitivePair &pair) const {
    const auto most = [&](const auto &primitive) {
        double most = 0.0;
        for (const int v : primitive) most = std::max(most, deviation_[v]);
        return most;
    };
    return with_vertices(mesh_, pair, [&](const auto &a, const auto &b) { return most(a) + most(b); });
}

} // namespace ringlet
