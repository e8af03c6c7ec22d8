#include "ringlet/scene/scene_parts.h"

#include <algorithm>
#include <cmath>

namespace ringlet {
namespace {

double part_of_way(const Vec3 &now, const Vec3 &wanted, const Vec3 &to) {
    const Vec3 way = wanted - now;
    return way.dot(to - now) / way.squaredNorm();
}

void add(SceneReport &report, const CcdReport &of) {
    report.candidates = of.candidates;
    report.violations += of.impacts;
    report.zone_vertices += of.corrected_vertices;
}

} // namespace

// A move on which nothing kinematic moves; returns what fraction of it is made.
double Scene::Parts::limit(View<Vec3> now, std::vector<Vec3> &to, const LimitedMove &move, SceneReport &report) {
    const Stopwatch watch(report.time_filter);
    constexpr double far = 0.3; // [m]: a corridor as long as that holds too many
    if (move.changed.empty()) {
        const View<Vec3> apex = move.apex != nullptr ? View<Vec3>(*move.apex) : View<Vec3>();
        const bool stays = std::equal(to.begin(), to.end(), now.begin()) && std::equal(apex.begin(), apex.end(), now.begin());
        const bool known = near.is_complete() && (stays || move.few);
        const double margin = stays ? 0.0 : 0.2 * settings.strand_radius; // what stays hardly stays for long
        if (!known) near.update_bounds({now, to, apex}, {.margin = margin, .max_path = far, .lasting = move.lasting});
        if (stays) return 1.0;
    }
    const CcdReport limited =
        limit_motion({.connected = connected(), .start = now, .whole_strands = move.whole_strands, .changed = move.changed},
                     near, to, move.apex);
    add(report, limited);
    return limited.fraction;
}

// A move with kinematic bodies; returns what fraction of it is made.
double Scene::Parts::resolve(View<Vec3> now, std::vector<Vec3> &to, int hopeful_rounds, SceneReport &report) {
    const Stopwatch watch(report.time_filter);
    const SceneCarry with = carry();
    const CcdReport resolved =
        resolve_impact_zones({.connected = connected(),
                              .start = now,
                              .mass = vertices.mass,
                              .advect = [&](int vertex, const Vec3 &point) { return with.carried(vertex, point); },
                              .rigid_motion = as_one,
                              .rigid = rigid,
                              .hopeful_rounds = hopeful_rounds},
                             near, to);
    add(report, resolved);
    return resolved.fraction;
}

void Scene::Parts::arrive(std::vector<Vec3> &now, const std::vector<Vec3> &to) {
    near.commit_move(now, to);
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
    const int hopeful = bodies ? 6 : ccd::max_zone_rounds; // rounds
    const int attempts = bodies ? 5 : 0;                   // with space, each half as far as the one before
    std::vector<Vec3> to = given;
    std::vector<int> bodies_of_cloths;
    rigid = carry_rigidly(carry(), View<int>(model.offsets), carriers(bodies_of_cloths, dt), to);
    as_one = motion_of_most(now, to);
    Carried carried{resolve(now, to, hopeful, report), true};
    const std::vector<Vec3> told = given;
    for (int attempt = 0; attempt < attempts && carried.fraction < std::ldexp(1.0, -attempt); ++attempt) {
        const double part = std::ldexp(1.0, -attempt);
        for (int v = 0; v < vertices.count(); ++v)
            if (!vertices.mesh.moves[v]) given[v] = now[v] + part * (told[v] - now[v]);
        to = given;
        std::fill(rigid.begin(), rigid.end(), -1);
        carry_with_space(carry(), to);
        as_one = motion_of_most(now, to);
        carried = {part * resolve(now, to, hopeful, report), false};
    }
    near.commit_rigid_move(now, to);
    make_move(now, to);
    if (carried.fraction < 1.0) {
        for (int v = 0; v < vertices.count(); ++v)
            if (!vertices.mesh.moves[v]) given[v] = now[v];
    }
    return carried;
}

// The way is held back where something is met on it, and then leads from `now` to `to`. First strands go where their edges
// turn. What would meet something early there goes straight, and half as far: with what it touches, the linear system knows
// how far that lets it go, while what edges turn by is told from the root, wherever that leads. What would meet something later
// goes so much of its way. Of both it is asked once more what they meet.
void Scene::Parts::hold_back(View<Vec3> now, bool whole, bool lasts, std::vector<Vec3> &to, SceneProgress &progress,
                             SceneReport &report) {
    constexpr double early = 0.05, half = 0.5;
    const std::vector<unsigned char> all_parts(vertices.parts(), 1);
    std::vector<Vec3> wanted(now.begin(), now.end()), via = wanted;
    AlignedVector end(system.size());
    const auto set_out = [&] {
        std::copy_n(x.data(), x.size(), end.data());
        move(system, x, std::vector<double>(vertices.parts(), 1.0), way, all_parts, end);
        for (int v = 0; v < vertices.moving_vertices(); ++v) {
            if (!vertices.mesh.moves[v]) continue;
            wanted[v] = system.position(end, v);
            via[v] = now[v] + half * system.position(way.straight, v); // with it, a triangle holds all that is bent
        }
    };
    set_out();
    to = wanted;
    limit(now, to, {.whole_strands = true, .apex = &via, .lasting = lasts}, report);
    std::vector<double> left = parts_left(now, wanted, to);
    std::vector<unsigned char> goes_straight(vertices.parts(), 0), asked(vertices.parts(), 0), changed(vertices.count(), 0);
    for (int p = 0; p < vertices.parts(); ++p) {
        asked[p] = left[p] < 1.0;
        goes_straight[p] = left[p] < early;
        if (p >= vertices.strands) // a cloth is held back near what it meets, not as a whole
            left[p] = 1.0;
        else if (goes_straight[p])
            left[p] = half;
    }
    straighten(system, goes_straight, way);
    shorten(system, left, way);
    set_out();
    for (int v = 0; v < vertices.moving_vertices(); ++v)
        if (vertices.mesh.moves[v] && asked[vertices.part_of(v)]) changed[v] = 1, to[v] = wanted[v];
    limit(now, to, {.whole_strands = whole, .changed = changed, .apex = &via}, report);
    progress.moved(now, wanted, to);
    progress.cut(left);
    take(now, wanted, to);
}

// Per part, how much is left to it of its way, where that is least.
std::vector<double> Scene::Parts::parts_left(View<Vec3> now, View<Vec3> wanted, View<Vec3> to) const {
    std::vector<double> left(vertices.parts(), 1.0);
    for (int v = 0; v < vertices.moving_vertices(); ++v) {
        if (to[v] == wanted[v]) continue;
        double &of = left[vertices.part_of(v)];
        of = std::min(of, part_of_way(now[v], wanted[v], to[v]));
    }
    return left;
}

// What a filter left of a move is taken of the way that led there, of all that it says of a vertex.
void Scene::Parts::take(View<Vec3> now, View<Vec3> wanted, View<Vec3> to) {
    std::vector<unsigned char> goes_straight(vertices.parts(), 0);
    for (int v = 0; v < vertices.moving_vertices(); ++v)
        if (to[v] != wanted[v]) goes_straight[vertices.part_of(v)] = 1;
    for (int v = 0; v < vertices.moving_vertices(); ++v) {
        if (!goes_straight[vertices.part_of(v)] || !vertices.mesh.moves[v]) continue;
        const double part = to[v] == wanted[v] ? 1.0 : part_of_way(now[v], wanted[v], to[v]);
        for (int k = 0; k < system.freedoms(v); ++k) {
            const size_t i = system.slot(v) + k * system.stride(v);
            way.straight[i] = part * (way.straight[i] + way.bend[i]);
        }
    }
    straighten(system, goes_straight, way);
}

} // namespace ringlet
