#include "ringlet/scene/scene_carry.h"

#include "ringlet/geometry/rigid_motion.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

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

std::vector<int> kinematic(const SceneCarry &carry, int begin, int end) {
    std::vector<int> told;
    for (int v = begin; v < end; ++v)
        if (!carry.all.mesh.moves[v]) told.push_back(v);
    return told;
}

struct Patch {
    std::vector<int> vertices;
    RigidMotion motion; // from their middle
};

// Of all bodies, first one each: further ones begin where it is farthest to the next of the same body, of vertices enough to
// tell how they turn.
std::vector<Patch> patches(const SceneCarry &carry) {
    constexpr size_t most = 96, vertices_of_each = 16;
    const int first = carry.all.bodies.front(), count = carry.all.count() - first;
    std::vector<double> far2(count, std::numeric_limits<double>::infinity());
    std::vector<int> nearest(count, -1);
    std::vector<size_t> begun(carry.all.bodies.size() - 1, 0);
    std::vector<Patch> all;
    while (count > 0 && all.size() < most) {
        const int seed = first + int(std::max_element(far2.begin(), far2.end()) - far2.begin());
        if (far2[seed - first] == 0.0) break;
        const int body =
            int(std::upper_bound(carry.all.bodies.begin(), carry.all.bodies.end(), seed) - carry.all.bodies.begin()) - 1;
        const int begin = carry.all.bodies[body], end = carry.all.bodies[body + 1];
        for (int v = begin; v < end; ++v) {
            const double away2 = (carry.start[v] - carry.start[seed]).squaredNorm();
            if (away2 < far2[v - first]) far2[v - first] = away2, nearest[v - first] = int(all.size());
        }
        if (++begun[body] * vertices_of_each >= size_t(end - begin)) // it has enough
            std::fill(far2.begin() + (begin - first), far2.begin() + (end - first), 0.0);
        all.emplace_back();
    }
    for (int v = 0; v < count; ++v)
        if (nearest[v] >= 0) all[nearest[v]].vertices.push_back(first + v);
    std::erase_if(all, [](const Patch &patch) { return patch.vertices.empty(); });
    for (Patch &patch : all) patch.motion = mean_motion(patch.vertices, carry.start, carry.given);
    return all;
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
        const int alone = held_follow(carry, begin, end, begin) ? int(leaders.size()) + s : -1;
        go(begin, end, body >= 0 ? body : alone, [&](const Vec3 &point) { return carry.carried(leader, point); });
    }
    for (int c = 0; c + 1 < int(all.cloths.size()); ++c) {
        const int begin = all.cloths[c], end = all.cloths[c + 1], body = carriers.of_cloths[c];
        if (with_body(body, begin, end)) {
            go(begin, end, body, [&](const Vec3 &point) { return carry.carried(leaders[body], point); });
            continue;
        }
        if (const std::vector<int> held = kinematic(carry, begin, end); !held.empty()) {
            go(begin, end, -1, mean_motion(held, carry.start, carry.given));
            continue;
        }
        RigidMotion motion;
        motion.to = carriers.drift;
        if (const std::vector<int> told = kinematic(carry, 0, all.count()); !told.empty())
            motion = mean_motion(told, carry.start, carry.given);
        motion.turn = Mat3::Identity(); // that of others would carry it off
        go(begin, end, -1, motion);
    }
    return rigid;
}

void carry_with_space(const SceneCarry &carry, std::vector<Vec3> &to) {
    const std::vector<Patch> all = patches(carry);
    if (all.empty()) return;
#pragma omp parallel for schedule(static)
    for (int v = 0; v < carry.all.moving_vertices(); ++v) {
        if (!carry.all.mesh.moves[v]) continue;
        Vec3 sum = Vec3::Zero();
        double weights = 0.0;
        for (const Patch &patch : all) {
            const double away2 = (carry.start[v] - patch.motion.from).squaredNorm() + 1e-12,
                         weight = 1.0 / (away2 * away2 * away2);
            sum += weight * (patch.motion(carry.start[v]) - carry.start[v]);
            weights += weight;
        }
        to[v] = carry.start[v] + sum / weights;
    }
}

} // namespace ringlet
