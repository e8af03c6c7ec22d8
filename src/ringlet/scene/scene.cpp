#include "ringlet/scene/scene_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace ringlet {

Scene::Parts::Parts(const StrandModel &model_, StrandState &state_, const std::vector<SceneCloth> &cloths,
                    const std::vector<BodyModel> &bodies, const std::vector<int> &rooted_in, const SceneContact &contact)
    : model(model_), state(state_), settings(contact), root_body(rooted_in),
      vertices(number_vertices(model_, state_, cloths, bodies, rooted_in, contact)), system(model_, cloths, vertices),
      stiffness(vertices.count()), near(vertices.mesh),
      neighbours(ringlet::neighbours(vertices.mesh, vertices.cloths.front(), vertices.cloths.back())),
      given(vertices.positions) {
    for (const SceneCloth &cloth : cloths) pinned_to.push_back(cloth.pinned_to);
    touched.assign(cloths.size(), -1);
    for (int b = 0; b < int(bodies.size()); ++b)
        embedded_bodies.push_back({vertices.bodies[b], int(bodies[b].rest.size()), vertices.parts() + b, bodies[b].triangles});
}

void Scene::Parts::set_stiffness() { vertices.material.stiffness = stiffness.needed(vertices, 2.0 * settings.strand_radius); }

// Which body each cloth has most contacts with.
void Scene::Parts::note_touched() {
    const int bodies = int(embedded_bodies.size()), cloths = int(system.cloths.size());
    std::vector<int> contacts(size_t(bodies) * cloths, 0);
    for (const Contact &c : system.contacts.contacts()) {
        const auto [part, other] = std::minmax(vertices.mesh.object[c.vertex[0]], vertices.mesh.object[c.vertex[3]]);
        if (part >= vertices.strands && part < vertices.parts() && other >= vertices.parts())
            ++contacts[size_t(part - vertices.strands) * bodies + other - vertices.parts()];
    }
    for (int c = 0; c < cloths; ++c) {
        const auto begin = contacts.begin() + size_t(c) * bodies, most = std::max_element(begin, begin + bodies);
        touched[c] = most != begin + bodies && *most > 0 ? int(most - begin) : -1;
    }
}

// A cloth that is not pinned goes along with the body that it had most contacts with.
SceneCarriers Scene::Parts::carriers(std::vector<int> &of_cloths, double dt) const {
    of_cloths = pinned_to;
    for (size_t c = 0; c < of_cloths.size(); ++c)
        if (of_cloths[c] < 0) of_cloths[c] = touched[c];
    double mass = 0.0;
    Vec3 momentum = Vec3::Zero();
    for (const CoupledCloth &cloth : system.cloths)
        for (int v = 0; v < cloth.model().vertex_count(); ++v) {
            mass += cloth.model().mass[v];
            momentum += cloth.model().mass[v] * cloth.state().velocities[v];
        }
    return {root_body, of_cloths, mass > 0.0 ? Vec3(dt * momentum / mass) : Vec3(Vec3::Zero())};
}

void Scene::Parts::begin_strands(const StrandArrays &arrays, const StrandStep &step) {
    system.begin(arrays, step, given);
    if (x.size() != system.size())
        for (AlignedVector *vector : {&x, &way.straight, &way.bend}) *vector = AlignedVector(system.size());
    system.for_units([&](int u) {
        if (u >= system.group_count()) return;
        const StrandGroupSystem &group = system.strands.system(u);
        std::copy_n(group.x, size_t(group.freedoms()) * group.vertices * group.lanes, x.data() + system.unit_begin(u));
    });
}

void Scene::Parts::begin_cloths(const SceneInput &input, const StrandStep &step, View<Vec3> now) {
    const Vec3 gravity(step.gravity[0], step.gravity[1], step.gravity[2]), wind(step.wind[0], step.wind[1], step.wind[2]);
    for (int c = 0; c < int(system.cloths.size()); ++c) {
        CoupledCloth &cloth = system.cloths[c];
        const size_t first = vertices.cloths[c] - vertices.cloths[0], count = cloth.model().vertex_count();
        cloth.begin(
            {step.dt, gravity, wind, input.cloth_targets.subspan(first, count), input.cloth_forces.subspan(first, count)});
        double *at = x.data() + system.unit_begin(system.group_count() + c);
        std::copy_n(now[vertices.cloths[c]].data(), cloth.size(), at);
        cloth.guess(at);
    }
}

