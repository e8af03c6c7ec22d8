#include "ringlet/scene/scene_system.h"

#include <algorithm>

namespace ringlet {

SceneSystem::SceneSystem(const StrandModel &model_, const std::vector<SceneCloth> &cloths_, const SceneVertices &vertices_)
    : strands(model_), vertices(vertices_), model(model_) {
    for (const SceneCloth &cloth : cloths_) cloths.emplace_back(*cloth.model, *cloth.state);
}

void SceneSystem::begin(const StrandArrays &arrays, const StrandStep &step, View<Vec3> given) {
    strands.begin(arrays, step);
    given_ = given;
    own_energies_.assign(vertices.parts(), 0.0);
    active.assign(unit_count(), 1);
}

void SceneSystem::gather(const AlignedVector &at, std::vector<Vec3> &into) const {
#pragma omp parallel for schedule(static)
    for (int v = 0; v < vertices.moving_vertices(); ++v) into[v] = position(at, v);
}

void SceneSystem::scatter(View<Vec3> from, AlignedVector &into) const {
#pragma omp parallel for schedule(static)
    for (int v = 0; v < vertices.moving_vertices(); ++v)
        for (int k = 0; k < 3; ++k) into[slot(v) + k * stride(v)] = from[v][k];
}

void SceneSystem::touch(const std::vector<Touch> &touching, View<Vec3> now) {
    find_planes(touching);
    contacts.find(vertices.mesh, vertices.material, touching, vertices.positions, now);
    contacts_found_ = true;
    couple_parts();
}

void SceneSystem::find_planes(const std::vector<Touch> &touching) {
    by_planes_.assign(vertices.parts(), 0);
    std::fill(by_planes_.begin() + vertices.strands, by_planes_.end(), 1);
    if (cloths.empty()) return;
    for (const Touch &touch : touching)
        with_vertices(vertices.mesh, touch, [&](const auto &a, const auto &b) {
            const int one = vertices.part_of(a[0]), other = vertices.part_of(b[0]);
            if (one >= vertices.strands && other >= 0) by_planes_[other] = 1;
            if (other >= vertices.strands && one >= 0) by_planes_[one] = 1;
        });
    contacts.go_by_planes(by_planes_);
}

// Nothing but the incomplete factor is known of a cloth: it counts as coupled whatever touches it.
void SceneSystem::couple_parts() {
    values_.resize(contacts.contacts().size());
    pushes_.resize(values_.size());
    coupled_.assign(unit_count(), 0);
    std::fill(coupled_.begin() + group_count(), coupled_.end(), 1);
    together_.assign(vertices.parts(), 0);
    for (const Contact &c : contacts.contacts()) {
        if (!couples(c)) continue;
        const int a = vertices.part_of(c.vertex[0]), b = vertices.part_of(c.vertex[3]);
        coupled_[unit_of(a)] = coupled_[unit_of(b)] = 1;
        together_[a] = together_[b] = 1;
    }
}

bool SceneSystem::any_coupled() const {
    return std::any_of(coupled_.begin(), coupled_.end(), [](unsigned char coupled) { return coupled != 0; });
}

Vec3 SceneSystem::separation_at(const Contact &c, const AlignedVector &x) const {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < 4; ++i)
        if (c.weight[i] != 0.0) sum += c.weight[i] * position(x, c.vertex[i]);
    return sum;
}

void SceneSystem::energies(const AlignedVector &x, const NearPairs *near, const std::vector<unsigned char> &changed,
                           std::vector<double> &of) {
    for_units([&](int u) {
        if (!changed[u]) return;
        if (u >= group_count()) {
            const int cloth = u - group_count();
            own_energies_[vertices.strands + cloth] = cloths[cloth].energy(x.data() + unit_begin(u));
            return;
        }
        double energy[16];
        strands.evaluate(u, x, energy);
        const StrandGroup group = strands.strands_of(u);
        for (int lane = 0; lane < group.count; ++lane) own_energies_[group.strands[lane]] = energy[lane];
    });
    places_.resize(given_.size());
    for (size_t v = vertices.moving_vertices(); v < given_.size(); ++v) places_[v] = given_[v];
#pragma omp parallel for schedule(static)
    for (int v = 0; v < vertices.moving_vertices(); ++v)
        if (changed[unit_of(vertices.part_of(v))]) places_[v] = position(x, v);
    share_contacts(near, changed);
    of = own_energies_;
    for (const Lift &lift : lifts) {
        const double below = lift.below(places_[lift.vertex]);
        of[vertices.part_of(lift.vertex)] += 0.5 * lift.stiffness * below * below;
    }
    const auto share = [&](int a, int b, double energy) {
        if (a >= 0) of[a] += b >= 0 ? 0.5 * energy : energy;
        if (b >= 0) of[b] += a >= 0 ? 0.5 * energy : energy;
    };
    for (const Shared &push : pushed_) share(push.a, push.b, push.energy);
    const std::vector<Contact> &all = contacts.contacts();
    for (size_t c = 0; c < all.size(); ++c)
        share(vertices.part_of(all[c].vertex[0]), vertices.part_of(all[c].vertex[3]), rubbed_[c]);
}

