#include "ringlet/scene/scene_carry.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace ringlet {
namespace {

// The affine motion of a triangle, its unit normal included: a rigid motion where the triangle moves rigidly.
Vec3 carried_by_triangle(const Vec3 from[3], const Vec3 to[3], const Vec3 &point) {
    const auto frame = [](const Vec3 t[3]) {
        Mat3 axes;
        axes << t[1] - t[0], t[2] - t[0], (t[1] - t[0]).cross(t[2] - t[0]).normalized();
        return axes;
    };
    const Mat3 before = frame(from);
    Vec3 translated = point + to[0] - from[0];
    if (std::abs(before.determinant()) < 1e-30) return translated;
    const Vec3 carried = to[0] + frame(to) * before.inverse() * (point - from[0]);
    return carried.allFinite() ? carried : translated;
}

// Mean displacement of what is kinematic among some vertices; false where nothing is.
bool mean_motion(const SceneCarry &carry, int begin, int end, Vec3 &mean) {
    int count = 0;
    Vec3 sum = Vec3::Zero();
    for (int v = begin; v < end; ++v)
        if (!carry.all.mesh.moves[v]) sum += carry.given[v] - carry.start[v], ++count;
    if (count > 0) mean = sum / count;
    return count > 0;
}

// Whether all held vertices of a range go along with a vertex of a rigid body.
bool held_follow(const SceneCarry &carry, int begin, int end, int leader) {
    for (int v = begin; v < end; ++v)
        if (!carry.all.mesh.moves[v] && !((carry.carried(leader, carry.start[v]) - carry.given[v]).squaredNorm() < 1e-20))
            return false;
    return true;
}

} // namespace

Vec3 SceneCarry::carried(int vertex, const Vec3 &point) const {
    const Triangle &t = all.some_triangle[vertex];
    if (t[0] == t[1]) return point + given[vertex] - start[vertex];
    const Vec3 from[3] = {start[t[0]], start[t[1]], start[t[2]]}, to[3] = {given[t[0]], given[t[1]], given[t[2]]};
    return carried_by_triangle(from, to, point);
}

std::vector<int> SceneCarry::rigid_bodies() const {
    std::vector<int> leaders(all.bodies.size() - 1, -1);
    for (int b = 0; b < int(leaders.size()); ++b)
        if (all.bodies[b] < all.bodies[b + 1] && held_follow(*this, all.bodies[b], all.bodies[b + 1], all.bodies[b]))
            leaders[b] = all.bodies[b];
    return leaders;
}

std::vector<int> carry_rigidly(const SceneCarry &carry, View<int> offsets, const SceneCarriers &carriers,
                               std::vector<Vec3> &to) {
    const SceneVertices &all = carry.all;
    const std::vector<int> leaders = carry.rigid_bodies();
    std::vector<int> rigid(all.count(), -1);
    for (int b = 0; b < int(leaders.size()); ++b)
        if (leaders[b] >= 0) std::fill(rigid.begin() + all.bodies[b], rigid.begin() + all.bodies[b + 1], b);
    const auto with_body = [&](int body, int begin, int end) {
        return body >= 0 && leaders[body] >= 0 && held_follow(carry, begin, end, leaders[body]);
    };
    const auto go = [&](int begin, int end, int body, const auto &motion) {
        for (int v = begin; v < end; ++v) {
            if (all.mesh.moves[v]) to[v] = motion(carry.start[v]);
            rigid[v] = body;
        }
    };
#pragma omp parallel for schedule(static)
    for (int s = 0; s < all.strands; ++s) {
        const int begin = offsets[s], end = offsets[s + 1];
        const int wanted = s < int(carriers.of_strands.size()) ? carriers.of_strands[s] : -1;
        const int body = with_body(wanted, begin, end) ? wanted : -1, leader = body >= 0 ? leaders[body] : begin;
        go(begin, end, body, [&](const Vec3 &point) { return carry.carried(leader, point); });
    }
    for (int c = 0; c + 1 < int(all.cloths.size()); ++c) {
        const int begin = all.cloths[c], end = all.cloths[c + 1], body = carriers.of_cloths[c];
        if (with_body(body, begin, end)) {
            go(begin, end, body, [&](const Vec3 &point) { return carry.carried(leaders[body], point); });
            continue;
        }
        Vec3 mean = carriers.drift;
        if (!mean_motion(carry, begin, end, mean)) mean_motion(carry, 0, all.count(), mean);
        go(begin, end, -1, [&](const Vec3 &point) -> Vec3 { return point + mean; });
    }
    return rigid;
}

} // namespace ringlet
