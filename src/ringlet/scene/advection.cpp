#include "ringlet/scene/advection.h"

#include "ringlet/ccd/advected_move.h"
#include "ringlet/math/disjoint_sets.h"
#include "ringlet/math/parallel.h"
#include "ringlet/scene/prescribed_motion.h"
#include "ringlet/scene/settings.h"

#include <algorithm>
#include <optional>

namespace ringlet {
namespace {

std::vector<int> prescribed(const SceneVertices &vertices, int begin, int end) {
    std::vector<int> found;
    for (int v = begin; v < end; ++v)
        if (!vertices.mesh.moves[v]) found.push_back(v);
    return found;
}

// The motion that most dynamic vertices have in common.
RigidMotion motion_of_most(const SceneVertices &vertices, View<Vec3> from, View<Vec3> to) {
    const int end = vertices.strand_vertices() > 0 ? vertices.strand_vertices() : vertices.dynamic_vertices;
    std::vector<int> sample;
    for (int v = 0; v < end; v += 1 + end / scene_settings::motion_samples) sample.push_back(v);
    return fit_rigid_motion_robust(sample, from, to);
}

// The ends of all vertices, dynamic ones advected rigidly. A strand goes with its root, or with the body that it is rooted in.
// A cloth goes with its body, else with the mean motion of its prescribed vertices, else with that of all.
std::vector<Vec3> advected_rigidly(const PrescribedMotion &motion, const Carriers &carriers) {
    const SceneVertices &all = motion.vertices;
    std::vector<Vec3> end(motion.target.begin(), motion.target.end());
    const std::vector<int> leaders = motion.rigid_bodies();
    const auto follows_body = [&](int body, int first, int last) {
        return body >= 0 && leaders[body] >= 0 && motion.follow(first, last, leaders[body]);
    };
    const auto move = [&](int first, int last, const auto &by) {
        for (int v = first; v < last; ++v)
            if (all.mesh.moves[v]) end[v] = by(motion.start[v]);
    };
    parallel_for(all.strands, [&](int s) {
        const auto [first, last, whole] = all.mesh.objects[s];
        const int body = s < int(carriers.of_strands.size()) ? carriers.of_strands[s] : -1;
        const int leader = follows_body(body, first, last) ? leaders[body] : first;
        move(first, last, [&](const Vec3 &point) { return motion.carry(leader, point); });
    });
    for (int c = 0; c + 1 < int(all.cloths.size()); ++c) {
        const int first = all.cloths[c], last = all.cloths[c + 1], body = carriers.of_cloths[c];
        if (follows_body(body, first, last)) {
            move(first, last, [&](const Vec3 &point) { return motion.carry(leaders[body], point); });
            continue;
        }
        if (const std::vector<int> own = prescribed(all, first, last); !own.empty()) {
            move(first, last, fit_rigid_motion(own, motion.start, motion.target));
            continue;
        }
        RigidMotion mean;
        mean.to = carriers.drift;
        if (const std::vector<int> any = prescribed(all, 0, all.count()); !any.empty())
            mean = fit_rigid_motion(any, motion.start, motion.target);
        mean.rotation = Mat3::Identity(); // the rotation of others would throw it off
        move(first, last, mean);
    }
    return end;
}

// An attempt at an advection.
class Attempt {
public:
    // `motion` starts where the configuration is; `end` is where all vertices are to go.
    Attempt(const PrescribedMotion &motion, std::vector<Vec3> end, Configuration &configuration)
        : motion_(motion), vertices_(motion.vertices), end_(std::move(end)), through_space_(vertices_.objects, 0),
          islands_(vertices_.objects + body_count()), move_(configuration.pairs, motion.start, end_) {
        join_islands();
    }

    AdvectedMove &move() { return move_; }
    const std::vector<Vec3> &end() const { return end_; }
    bool arrives() const { return move_.impacts().empty(); }
    const std::vector<unsigned char> &through_space() const { return through_space_; }

    void by_zones() {
        const auto follow_body = [&](int vertex, const Vec3 &point) {
            return motion_.is_behind(vertex) ? Vec3(point + motion_.target[vertex] - motion_.start[vertex])
                                             : motion_.carry(vertex, point);
        };
        resolve_impact_zones({vertices_.mass, follow_body}, move_);
        join_islands();
    }

    // Objects with an impact go through space, and those that meet them there. The surface of a body follows where nothing else
    // is left to, unless the body may wait.
    void by_space(const std::vector<unsigned char> &may_wait) {
        if (body_count() == 0 || arrives()) return;
        const SpaceMap map(motion_);
        std::vector<unsigned char> dented(vertices_.count(), 0);
        while (!arrives()) {
            std::vector<int> added = objects_with_impact();
            if (added.empty()) added = surfaces_with_impact(may_wait, dented);
            if (added.empty()) return;
            move_.round([&](const std::vector<Impact> &) {
                parallel_for(int(added.size()), [&](int k) { end_[added[k]] = mapped(map, added[k]); });
            });
            join_islands();
        }
    }

    // Bodies of the islands that have an impact.
    std::vector<int> stuck_bodies() {
        std::vector<unsigned char> stuck(vertices_.objects + body_count(), 0);
        for (const Impact &impact : move_.impacts())
            for (const int v : impact.vertices) stuck[islands_.find(vertices_.mesh.object[v])] = 1;
        std::vector<int> bodies;
        for (int b = 0; b < body_count(); ++b)
            if (stuck[islands_.find(vertices_.objects + b)]) bodies.push_back(b);
        return bodies;
    }

private:
    int body_count() const { return int(vertices_.bodies.size()) - 1; }