// Energies of contacts, anew where one of the two parts has changed.
void SceneSystem::share_contacts(const NearPairs *near, const std::vector<unsigned char> &changed) {
    const std::vector<Contact> &all = contacts.contacts();
    if (contacts_found_) rubbed_.assign(all.size(), 0.0);
    const bool of_all = contacts_found_ || asked_planes_ != (near == nullptr);
    contacts_found_ = false;
    asked_planes_ = near == nullptr;
    std::vector<unsigned char> anew(vertices.parts());
    for (int p = 0; p < vertices.parts(); ++p) anew[p] = is_active(p) && (of_all || changed[unit_of(p)]);
    const auto is_anew = [&](int a, int b) { return (a >= 0 && anew[a]) || (b >= 0 && anew[b]); };
    std::erase_if(pushed_, [&](const Shared &push) { return is_anew(push.a, push.b); });
    const auto push = [&](const Contact &c) {
        const int a = vertices.part_of(c.vertex[0]), b = vertices.part_of(c.vertex[3]);
        if (is_anew(a, b)) pushed_.push_back({a, b, push_energy(c, separation(c, places_))});
    };
    if (near != nullptr) {
        const std::vector<Touch> touching = near->would_touch(places_, anew);
        for (const Contact &c : contacts.pushing(vertices.mesh, vertices.material, touching, vertices.positions, places_))
            push(c);
    } else {
        for (const Contact &c : all) push(c);
    }
    for (size_t c = 0; c < all.size(); ++c)
        if (is_anew(vertices.part_of(all[c].vertex[0]), vertices.part_of(all[c].vertex[3])))
            rubbed_[c] = friction_energy(all[c], separation(all[c], places_));
}

void SceneSystem::expect(const AlignedVector &direction) {
    const std::vector<Contact> &all = contacts.contacts();
    for (int k = 0; k < int(all.size()); ++k) {
        const Contact &c = all[k];
        Vec3 change = Vec3::Zero();
        for (int i = 0; i < 4; ++i)
            if (vertices.mesh.moves[c.vertex[i]] && c.weight[i] != 0.0)
                change += c.weight[i] * position(direction, c.vertex[i]);
        contacts.expect(k, std::max(0.0, c.force - c.normal.dot(values_[k].hessian * change)));
    }
}

void SceneSystem::assemble(const AlignedVector &x) {
    for_units([&](int u) {
        if (u < group_count())
            strands.assemble(u, x);
        else
            cloths[u - group_count()].assemble(x.data() + unit_begin(u));
    });
    const std::vector<Contact> &all = contacts.contacts();
#pragma omp parallel for schedule(static)
    for (int c = 0; c < int(all.size()); ++c) values_[c] = contact_value(all[c], separation_at(all[c], x));
    const std::vector<int> &touched = contacts.vertices();
#pragma omp parallel for schedule(static)
    for (int k = 0; k < int(touched.size()); ++k) {
        if (!is_active(vertices.part_of(touched[k]))) continue;
        if (touched[k] < vertices.strand_vertices())
            add_to_strand(touched[k]);
        else
            add_to_cloth(touched[k]);
    }
    for (const Lift &lift : lifts)
        if (is_active(vertices.part_of(lift.vertex))) add_lift(lift, x);
}

void SceneSystem::add_lift(const Lift &lift, const AlignedVector &x) {
    const double below = lift.below(position(x, lift.vertex));
    if (below == 0.0) return;
    const int strand = vertices.part_of(lift.vertex), group = strands.group_of(strand);
    const StrandGroupSystem &system = strands.system(group);
    const size_t slot = strands.slot(lift.vertex) - strands.group_begin(group);
    for (int i = 0; i < 3; ++i) system.gradient[slot + i * strands.stride()] -= lift.stiffness * below * lift.normal[i];
    strands.add_block(strand, lift.vertex, lift.vertex, lift.stiffness * lift.normal * lift.normal.transpose());
}

