// How a step of a scene goes: advect with bodies → limit → { contacts → assemble → solve → limit → line search → accept } →
// commit. The braces are Newton's method, in solver/newton.cpp.
#include "ringlet/math/parallel_copy.h"
#include "ringlet/scene/advection.h"
#include "ringlet/scene/data.h"
#include "ringlet/scene/settings.h"

#include <algorithm>
#include <limits>

namespace ringlet {
namespace {

void begin_contact(SceneData &scene, double dt) {
    scene.vertices.material.stick_length = scene.contact.creep_speed * dt;
    scene.stiffness.begin_step(scene.objective.contact_stiffness(scene.contact.stiffness, dt), dt);
    scene.stiffness.set_levels(scene.vertices.mesh, scene.vertices.material);
}

// Before the first step: the initial overlaps and their forces.
void find_initial_contacts(SceneData &scene, double dt) {
    const std::vector<Vec3> &now = scene.configuration.positions;
    ContactSet &contacts = scene.objective.contacts;
    begin_contact(scene, dt);
    const std::vector<ContactPair> touching = scene.configuration.contact_pairs();
    contacts.begin(scene.vertices.mesh, scene.vertices.material, touching, scene.initial_forces, now);
    contacts.find(scene.vertices.mesh, scene.vertices.material, touching, scene.blocks.active_objects(), now, now);
    scene.stiffness.raise_loads(contacts);
    scene.initial_forces.clear();
    scene.begun = true;
}

// A cloth that is not pinned moves along with the body that it had most contacts with.
std::vector<int> bodies_of_cloths(const SceneData &scene) {
    std::vector<int> bodies = scene.pinned_to;
    for (size_t c = 0; c < bodies.size(); ++c)
        if (bodies[c] < 0) bodies[c] = scene.touched[c];
    return bodies;
}

std::vector<int> most_touched_bodies(const SceneData &scene) {
    const SceneVertices &vertices = scene.vertices;
    const int bodies = int(scene.bodies.size()), cloths = int(scene.cloths.size());
    std::vector<int> contacts(size_t(bodies) * cloths, 0), touched(cloths, -1);
    for (const Contact &c : scene.objective.contacts.contacts()) {
        const auto [one, other] = std::minmax(vertices.mesh.object[c.at.vertex[0]], vertices.mesh.object[c.at.vertex[3]]);
        if (one >= vertices.strands && one < vertices.objects && other >= vertices.objects)
            ++contacts[size_t(one - vertices.strands) * bodies + other - vertices.objects];
    }
    for (int c = 0; c < cloths; ++c) {
        const auto begin = contacts.begin() + size_t(c) * bodies, most = std::max_element(begin, begin + bodies);
        if (most != begin + bodies && *most > 0) touched[c] = int(most - begin);
    }
    return touched;
}

Vec3 mean_velocity_of_cloths(const SceneData &scene) {
    double mass = 0.0;
    Vec3 momentum = Vec3::Zero();
    for (const auto &cloth : scene.cloths)
        for (int v = 0; v < cloth->model().vertex_count(); ++v) {
            mass += cloth->model().mass[v];
            momentum += cloth->model().mass[v] * cloth->state().velocities[v];
        }
    return mass > 0.0 ? Vec3(momentum / mass) : Vec3(Vec3::Zero());
}

// Advects to the targets of prescribed vertices, and keeps which of them lag. Returns the objects that could not follow theirs
// rigidly.
std::vector<unsigned char> advect_to(SceneData &scene, View<Vec3> targets, const Vec3 &drift, SceneReport &report) {
    const SceneVertices &vertices = scene.vertices;
    const std::vector<Vec3> start = parallel_copy(scene.configuration.positions);
    std::vector<Vec3> led = parallel_copy(start), end = parallel_copy(start);
    for (const auto &[vertex, place] : scene.lagging) led[vertex] = place;
    for (int v = 0; v < vertices.count(); ++v)
        if (!vertices.mesh.moves[v]) end[v] = targets[v];
    const std::vector<int> bodies = bodies_of_cloths(scene);
    const std::vector<unsigned char> astray =
        advect({vertices, start, led, end}, {scene.rooted_in, bodies, scene.pinned_to, drift}, scene.configuration, report);
    scene.lagging.clear();
    for (int v = 0; v < vertices.count(); ++v)
        if (!vertices.mesh.moves[v] && scene.configuration.positions[v] != targets[v])
            scene.lagging.emplace_back(v, targets[v]);
    return astray;
}

// The targets with the prescribed vertices where they have arrived.
std::vector<Vec3> targets_on_arrival(const SceneData &scene, View<Vec3> targets) {
    std::vector<Vec3> arrived(targets.begin(), targets.end());
    for (int v = 0; v < scene.vertices.count(); ++v)
        if (!scene.vertices.mesh.moves[v]) arrived[v] = scene.configuration.positions[v];
    return arrived;
}

// Moves to where Newton's method begins: the blocks' initial guess, limited. Objects that are `astray` begin where they are.
void move_to_initial_guess(SceneData &scene, const std::vector<unsigned char> &astray, double tolerance, AlignedVector &x,
                           Refinement &refinement, SceneReport &report) {
    const SceneVertices &vertices = scene.vertices;
    const std::vector<Vec3> now = parallel_copy(scene.configuration.positions);
    scene.blocks.scatter(now, x);
    scene.blocks.for_active([&](int b) { scene.blocks[b].initial_guess(scene.blocks.of(b, x)); });
    PlannedMove move{now, {}};
    scene.blocks.gather(x, move.to);
    for (int v = 0; v < vertices.dynamic_vertices; ++v)
        if (!vertices.mesh.moves[v] || astray[vertices.mesh.object[v]] ||
            (move.to[v] - now[v]).squaredNorm() < scene_settings::guess_rounding * scene_settings::guess_rounding)
            move.to[v] = now[v];
    const std::vector<Vec3> guess = parallel_copy(move.to);
    scene.configuration.limit(move, Yield::near_impacts, Candidates::Serve::later_moves, report);
    refinement.add(ObjectMoves(scene.blocks, now, guess, move.to), tolerance);
    scene.configuration.commit(move.to);
    scene.blocks.scatter(scene.configuration.positions, x);
}

// Keeps what the next step begins with.
void commit(SceneData &scene, View<Vec3> start, double dt, const SolverEffort &effort, const AlignedVector &x,
            SceneReport &report) {
    const std::vector<Vec3> &now = scene.configuration.positions;
    const std::vector<ContactPair> touching = scene.configuration.contact_pairs();
    ContactSet &contacts = scene.objective.contacts;
    scene.blocks.activate_all();
    contacts.find(scene.vertices.mesh, scene.vertices.material, touching, scene.blocks.active_objects(), start, now);
    contacts.commit_friction(now);
    if (scene.contact.parting_speed == 0.0)
        contacts.overlaps.settle(touching, contacts.contacts(), now, scene_settings::parting_speed * dt);
    std::vector<unsigned char> finite(scene.blocks.count());
    scene.blocks.for_active([&](int b) { finite[b] = scene.blocks[b].commit(scene.blocks.of(b, x), dt, effort); });
    if (std::count(finite.begin(), finite.end(), 0) > 0) scene.take_placed();
    scene.touched = most_touched_bodies(scene);
    report.newton = effort.iterations;
    report.residual = effort.residual;
    report.unconverged = !effort.converged;
    report.contacts = double(contacts.contacts().size());
}

} // namespace

SceneReport take_step(SceneData &scene, const SceneInput &input, const SceneStep &settings) {
    const LoopRecorder::Step recorded;
    SceneReport report{};
    const StrandStep &step = settings.strands;
    if (!scene.begun) find_initial_contacts(scene, step.dt);
    if (scene.contact.parting_speed > 0.0) scene.objective.contacts.overlaps.grow(scene.contact.parting_speed * step.dt);
    const std::vector<Vec3> start = parallel_copy(scene.configuration.positions);
    begin_contact(scene, step.dt);
    const std::vector<unsigned char> astray = advect_to(scene, input.targets, step.dt * mean_velocity_of_cloths(scene), report);

    const int inside = scene.penetration.count();
    scene.objective.springs = scene.penetration.recover(scene.vertices.mesh, scene.configuration.positions,
                                                        scene.stiffness.largest(), scene_settings::recovery_speed * step.dt);
    if (scene.penetration.count() < inside) scene.configuration.candidates.clear(); // of pairs that were exempt

    const std::vector<Vec3> targets = targets_on_arrival(scene, input.targets);
    for (const auto &block : scene.strands) block->configure(step);
    {
        const Stopwatch watch(report.time_assemble);
        scene.objective.begin_step({step.dt, Vec3(step.gravity), Vec3(step.wind), targets, input.forces},
                                   scene.configuration.positions);
    }
    AlignedVector x(scene.blocks.size());
    Refinement refinement(scene.objective);
    move_to_initial_guess(scene, astray, step.tolerance, x, refinement, report);
    scene.objective.contacts.begin_step(scene.configuration.positions);

    const NewtonSettings newton{step.newton, settings.extra, step.tolerance, settings.linear};
    const SolverEffort effort = scene.newton.minimise(start, newton, refinement, x, report);
    commit(scene, start, step.dt, effort, x, report);
    for (const auto &[vertex, target] : scene.lagging)
        report.lag = std::max(report.lag, (scene.configuration.positions[vertex] - target).norm());
    report.closest = std::numeric_limits<double>::infinity();
    for (const Contact &c : scene.objective.contacts.contacts())
        report.closest = std::min(report.closest, c.at.separation(scene.configuration.positions).norm());
    return report;
}

} // namespace ringlet