    void join_islands() {
        for (const Impact &impact : move_.impacts())
            islands_.join(vertices_.mesh.object[impact.vertices[0]], vertices_.mesh.object[impact.vertices[3]]);
    }

    std::vector<int> objects_with_impact() { // their vertices, of those that do not go through space yet
        std::vector<unsigned char> added(vertices_.objects, 0);
        for (const Impact &impact : move_.impacts())
            for (const int v : impact.vertices)
                if (const int object = vertices_.object_of(v); object >= 0 && !through_space_[object]) added[object] = 1;
        std::vector<int> found;
        for (int v = 0; v < vertices_.dynamic_vertices; ++v)
            if (vertices_.mesh.moves[v] && added[vertices_.mesh.object[v]]) found.push_back(v);
        for (int object = 0; object < vertices_.objects; ++object) through_space_[object] |= added[object];
        return found;
    }

    std::vector<int> surfaces_with_impact(const std::vector<unsigned char> &may_wait,
                                          std::vector<unsigned char> &dented) const {
        std::vector<int> found;
        for (const Impact &impact : move_.impacts())
            for (const int v : impact.vertices) {
                if (v < vertices_.dynamic_vertices || dented[v]) continue;
                if (may_wait[vertices_.mesh.object[v] - vertices_.objects]) continue;
                dented[v] = 1;
                found.push_back(v);
            }
        return found;
    }

    // A surface follows where that is near its own motion: the map bends around it, while a pinch is not to be passed on.
    Vec3 mapped(const SpaceMap &map, int v) const {
        Vec3 end = map(motion_.start[v]);
        if (v < vertices_.dynamic_vertices) return end;
        const Vec3 own = motion_.start[v] + motion_.target[v] - motion_.led[v];
        const double most = scene_settings::dent_deviation * (own - motion_.start[v]).norm();
        return (end - own).norm() <= most ? end : motion_.target[v];
    }

    const PrescribedMotion motion_;
    const SceneVertices &vertices_;
    std::vector<Vec3> end_;
    std::vector<unsigned char> through_space_; // per object
    DisjointSets islands_;                     // of objects and bodies that impacts have connected
    AdvectedMove move_;
};

// Per body, whether it may make a part of its motion: it moves affinely, and nothing is rooted in it or pinned to it.
std::vector<unsigned char> bodies_that_may_wait(const PrescribedMotion &motion, const Carriers &carriers) {
    std::vector<unsigned char> may_wait(motion.vertices.bodies.size() - 1, 1);
    for (const View<int> carrying : {carriers.of_strands, carriers.pinned})
        for (const int b : carrying)
            if (b >= 0) may_wait[b] = 0;
    for (int b = 0; b < int(may_wait.size()); ++b) may_wait[b] = may_wait[b] && motion.moves_affinely(b);
    return may_wait;
}

// Objects and bodies of which a part cannot stay behind: pins would draw out their cloth.
std::vector<unsigned char> uniform_objects(const SceneVertices &vertices, const std::vector<unsigned char> &may_wait) {
    std::vector<unsigned char> uniform(vertices.objects, 0);
    for (int c = 0; c + 1 < int(vertices.cloths.size()); ++c)
        uniform[vertices.strands + c] = !prescribed(vertices, vertices.cloths[c], vertices.cloths[c + 1]).empty();
    uniform.insert(uniform.end(), may_wait.begin(), may_wait.end());
    return uniform;
}

} // namespace

std::vector<unsigned char> advect(const PrescribedMotion &motion, const Carriers &carriers, Configuration &configuration,
                                  SceneReport &report) {
    const Stopwatch watch(report.time_filter);
    const SceneVertices &vertices = motion.vertices;
    std::vector<unsigned char> may_wait;
    std::vector<Vec3> target(motion.target.begin(), motion.target.end());
    std::vector<Vec3> end = advected_rigidly(motion, carriers);
    const RigidMotion frame = motion_of_most(vertices, motion.start, end);
    configuration.begin_step(frame);
    std::vector<Vec3> led = configuration.positions;
    for (int v = 0; v < vertices.count(); ++v)
        if (motion.is_behind(v)) led[v] = frame(motion.led[v]);
    std::optional<Attempt> attempt;
    for (double part = 1.0;; part *= 0.5) {
        attempt.emplace(PrescribedMotion{vertices, configuration.positions, led, target}, std::move(end), configuration);
        attempt->by_zones();
        if (attempt->arrives()) break;
        if (may_wait.empty()) may_wait = bodies_that_may_wait(motion, carriers);
        attempt->by_space(may_wait);
        if (attempt->arrives() || part < scene_settings::least_part) break;
        std::vector<int> waiting = attempt->stuck_bodies();
        std::erase_if(waiting, [&](int b) { return !may_wait[b]; });
        if (waiting.empty()) break;
        for (const int b : waiting)
            for (int v = vertices.bodies[b]; v < vertices.bodies[b + 1]; ++v) {
                const Vec3 &waits = configuration.positions[v];
                target[v] = part > scene_settings::least_part ? Vec3(0.5 * (waits + target[v])) : waits;
            }
        end = advected_rigidly({vertices, motion.start, motion.led, target}, carriers);
    }
    truncate_locally(attempt->move(), uniform_objects(vertices, may_wait));
    Configuration::add(attempt->move().report(), report);
    std::vector<unsigned char> astray = attempt->through_space();
    for (int v = 0; v < vertices.dynamic_vertices; ++v)
        if (!vertices.mesh.moves[v] && attempt->end()[v] != motion.target[v]) astray[vertices.mesh.object[v]] = 1;
    configuration.commit(attempt->end());
    return astray;
}

} // namespace ringlet
