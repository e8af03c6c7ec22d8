#include "ringlet/scene/scene.h"

#include "ringlet/scene/data.h"
#include "ringlet/scene/settings.h"

#include <algorithm>
#include <stdexcept>

namespace ringlet {
namespace {

std::vector<int> pins(const std::vector<SceneCloth> &cloths) {
    std::vector<int> pinned;
    pinned.reserve(cloths.size());
    for (const SceneCloth &cloth : cloths) pinned.push_back(cloth.pinned_to);
    return pinned;
}

std::vector<std::unique_ptr<ClothBlock>> make_cloth_blocks(const std::vector<SceneCloth> &cloths, const SceneVertices &all) {
    std::vector<std::unique_ptr<ClothBlock>> blocks;
    blocks.reserve(cloths.size());
    for (int c = 0; c < int(cloths.size()); ++c)
        blocks.push_back(std::make_unique<ClothBlock>(*cloths[c].model, *cloths[c].state, all.strands + c, all.cloths[c]));
    return blocks;
}

std::vector<Block *> all_blocks(const std::vector<std::unique_ptr<StrandBlock>> &strands,
                                const std::vector<std::unique_ptr<ClothBlock>> &cloths) {
    std::vector<Block *> blocks;
    blocks.reserve(strands.size() + cloths.size());
    for (const auto &block : strands) blocks.push_back(block.get());
    for (const auto &block : cloths) blocks.push_back(block.get());
    return blocks;
}

std::vector<Vec3> all_positions(const StrandState &strands, const std::vector<SceneCloth> &cloths,
                                const std::vector<BodyModel> &bodies) {
    std::vector<Vec3> all = strands.positions;
    for (const SceneCloth &cloth : cloths) all.insert(all.end(), cloth.state->positions.begin(), cloth.state->positions.end());
    for (const BodyModel &body : bodies) all.insert(all.end(), body.rest.begin(), body.rest.end());
    return all;
}

} // namespace

SceneData::SceneData(const StrandModel &model_, StrandState &state_, const std::vector<SceneCloth> &cloths_,
                     const std::vector<BodyModel> &bodies_, const std::vector<int> &rooted_in_, const SceneContact &contact_)
    : model(model_), state(state_), contact(contact_), rooted_in(rooted_in_), pinned_to(pins(cloths_)),
      touched(cloths_.size(), -1), vertices(number_vertices(model_, state_, cloths_, bodies_, rooted_in_, contact_)),
      configuration(vertices, all_positions(state_, cloths_, bodies_), contact_.strand_radius),
      strands(make_strand_blocks(model_, state_)), cloths(make_cloth_blocks(cloths_, vertices)),
      blocks(all_blocks(strands, cloths), vertices), objective(blocks, vertices), system(objective),
      stiffness(vertices.count()), newton(vertices, objective, system, configuration, stiffness) {
    for (int b = 0; b < int(bodies_.size()); ++b)
        bodies.push_back({vertices.bodies[b], int(bodies_[b].rest.size()), vertices.objects + b, bodies_[b].triangles});
    objective.contacts.ties = contact_.ties;
    for (const Tie &tie : contact_.ties)
        for (const int v : tie.at.vertex)
            if (v < 0 || v >= vertices.strand_vertices()) throw std::invalid_argument("scene: ties join vertices of strands");
    exempt_coincident_pairs();
}

void SceneData::exempt_coincident_pairs() {
    for (const ContactPair &pair : configuration.contact_pairs()) {
        if (pair.closest.distance2 > std::pow(scene_settings::coincident * pair.d_hat, 2)) continue;
        vertices.mesh.exempt.push_back(pair);
        with_vertices(vertices.mesh, pair, [&](const auto &a, const auto &b) { coincident.push_back({a[0], b[0]}); });
    }
    configuration.candidates.clear();
}

bool SceneData::is_placed() const {
    const auto same = [&](const std::vector<Vec3> &of, int first) {
        const auto one = [](const Vec3 &a, const Vec3 &b) { return !((a - b).array().abs() > 0.0).any(); }; // 0 and −0 too
        return std::equal(of.begin(), of.end(), configuration.positions.begin() + first, one);
    };
    bool placed = same(state.positions, 0);
    for (size_t c = 0; c < cloths.size(); ++c) placed &= same(cloths[c]->state().positions, vertices.cloths[c]);
    return placed;
}

void SceneData::take_placed() {
    const auto take = [&](const std::vector<Vec3> &of, int first) {
        std::copy(of.begin(), of.end(), configuration.positions.begin() + first);
    };
    take(state.positions, 0);
    for (size_t c = 0; c < cloths.size(); ++c) take(cloths[c]->state().positions, vertices.cloths[c]);
    configuration.candidates.clear();
}

Scene::Scene(const StrandModel &model, StrandState &state, const std::vector<SceneCloth> &cloths,
             const std::vector<BodyModel> &bodies, const std::vector<int> &rooted_in, const SceneContact &contact)
    : data_(std::make_unique<SceneData>(model, state, cloths, bodies, rooted_in, contact)) {}

Scene::~Scene() = default;
Scene::Scene(Scene &&) noexcept = default;

SceneReport Scene::step(const SceneInput &input, const SceneStep &step, std::vector<StrandReport> &of_strands,
                        std::vector<ClothReport> &of_cloths) {
    if (input.targets.size() != size_t(data_->vertices.count()))
        throw std::invalid_argument("scene: targets do not fit the vertices");
    if (input.forces.size() != size_t(data_->vertices.dynamic_vertices))
        throw std::invalid_argument("scene: forces do not fit the vertices of strands and cloths");
    if (!data_->is_placed())
        throw std::invalid_argument("scene: strands or cloths were placed since the last step; call place() first");
    const SceneReport report = take_step(*data_, input, step);
    of_strands.assign(data_->model.strand_count(), StrandReport{});
    for (const auto &block : data_->strands)
        for (size_t lane = 0; lane < block->objects().size(); ++lane)
            of_strands[block->objects()[lane].number] = block->reports()[lane];
    of_cloths.clear();
    for (const auto &block : data_->cloths) {
        ClothReport of = block->report;
        of.linear = report.linear_iterations, of.linear_residual = report.linear_residual, of.cuts = report.cuts;
        of_cloths.push_back(of);
    }
    return report;
}

void Scene::place() { data_->take_placed(); }

std::vector<Contact> Scene::touching() {
    const SceneVertices &vertices = data_->vertices;
    Configuration &configuration = data_->configuration;
    configuration.candidates.clear();
    ContactMaterial material = vertices.material;
    material.stiffness.assign(vertices.count(), 1.0);
    material.firm_stiffness = material.stiffness;
    ContactSet contacts; // without a past
    contacts.find(vertices.mesh, material, configuration.contact_pairs(), std::vector<unsigned char>(vertices.objects, 1),
                  configuration.positions, configuration.positions);
    configuration.candidates.clear();
    return contacts.contacts();
}

void Scene::set_initial_forces(std::vector<InitialForce> forces) {
    if (data_->begun) throw std::invalid_argument("scene: initial forces are set before the first step");
    data_->initial_forces = std::move(forces);
}

void Scene::allow_penetration(int vertex, int body) {
    if (vertex < 0 || vertex >= data_->vertices.strand_vertices())
        throw std::invalid_argument("scene: only vertices of strands may penetrate a body");
    if (body < 0 || body >= int(data_->bodies.size())) throw std::invalid_argument("scene: there is no such body");
    data_->configuration.candidates.clear();
    data_->penetration.add(vertex, data_->bodies[body], data_->vertices.mesh);
}

const std::vector<std::array<int, 2>> &Scene::coincident() const { return data_->coincident; }
int Scene::penetrating() const { return data_->penetration.count(); }

void Scene::record(bool on) { data_->configuration.record(on); }
const std::vector<std::vector<Vec3>> &Scene::path() const { return data_->configuration.recorded(); }

SceneMemory Scene::memory() const {
    data_->configuration.candidates.clear(); // as in a scene that recalls it: then even what is counted is the same
    const View<Vec3> all = positions();
    const ContactSet &contacts = data_->objective.contacts;
    return {data_->begun,
            {all.begin() + dynamic_vertices(), all.end()},
            contacts.overlaps.all(),
            contacts.lagged_forces(),
            data_->stiffness.loads(),
            contacts.friction(),
            data_->penetration.heights(),
            data_->lagging,
            data_->touched};
}

void Scene::recall(const SceneMemory &memory) {
    SceneData &data = *data_;
    if (memory.bodies.size() != size_t(data.vertices.count() - dynamic_vertices()) ||
        memory.touched.size() != data.touched.size() || memory.loads.size() != size_t(data.vertices.count()))
        throw std::invalid_argument("scene: what is to be recalled is of another scene");
    data.begun = memory.begun;
    std::copy(memory.bodies.begin(), memory.bodies.end(), data.configuration.positions.begin() + dynamic_vertices());
    ContactSet &contacts = data.objective.contacts;
    contacts.overlaps.recall(memory.overlaps);
    contacts.recall(memory.lagged_forces);
    data.stiffness.recall(memory.loads);
    contacts.recall(memory.friction);
    data.penetration.recall(memory.penetrations, data.vertices.mesh);
    data.lagging = memory.lagging;
    data.touched = memory.touched;
    data.take_placed();
}

View<Vec3> Scene::positions() const { return data_->configuration.positions; }
int Scene::dynamic_vertices() const { return data_->vertices.dynamic_vertices; }
View<Contact> Scene::contacts() const { return data_->objective.contacts.contacts(); }

} // namespace ringlet
