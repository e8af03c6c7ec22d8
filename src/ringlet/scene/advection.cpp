#include "ringlet/scene/advection.h"

#include "ringlet/ccd/impact_zones.h"
#include "ringlet/geometry/rigid_motion.h"
#include "ringlet/scene/settings.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace ringlet {
namespace {

// The affine motion of a triangle with its unit normal, which is rigid where the triangle moves rigidly.
Vec3 carry_with_triangle(const Vec3 from[3], const Vec3 to[3], const Vec3 &point) {
    const auto frame = [](const Vec3 t[3]) {
        Mat3 axes;
        axes << t[1] - t[0], t[2] - t[0], (t[1] - t[0]).cross(t[2] - t[0]).normalized();
        return axes;
    };
    const Mat3 before = frame(from);
    Vec3 translated = point + to[0] - from[0];
    if (std::abs(before.determinant()) < 1e-30) return translated;
    const Vec3 moved = to[0] + frame(to) * before.inverse() * (point - from[0]);
    return moved.allFinite() ? moved : translated;
}

std::vector<int> prescribed(const SceneVertices &vertices, int begin, int end) {
    std::vector<int> found;
    for (int v = begin; v < end; ++v)
        if (!vertices.mesh.moves[v]) found.push_back(v);
    return found;
}

struct Patch {
    std::vector<int> vertices;
    RigidMotion motion; // from their middle
};

// Patches of all bodies: the farthest vertex from the patches of its body begins the next, while they keep vertices enough to
// determine a rotation.
std::vector<Patch> patches(const PrescribedMotion &motion) {
    const std::vector<int> &bodies = motion.vertices.bodies;
    const int first = bodies.front(), count = motion.vertices.count() - first;
    std::vector<double> distance2(count, std::numeric_limits<double>::infinity());
    std::vector<int> nearest(count, -1);
    std::vector<size_t> begun(bodies.size() - 1, 0);
    std::vector<Patch> all;
    while (count > 0 && all.size() < size_t(scene_settings::max_patches)) {
        const int seed = first + int(std::max_element(distance2.begin(), distance2.end()) - distance2.begin());
        if (distance2[seed - first] == 0.0) break;
        const int body = int(std::upper_bound(bodies.begin(), bodies.end(), seed) - bodies.begin()) - 1;
        const int begin = bodies[body], end = bodies[body + 1];
        for (int v = begin; v < end; ++v) {
            const double away2 = (motion.start[v] - motion.start[seed]).squaredNorm();
            if (away2 < distance2[v - first]) distance2[v - first] = away2, nearest[v - first] = int(all.size());
        }
        if (++begun[body] * scene_settings::vertices_of_patch >= size_t(end - begin)) // it has enough
            std::fill(distance2.begin() + (begin - first), distance2.begin() + (end - first), 0.0);
        all.emplace_back();
    }
    for (int v = 0; v < count; ++v)
        if (nearest[v] >= 0) all[nearest[v]].vertices.push_back(first + v);
    std::erase_if(all, [](const Patch &patch) { return patch.vertices.empty(); });
    for (Patch &patch : all) patch.motion = fit_rigid_motion(patch.vertices, motion.start, motion.target);
    return all;
}

// Whether the prescribed vertices of a range move along with another prescribed vertex.
bool follow(const PrescribedMotion &motion, int begin, int end, int leader) {
    for (int v = begin; v < end; ++v)
        if (!motion.vertices.mesh.moves[v] &&
            !((motion.carry(leader, motion.start[v]) - motion.target[v]).squaredNorm() < scene_settings::same_place2))
            return false;
    return true;
}

// The motion that most dynamic vertices have in common.
RigidMotion motion_of_most(const SceneVertices &vertices, View<Vec3> from, View<Vec3> to) {
    const int end = vertices.strand_vertices() > 0 ? vertices.strand_vertices() : vertices.dynamic_vertices;
    std::vector<int> sample;
    for (int v = 0; v < end; v += 1 + end / scene_settings::motion_samples) sample.push_back(v);
    return fit_rigid_motion_robust(sample, from, to);
}

} // namespace

Vec3 PrescribedMotion::carry(int vertex, const Vec3 &point) const {
    const Triangle &t = vertices.carriers[vertex];
    if (t[0] == t[1]) return point + target[vertex] - start[vertex];
    const Vec3 from[3] = {start[t[0]], start[t[1]], start[t[2]]}, to[3] = {target[t[0]], target[t[1]], target[t[2]]};
    return carry_with_triangle(from, to, point);
}

std::vector<int> PrescribedMotion::rigid_bodies() const {
    const std::vector<int> &bodies = vertices.bodies;
    std::vector<int> leaders(bodies.size() - 1, -1);
    for (int b = 0; b < int(leaders.size()); ++b)
        if (bodies[b] < bodies[b + 1] && follow(*this, bodies[b], bodies[b + 1], bodies[b])) leaders[b] = bodies[b];
    return leaders;
}