// One step as far as it goes; says what part of it that was.
double Scene::Parts::advance(const SceneInput &input, const SceneStep &scene_step, StrandStep &step, SceneReport &report,
                             std::vector<StrandReport> &of_strands, std::vector<ClothReport> &of_cloths) {
    stiffness.begin(system, settings.stiffness, step.dt);
    set_stiffness();
    vertices.material.give = settings.creep_speed * step.dt;
    given = vertices.positions;
    for (int v = 0; v < vertices.strand_vertices(); ++v)
        if (model.held[v]) given[v] = input.strand_targets[v];
    for (int v = vertices.strand_vertices(); v < vertices.moving_vertices(); ++v)
        if (!vertices.mesh.moves[v]) given[v] = input.cloth_targets[v - vertices.strand_vertices()];
    std::copy(input.body_targets.begin(), input.body_targets.end(), given.begin() + vertices.moving_vertices());
    const StrandArrays arrays = arrays_of(model, state, input.strand_targets, input.strand_forces); // until the strands end
    {
        const Stopwatch watch(report.time_assemble);
        begin_strands(arrays, step);
    }
    std::vector<Vec3> now = vertices.positions;
    const Carried carried = go_along(now, step.dt, report);
    step.dt *= carried.fraction;
    constexpr double speed = 0.02; // [m/s] of what began inside a body, out of it
    const int excused = embedded.count();
    system.lifts = embedded.push_out(vertices.mesh, now, View<int>(model.offsets), stiffness.hardest(), speed * step.dt);
    if (embedded.count() < excused) near.clear(); // pairs that were none
    // Then to where Newton's method begins.
    constexpr double hardly = 1e-12; // [m]
    begin_cloths(input, step, now);
    std::vector<Vec3> to = now;
    if (carried.rigidly) system.gather(x, to);
    for (int v = 0; v < vertices.moving_vertices(); ++v) // staying may be told within rounding
        if ((to[v] - now[v]).squaredNorm() < hardly * hardly) to[v] = now[v];
    const auto keep_held = [&] {
        for (int v = 0; v < vertices.moving_vertices(); ++v)
            if (!vertices.mesh.moves[v]) to[v] = now[v];
    };
    keep_held();
    const std::vector<Vec3> guess = to;
    limit(now, to, {.few = true}, report);
    SceneProgress progress(system);
    progress.moved(now, guess, to);
    progress.judge(step.tolerance);
    arrive(now, to);
    system.scatter(now, x);
    const int iteration = newton(scene_step, step, now, progress, report);
    const std::vector<ContactPair> touching = near.contact_pairs(now);
    system.touch(touching, now);
    system.contacts.hold(now);
    constexpr double slowly = 1e-4; // [m/s]
    if (settings.parting_speed == 0.0) system.contacts.stay_early(touching, now, slowly * step.dt);
    report.newton += iteration;
    report.residual = reach.empty() ? 0.0 : *std::max_element(reach.begin(), reach.end());
    report.unconverged = report.residual > step.tolerance;
    report.contacts = double(system.contacts.contacts().size());
    system.strands.end(x, {double(iteration), report.cuts, report.residual}, of_strands);
    for (int c = 0; c < int(system.cloths.size()); ++c) {
        ClothReport &of = of_cloths[c] = {};
        of.newton = iteration, of.residual = report.residual, of.unconverged = report.unconverged;
        system.cloths[c].end(x.data() + system.unit_begin(system.group_count() + c), of);
    }
    note_touched();
    vertices.positions = std::move(now);
    return carried.fraction;
}

void Scene::Parts::check(const SceneInput &input) const {
    const size_t strands = vertices.strand_vertices(), cloths = vertices.moving_vertices() - strands;
    if (input.strand_targets.size() != strands || input.strand_forces.size() != strands)
        throw std::invalid_argument("scene: targets and forces do not fit the strands");
    if (input.cloth_targets.size() != cloths || input.cloth_forces.size() != cloths)
        throw std::invalid_argument("scene: targets and forces do not fit the cloths");
    if (input.body_targets.size() != size_t(vertices.count() - vertices.moving_vertices()))
        throw std::invalid_argument("scene: targets do not fit the bodies");
}

// Strands and cloths may have been placed since the last step.
void Scene::Parts::find_placed() {
    const auto place = [&](View<Vec3> positions, int first) {
        const auto known = vertices.positions.begin() + first;
        if (std::equal(positions.begin(), positions.end(), known)) return;
        near.clear();
        std::copy(positions.begin(), positions.end(), known);
    };
    place(state.positions, 0);
    for (int c = 0; c < int(system.cloths.size()); ++c) place(system.cloths[c].state().positions, vertices.cloths[c]);
}

std::vector<Contact> Scene::Parts::touching() {
    find_placed();
    near.clear();
    near.update_bounds({vertices.positions, vertices.positions}, {.margin = 0.0, .max_path = 0.0});
    ContactMaterial material = vertices.material;
    material.stiffness.assign(vertices.count(), 1.0);
    ContactSet contacts; // which knows of nothing that was before
    contacts.find(vertices.mesh, material, near.contact_pairs(vertices.positions), vertices.positions, vertices.positions);
    near.clear();
    return contacts.contacts();
}

