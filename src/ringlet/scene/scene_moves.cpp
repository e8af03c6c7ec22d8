#include "ringlet/scene/scene_parts.h"

#include "ringlet/contact/step_filter.h"

#include <algorithm>
#include <cmath>

namespace ringlet {

// Everything is to go from `now` to `to`: this becomes a place as near as nothing passes through anything. Returns what part of
// the way that is.
double Scene::Parts::filter(View<Vec3> now, std::vector<Vec3> &to, const MoveKind &kind, SceneReport &report) {
    const Stopwatch watch(report.time_filter);
    constexpr double far = 0.3; // [m]: a corridor as long as that holds too many
    if (kind.still && kind.shortened.empty()) {
        const bool stays = std::equal(to.begin(), to.end(), now.begin());
        if (stays && near.knows_all_here()) return 1.0;
        near.note(now, to, stays ? 0.0 : 0.2 * settings.strand_radius, far); // what stays hardly stays for long
        if (stays) return 1.0;
    }
    const SceneCarry with = carry();
    const FilterScene scene{vertices.mesh,
                            vertices.mass,
                            View<int>(model.offsets),
                            [&](int vertex, const Vec3 &point) { return with.carried(vertex, point); },
                            kind.still ? View<int>() : View<int>(rigid),
                            as_one,
                            kind.still,
                            kind.whole,
                            kind.shortened,
                            View<int>(vertices.cloths),
                            &neighbours,
                            kind.hopeful};
    const FilterReport filtered = filter_step(scene, near, now, to);
    report.candidates = filtered.candidates;
    report.violations += filtered.violations;
    report.zone_vertices += filtered.zone_vertices;
    return filtered.fraction;
}

void Scene::Parts::arrive(std::vector<Vec3> &now, const std::vector<Vec3> &to) {
    near.arrive(now, to);
    make_move(now, to);
}

void Scene::Parts::make_move(std::vector<Vec3> &now, const std::vector<Vec3> &to) {
    now = to;
    if (recording) path.push_back(now);
}

// How most of what hair and cloth there is goes from `now` to `to`.
RigidMotion Scene::Parts::motion_of_most(View<Vec3> now, View<Vec3> to) const {
    constexpr int asked = 1000; // vertices
    const int end = model.offsets.back() > 0 ? model.offsets.back() : vertices.moving_vertices();
    std::vector<int> told;
    for (int v = 0; v < end; v += 1 + end / asked) told.push_back(v);
    return common_motion(told, now, to);
}

// Everything goes along with what is kinematic, every strand rigidly with its root: of one rigid body and all that is rooted in
// it, nothing meets. What is kinematic has arrived then, and staying is always safe. Where what would go along with one body is
// between it and another, all goes along with the space between bodies, and no further than they can go at once.
Carried Scene::Parts::go_along(std::vector<Vec3> &now, double dt, SceneReport &report) {
    const bool bodies = vertices.bodies.front() < vertices.bodies.back();
    const int hopeful = bodies ? 6 : FilterScene::most_rounds; // rounds
    const int attempts = bodies ? 5 : 0;                       // with space, each half as far as the one before
    std::vector<Vec3> to = given;
    std::vector<int> bodies_of_cloths;
    rigid = carry_rigidly(carry(), View<int>(model.offsets), carriers(bodies_of_cloths, dt), to);
    as_one = motion_of_most(now, to);
    Carried carried{filter(now, to, {false, false, {}, hopeful}, report), true};
    const std::vector<Vec3> told = given;
    for (int attempt = 0; attempt < attempts && carried.fraction < std::ldexp(1.0, -attempt); ++attempt) {
        const double part = std::ldexp(1.0, -attempt);
        for (int v = 0; v < vertices.count(); ++v)
            if (!vertices.mesh.moves[v]) given[v] = now[v] + part * (told[v] - now[v]);
        to = given;
        std::fill(rigid.begin(), rigid.end(), -1);
        carry_with_space(carry(), to);
        as_one = motion_of_most(now, to);
        carried = {part * filter(now, to, {false, false, {}, hopeful}, report), false};
    }
    near.arrive_as_one(now, to);
    make_move(now, to);
    if (carried.fraction < 1.0) {
        for (int v = 0; v < vertices.count(); ++v)
            if (!vertices.mesh.moves[v]) given[v] = now[v];
    }
    return carried;
}

// What a filter left of a move is taken of the direction that led there, of all that it says of a vertex.
void Scene::Parts::take(View<Vec3> now, View<Vec3> wanted, View<Vec3> to) {
    for (int v = 0; v < vertices.moving_vertices(); ++v) {
        if (to[v] == wanted[v]) continue;
        const Vec3 way = wanted[v] - now[v];
        const double part = way.dot(to[v] - now[v]) / way.squaredNorm();
        for (int k = 0; k < system.freedoms(v); ++k) direction[system.slot(v) + k * system.stride(v)] *= part;
    }
}

} // namespace ringlet