std::vector<int> advect_rigidly(const PrescribedMotion &motion, View<int> offsets, const Carriers &carriers,
                                std::vector<Vec3> &end) {
    const SceneVertices &all = motion.vertices;
    const std::vector<int> leaders = motion.rigid_bodies();
    std::vector<int> rigid(all.count(), -1);
    for (int b = 0; b < int(leaders.size()); ++b)
        if (leaders[b] >= 0) std::fill(rigid.begin() + all.bodies[b], rigid.begin() + all.bodies[b + 1], b);
    const auto follows_body = [&](int body, int first, int last) {
        return body >= 0 && leaders[body] >= 0 && follow(motion, first, last, leaders[body]);
    };
    const auto move = [&](int first, int last, int number, const auto &by) {
        for (int v = first; v < last; ++v) {
            if (all.mesh.moves[v]) end[v] = by(motion.start[v]);
            rigid[v] = number;
        }
    };
#pragma omp parallel for schedule(static)
    for (int s = 0; s < all.strands; ++s) {
        const int first = offsets[s], last = offsets[s + 1];
        const int wanted = s < int(carriers.of_strands.size()) ? carriers.of_strands[s] : -1;
        const int body = follows_body(wanted, first, last) ? wanted : -1, leader = body >= 0 ? leaders[body] : first;
        const int own = follow(motion, first, last, first) ? int(leaders.size()) + s : -1;
        move(first, last, body >= 0 ? body : own, [&](const Vec3 &point) { return motion.carry(leader, point); });
    }
    for (int c = 0; c + 1 < int(all.cloths.size()); ++c) {
        const int first = all.cloths[c], last = all.cloths[c + 1], body = carriers.of_cloths[c];
        if (follows_body(body, first, last)) {
            move(first, last, body, [&](const Vec3 &point) { return motion.carry(leaders[body], point); });
            continue;
        }
        if (const std::vector<int> own = prescribed(all, first, last); !own.empty()) {
            move(first, last, -1, fit_rigid_motion(own, motion.start, motion.target));
            continue;
        }
        RigidMotion mean;
        mean.to = carriers.drift;
        if (const std::vector<int> any = prescribed(all, 0, all.count()); !any.empty())
            mean = fit_rigid_motion(any, motion.start, motion.target);
        mean.rotation = Mat3::Identity(); // the rotation of others would throw it off
        move(first, last, -1, mean);
    }
    return rigid;
}

void advect_with_space(const PrescribedMotion &motion, std::vector<Vec3> &end) {
    const std::vector<Patch> all = patches(motion);
    if (all.empty()) return;
#pragma omp parallel for schedule(static)
    for (int v = 0; v < motion.vertices.dynamic_vertices; ++v) {
        if (!motion.vertices.mesh.moves[v]) continue;
        Vec3 sum = Vec3::Zero();
        double weights = 0.0;
        for (const Patch &patch : all) {
            const double away2 = (motion.start[v] - patch.motion.from).squaredNorm() + 1e-12,
                         weight = 1.0 / (away2 * away2 * away2);
            sum += weight * (patch.motion(motion.start[v]) - motion.start[v]);
            weights += weight;
        }
        end[v] = motion.start[v] + sum / weights;
    }
}

namespace {

// The move of an advection, limited by impact zones; returns the fraction of it that is left.
double limit_advection(const PrescribedMotion &motion, View<int> rigid, const RigidMotion &most, int hopeful_rounds,
                       Configuration &configuration, std::vector<Vec3> &end, SceneReport &report) {
    const Stopwatch watch(report.time_filter);
    const CcdReport limited =
        resolve_impact_zones({.connected = configuration.connected(),
                              .start = configuration.positions,
                              .mass = motion.vertices.mass,
                              .advect = [&](int vertex, const Vec3 &point) { return motion.carry(vertex, point); },
                              .rigid_motion = most,
                              .rigid = rigid,
                              .hopeful_rounds = hopeful_rounds},
                             configuration.pairs, end);
    Configuration::add(limited, report);
    return limited.fraction;
}

} // namespace

Advected advect(const SceneVertices &vertices, View<Vec3> target, View<int> offsets, const Carriers &carriers,
                Configuration &configuration, SceneReport &report) {
    const bool bodies = vertices.bodies.front() < vertices.bodies.back();
    const int hopeful_rounds = bodies ? scene_settings::hopeful_rounds : ccd::max_zone_rounds;
    const int attempts = bodies ? scene_settings::space_attempts : 0;
    const std::vector<Vec3> &now = configuration.positions;
    std::vector<Vec3> end(target.begin(), target.end());
    const PrescribedMotion whole{vertices, now, target};
    std::vector<int> rigid = advect_rigidly(whole, offsets, carriers, end);
    double fraction =
        limit_advection(whole, rigid, motion_of_most(vertices, now, end), hopeful_rounds, configuration, end, report);
    bool rigidly = true;
    for (int attempt = 0; attempt < attempts && fraction < std::ldexp(1.0, -attempt); ++attempt) {
        const double part = std::ldexp(1.0, -attempt);
        std::vector<Vec3> nearer(target.begin(), target.end());
        for (int v = 0; v < vertices.count(); ++v)
            if (!vertices.mesh.moves[v]) nearer[v] = now[v] + part * (target[v] - now[v]);
        const PrescribedMotion partly{vertices, now, nearer};
        end = nearer;
        std::fill(rigid.begin(), rigid.end(), -1);
        advect_with_space(partly, end);
        fraction = part * limit_advection(partly, rigid, motion_of_most(vertices, now, end), hopeful_rounds, configuration, end,
                                          report);
        rigidly = false;
    }
    configuration.commit_rigid(end);
    return {fraction, rigidly};
}

} // namespace ringlet