void Scene::Parts::begin(double dt) {
    near.update_bounds({vertices.positions, vertices.positions}, {.margin = 0.0, .max_path = 0.0});
    vertices.material.give = settings.creep_speed * dt;
    stiffness.begin(system, settings.stiffness, dt);
    set_stiffness();
    const std::vector<Vec3> &now = vertices.positions;
    const std::vector<ContactPair> touching = near.contact_pairs(now);
    system.contacts.begin(vertices.mesh, vertices.material, touching, bearing, now);
    system.contacts.find(vertices.mesh, vertices.material, touching, now, now);
    stiffness.bear(system.contacts);
    bearing.clear();
    begun = true;
}

SceneReport Scene::Parts::step(const SceneInput &input, const SceneStep &scene_step, std::vector<StrandReport> &of_strands,
                               std::vector<ClothReport> &of_cloths) {
    check(input);
    of_strands.assign(model.strand_count(), StrandReport{});
    of_cloths.assign(system.cloths.size(), ClothReport{});
    SceneReport report;
    find_placed();
    if (!begun) begin(scene_step.strands.dt);
    if (settings.parting_speed > 0.0) system.contacts.part_early(settings.parting_speed * scene_step.strands.dt);
    path.clear();
    if (recording) path.push_back(vertices.positions);
    double left = 1.0;
    for (int part = 0; part < scene_step.most_substeps && left > 1e-9; ++part) {
        StrandStep step = scene_step.strands;
        step.dt *= left;
        const double fraction = advance(input, scene_step, step, report, of_strands, of_cloths);
        left = fraction < 1.0 ? left * (1.0 - fraction) : 0.0;
        ++report.substeps;
    }
    report.fraction = 1.0 - left;
    report.closest = std::numeric_limits<double>::infinity();
    for (const Contact &c : system.contacts.contacts())
        report.closest = std::min(report.closest, separation(c, vertices.positions).norm());
    return report;
}

Scene::Scene(const StrandModel &model, StrandState &state, const std::vector<SceneCloth> &cloths,
             const std::vector<BodyModel> &bodies, const std::vector<int> &rooted_in, const SceneContact &contact)
    : parts_(std::make_unique<Parts>(model, state, cloths, bodies, rooted_in, contact)) {}

Scene::~Scene() = default;

SceneReport Scene::step(const SceneInput &input, const SceneStep &step, std::vector<StrandReport> &of_strands,
                        std::vector<ClothReport> &of_cloths) {
    return parts_->step(input, step, of_strands, of_cloths);
}

std::vector<Contact> Scene::touching() { return parts_->touching(); }

void Scene::bear(std::vector<ContactSet::Bearing> bearing) {
    if (parts_->begun) throw std::invalid_argument("scene: what bears is told before the first step");
    parts_->bearing = std::move(bearing);
}

void Scene::excuse(int vertex, int body) {
    if (vertex < 0 || vertex >= parts_->vertices.strand_vertices())
        throw std::invalid_argument("scene: only vertices of strands are excused");
    if (body < 0 || body >= int(parts_->embedded_bodies.size())) throw std::invalid_argument("scene: there is no such body");
    parts_->near.clear();
    parts_->embedded.add(vertex, parts_->embedded_bodies[body], parts_->vertices.mesh);
}

int Scene::excused() const { return parts_->embedded.count(); }

SceneMemory Scene::memory() const {
    parts_->near.clear(); // as whoever recalls it: then even what is counted is the same
    const View<Vec3> all = parts_->positions();
    const int bodies = parts_->vertices.moving_vertices();
    return {parts_->begun,
            {all.begin() + bodies, all.end()},
            parts_->system.contacts.early(),
            parts_->system.contacts.expected(),
            parts_->stiffness.borne(),
            parts_->system.contacts.held(),
            parts_->embedded.heights(),
            parts_->touched};
}

void Scene::recall(const SceneMemory &memory) {
    Parts &parts = *parts_;
    if (memory.bodies.size() != size_t(parts.vertices.count() - parts.vertices.moving_vertices()) ||
        memory.touched.size() != parts.touched.size() || memory.borne.size() != size_t(parts.vertices.count()))
        throw std::invalid_argument("scene: what is to be recalled is of another scene");
    parts.near.clear();
    parts.begun = memory.begun;
    std::copy(memory.bodies.begin(), memory.bodies.end(), parts.vertices.positions.begin() + parts.vertices.moving_vertices());
    parts.system.contacts.recall(memory.early);
    parts.system.contacts.recall(memory.expected);
    parts.stiffness.recall(memory.borne);
    parts.system.contacts.recall(memory.held);
    parts.embedded.recall(memory.embedded, parts.vertices.mesh);
    parts.touched = memory.touched;
}

void Scene::record(bool on) { parts_->recording = on; }

const std::vector<std::vector<Vec3>> &Scene::path() const { return parts_->path; }

View<Vec3> Scene::positions() const { return parts_->positions(); }
const std::vector<Contact> &Scene::contacts() const { return parts_->system.contacts.contacts(); }

} // namespace ringlet