// What contacts do to a vertex and, by edges, from it to the next.
void SceneSystem::add_to_strand(int v) {
    const CollisionMesh &mesh = vertices.mesh;
    const int strand = vertices.part_of(v), group = strands.group_of(strand);
    Vec3 force = Vec3::Zero();
    Mat3 diagonal = Mat3::Zero(), next = Mat3::Zero();
    for (const ContactSet::Role &role : contacts.of(v)) {
        const Contact &c = contacts.contacts()[role.contact];
        const ContactValue &value = values_[role.contact];
        force += c.weight[role.as] * value.gradient;
        diagonal += c.weight[role.as] * c.weight[role.as] * value.hessian;
        const int other = role.as ^ 1; // of the same edge
        if (c.of_edges() && c.vertex[other] == v + 1 && mesh.moves[v + 1])
            next += c.weight[role.as] * c.weight[other] * value.hessian;
    }
    const StrandGroupSystem &system = strands.system(group);
    const size_t slot = strands.slot(v) - strands.group_begin(group);
    for (int i = 0; i < 3; ++i) system.gradient[slot + i * strands.stride()] += force[i];
    strands.add_block(strand, v, v, diagonal);
    if (v + 1 < model.offsets[strand + 1] && mesh.moves[v + 1]) strands.add_block(strand, v + 1, v, next);
}

// A side's vertices share a triangle, so that the pattern of the cloth's own matrix has their blocks.
void SceneSystem::add_to_cloth(int v) {
    const int number = vertices.part_of(v) - vertices.strands, first = vertices.cloths[number];
    CoupledCloth &cloth = cloths[number];
    for (const ContactSet::Role &role : contacts.of(v)) {
        const Contact &c = contacts.contacts()[role.contact];
        const ContactValue &value = values_[role.contact];
        cloth.gradient[v - first] += c.weight[role.as] * value.gradient;
        const bool second = role.as >= c.first;
        for (int other = second ? c.first : 0; other < (second ? 4 : c.first); ++other)
            if (c.weight[other] != 0.0 && vertices.mesh.moves[c.vertex[other]])
                cloth.matrix.block(cloth.matrix.slot(v - first, c.vertex[other] - first)) +=
                    c.weight[role.as] * c.weight[other] * value.hessian;
    }
}

double SceneSystem::gradient(size_t i, int unit) const {
    const size_t in_unit = i - unit_begin(unit);
    if (unit >= group_count()) return cloths[unit - group_count()].gradient[in_unit / 3][in_unit % 3];
    const StrandGroupSystem &system = strands.system(unit);
    return in_unit < size_t(system.freedoms) * system.vertices * system.lanes ? system.gradient[in_unit] : 0.0;
}

void SceneSystem::negative_gradient(int unit, AlignedVector &into) const {
    double *to = into.data() + unit_begin(unit), *const end = into.data() + unit_end(unit);
    const auto negate = [&](const double *from, size_t count) {
        for (const double *const last = from + count; from < last; ++from) *to++ = -*from;
    };
    if (unit < group_count()) {
        const StrandGroupSystem &system = strands.system(unit);
        negate(system.gradient, size_t(system.freedoms) * system.vertices * system.lanes);
        std::fill(to, end, 0.0);
    } else {
        const CoupledCloth &cloth = cloths[unit - group_count()];
        negate(cloth.gradient.data()->data(), cloth.size());
    }
}

void SceneSystem::factor(int unit) {
    if (unit < group_count())
        strands.factor(unit);
    else
        cloths[unit - group_count()].factor();
}

void SceneSystem::precondition(int unit, AlignedVector &b) const {
    if (unit < group_count())
        strands.solve(unit, b);
    else
        cloths[unit - group_count()].precondition(b.data() + unit_begin(unit));
}

void SceneSystem::couple(const AlignedVector &p, AlignedVector &q) {
    const std::vector<Contact> &all = contacts.contacts();
    const CollisionMesh &mesh = vertices.mesh;
#pragma omp parallel for schedule(static)
    for (int c = 0; c < int(all.size()); ++c) {
        pushes_[c] = {Vec3::Zero(), Vec3::Zero()};
        if (!couples(all[c])) continue;
        Vec3 side[2] = {Vec3::Zero(), Vec3::Zero()};
        for (int i = 0; i < 4; ++i)
            if (mesh.moves[all[c].vertex[i]]) side[i >= all[c].first] += all[c].weight[i] * position(p, all[c].vertex[i]);
        pushes_[c] = {values_[c].hessian * side[1], values_[c].hessian * side[0]};
    }
    const std::vector<int> &touched = contacts.vertices();
#pragma omp parallel for schedule(static)
    for (int k = 0; k < int(touched.size()); ++k) {
        if (!is_active(vertices.part_of(touched[k]))) continue;
        Vec3 force = Vec3::Zero();
        for (const ContactSet::Role &role : contacts.of(touched[k])) {
            const Contact &c = all[role.contact];
            force += c.weight[role.as] * pushes_[role.contact][role.as >= c.first];
        }
        const size_t first = slot(touched[k]), step = stride(touched[k]);
        for (int i = 0; i < 3; ++i) q[first + i * step] += force[i];
    }
}

} // namespace ringlet
