#include "ringlet/solver/scene_system.h"

#include "ringlet/solver/lane_vectors.h"

#include <algorithm>

namespace ringlet {
namespace {

// Whether one of two parts is marked; −1 is none, and where nothing is said none is.
bool either(View<unsigned char> marked, int a, int b) {
    return !marked.empty() && ((a >= 0 && marked[a] != 0) || (b >= 0 && marked[b] != 0));
}

} // namespace

SceneSystem::SceneSystem(const StrandModel &model_, const std::vector<SceneCloth> &cloths_, const SceneVertices &vertices_)
    : strands(model_, vertices_.positions), vertices(vertices_), model(model_) {
    for (const SceneCloth &cloth : cloths_) cloths.emplace_back(*cloth.model, *cloth.state);
    for (int s = 0; s < vertices.strands; ++s) unit_of_.push_back(strands.group_of(s));
    for (int c = 0; c < int(cloths.size()); ++c) unit_of_.push_back(group_count() + c);
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

void SceneSystem::touch(const std::vector<ContactPair> &touching, View<Vec3> now) {
    find_planes(touching);
    contacts.find(vertices.mesh, vertices.material, touching, vertices.positions, now);
    contacts_found_ = true;
    values_.resize(contacts.contacts().size());
    couplings.find(contacts, vertices, unit_of_, unit_count());
    touched_ = {size_t(unit_count()), [&](const auto &work) {
                    for (const int v : contacts.vertices()) work(unit_of(vertices.part_of(v)), v);
                }};
}

void SceneSystem::find_planes(const std::vector<ContactPair> &touching) {
    by_planes_.assign(vertices.parts(), 0);
    std::fill(by_planes_.begin() + vertices.strands, by_planes_.end(), 1);
    if (cloths.empty()) return;
    for (const ContactPair &touch : touching)
        with_vertices(vertices.mesh, touch, [&](const auto &a, const auto &b) {
            const int one = vertices.part_of(a[0]), other = vertices.part_of(b[0]);
            if (one >= vertices.strands && other >= 0) by_planes_[other] = 1;
            if (other >= vertices.strands && one >= 0) by_planes_[one] = 1;
        });
    contacts.go_by_planes(by_planes_);
}

void SceneSystem::to_lanes(int unit, const std::vector<double> &of_parts, double *of_lanes) const {
    if (unit >= group_count()) {
        of_lanes[0] = of_parts[vertices.strands + unit - group_count()];
        return;
    }
    const StrandGroup group = strands.strands_of(unit);
    for (int lane = 0; lane < group.count; ++lane) of_lanes[lane] = of_parts[group.strands[lane]];
}

void SceneSystem::from_lanes(int unit, const double *of_lanes, std::vector<double> &of_parts) const {
    if (unit >= group_count()) {
        of_parts[vertices.strands + unit - group_count()] = of_lanes[0];
        return;
    }
    const StrandGroup group = strands.strands_of(unit);
    for (int lane = 0; lane < group.count; ++lane) of_parts[group.strands[lane]] = of_lanes[lane];
}

void SceneSystem::evaluate(int unit, const AlignedVector &x, bool to_assemble) {
    double energies[most_lanes] = {};
    if (unit < group_count() && to_assemble)
        strands.evaluate(unit, x, energies);
    else if (unit < group_count())
        strands.energies(unit, x, energies);
    else
        energies[0] = cloths[unit - group_count()].energy(x.data() + unit_begin(unit));
    from_lanes(unit, energies, own_energies_);
}

std::vector<unsigned char> SceneSystem::active_parts() const {
    std::vector<unsigned char> active(vertices.parts());
    for (int p = 0; p < vertices.parts(); ++p) active[p] = is_active(p);
    return active;
}

void SceneSystem::energies(const AlignedVector &x, const ReachablePairs *pairs, View<unsigned char> undecided,
                           const std::vector<double> &gone, const std::vector<unsigned char> &changed,
                           std::vector<double> &of) {
    std::vector<unsigned char> asked(unit_count(), 0);
    for (int p = 0; p < vertices.parts(); ++p)
        if (changed[p]) asked[unit_of(p)] = 1;
    for_units([&](int u) {
        if (asked[u]) evaluate(u, x, false);
    });
#pragma omp parallel for schedule(static)
    for (int v = 0; v < vertices.moving_vertices(); ++v)
        if (changed[vertices.part_of(v)]) places_[v] = position(x, v);
    share_contacts(pairs, undecided, gone, changed);
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
    for (size_t c = 0; c < all.size(); ++c) {
        const int a = vertices.part_of(all[c].vertex[0]), b = vertices.part_of(all[c].vertex[3]);
        if (!either(undecided, a, b)) share(a, b, rubbed_[c]);
    }
}

// Energies of contacts, anew where one of the two parts has changed.
void SceneSystem::share_contacts(const ReachablePairs *pairs, View<unsigned char> undecided, const std::vector<double> &gone,
                                 const std::vector<unsigned char> &changed) {
    const std::vector<Contact> &all = contacts.contacts();
    if (contacts_found_) rubbed_.assign(all.size(), 0.0);
    const bool of_all = contacts_found_ || asked_planes_ != (pairs == nullptr);
    const bool where_found = contacts_found_ && pairs != nullptr; // what is asked first is asked there
    contacts_found_ = false;
    asked_planes_ = pairs == nullptr;
    std::vector<unsigned char> anew(vertices.parts());
    for (int p = 0; p < vertices.parts(); ++p) anew[p] = is_active(p) && (of_all || changed[p]);
    const auto is_anew = [&](int a, int b) { return either(anew, a, b); };
    std::erase_if(pushed_, [&](const Shared &push) { return is_anew(push.a, push.b); });
    if (where_found) {
        for (const Contact &c : all) {
            const int a = vertices.part_of(c.vertex[0]), b = vertices.part_of(c.vertex[3]);
            if (is_anew(a, b)) pushed_.push_back({a, b, push_energy_where_found(c)});
        }
    } else if (pairs != nullptr) {
        const auto part = [&](int object) { return object < vertices.parts() ? object : -1; };
        const std::vector<ContactPair> there = contact_pairs(vertices.mesh, *pairs, places_, anew, gone);
        for (const ContactSet::Push &push : contacts.pushing(vertices.mesh, vertices.material, there, places_))
            pushed_.push_back({part(push.objects[0]), part(push.objects[1]), push.energy()});
    } else {
        for (const Contact &c : all) {
            const int a = vertices.part_of(c.vertex[0]), b = vertices.part_of(c.vertex[3]);
            if (!is_anew(a, b) || either(undecided, a, b)) continue;
            const Vec3 apart = separation(c, places_);
            pushed_.push_back({a, b, either(by_planes_, a, b) ? push_energy(c, apart) : expanded_push_energy(c, apart)});
        }
    }
    for (size_t c = 0; c < all.size(); ++c)
        if (is_anew(vertices.part_of(all[c].vertex[0]), vertices.part_of(all[c].vertex[3])))
            rubbed_[c] = friction_energy(all[c], separation(all[c], places_));
}

void SceneSystem::expect(const AlignedVector &direction) {
    constexpr double near = 0.05; // of its distance
    const std::vector<Contact> &all = contacts.contacts();
    for (int k = 0; k < int(all.size()); ++k) {
        const Contact &c = all[k];
        Vec3 change = Vec3::Zero();
        for (int i = 0; i < 4; ++i)
            if (vertices.mesh.moves[c.vertex[i]] && c.weight[i] != 0.0)
                change += c.weight[i] * position(direction, c.vertex[i]);
        const double most = std::max(c.force, -c.stiffness * contact_potential(near * c.distance, c.distance, 0.0).first);
        contacts.expect(k, std::min(std::max(0.0, c.force - c.normal.dot(values_[k].hessian * change)), most));
    }
}

void SceneSystem::linearise(const AlignedVector &x) {
    places_.resize(given_.size());
    std::copy(given_.begin() + vertices.moving_vertices(), given_.end(), places_.begin() + vertices.moving_vertices());
    gather(x, places_);
    contacts_found_ = true;
    const std::vector<Contact> &all = contacts.contacts();
#pragma omp parallel for schedule(static)
    for (int c = 0; c < int(all.size()); ++c) values_[c] = contact_value(all[c], separation(all[c], places_));
}

void SceneSystem::assemble(int unit, const AlignedVector &x) {
    evaluate(unit, x, true);
    if (unit < group_count())
        strands.assemble(unit, x);
    else
        cloths[unit - group_count()].assemble(x.data() + unit_begin(unit));
    for (const int v : touched_.of(unit)) {
        if (unit < group_count())
            add_to_strand(v);
        else
            add_to_cloth(v);
    }
    for (const Lift &lift : lifts)
        if (unit_of(vertices.part_of(lift.vertex)) == unit) add_lift(lift, x);
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
    return in_unit < size_t(system.freedoms()) * system.vertices * system.lanes ? system.gradient[in_unit] : 0.0;
}

void SceneSystem::negative_gradient(int unit, double *into) const {
    double *const end = into + (unit_end(unit) - unit_begin(unit));
    const auto negate = [&](const double *from, size_t count) {
        for (const double *const last = from + count; from < last; ++from) *into++ = -*from;
    };
    if (unit < group_count()) {
        const StrandGroupSystem &system = strands.system(unit);
        negate(system.gradient, size_t(system.freedoms()) * system.vertices * system.lanes);
        std::fill(into, end, 0.0);
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

void SceneSystem::precondition(int unit, double *b) const {
    if (unit < group_count())
        strands.solve(unit, b);
    else
        cloths[unit - group_count()].precondition(b);
}

} // namespace ringlet
