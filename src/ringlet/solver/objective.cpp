#include "ringlet/solver/objective.h"

#include "ringlet/math/collect.h"
#include "ringlet/math/parallel.h"
#include "ringlet/solver/settings.h"

#include <algorithm>
#include <limits>

namespace ringlet {
void ContactEnergy::remove(View<unsigned char> changed) {
    std::erase_if(barriers_, [&](const Shared &shared) { return any_marked({shared.a, shared.b}, changed); });
}

void ContactEnergy::measure_kept(View<Vec3> positions, View<unsigned char> changed) {
    parallel_for(contacts_.count(), [&](int k) {
        if (any_marked(objects_[k], changed))
            kept_[k] = contacts_.kept_energy(k, contacts_.stencil_of(k).separation(positions));
    });
}

void ContactEnergy::at_linearisation(View<Vec3> positions) {
    const std::vector<Contact> &all = contacts_.contacts();
    objects_.resize(contacts_.count());
    kept_.resize(contacts_.count());
    barriers_.resize(all.size());
    parallel_for(contacts_.count(), [&](int k) {
        objects_[k] = table_.objects_of(contacts_.stencil_of(k));
        kept_[k] = contacts_.kept_energy(k, contacts_.stencil_of(k).separation(positions));
        if (size_t(k) < all.size()) barriers_[k] = {objects_[k][0], objects_[k][1], all[k].barrier.energy_at(all[k].gap)};
    });
}

void ContactEnergy::exact(const ReachablePairs &pairs, View<Vec3> positions, View<double> traveled,
                          View<unsigned char> changed) {
    remove(changed);
    const auto dynamic = [&](int object) { return object < table_.objects ? object : -1; };
    const std::vector<ContactPair> there = contact_pairs(table_.mesh, pairs, positions, changed, traveled);
    for (const PairEnergy &pair : contacts_.energies(table_.mesh, table_.material, there, positions))
        barriers_.push_back({dynamic(pair.objects[0]), dynamic(pair.objects[1]), pair.energy()});
    measure_kept(positions, changed);
}

void ContactEnergy::add_to(std::vector<double> &of_objects) const {
    const auto share = [&](int a, int b, double energy) {
        if (a >= 0) of_objects[a] += b >= 0 ? 0.5 * energy : energy;
        if (b >= 0) of_objects[b] += a >= 0 ? 0.5 * energy : energy;
    };
    for (const Shared &barrier : barriers_) share(barrier.a, barrier.b, barrier.energy);
    for (size_t k = 0; k < kept_.size(); ++k) share(objects_[k][0], objects_[k][1], kept_[k]);
}

Objective::Objective(BlockSet &blocks_, const VertexTable &table_)
    : blocks(blocks_), table(table_), contact_energy_(table_, contacts) {}

void Objective::begin_step(const BlockStep &step, View<Vec3> positions) {
    blocks.begin_step(step);
    own_energies_.assign(table.objects, 0.0);
    positions_.assign(positions.begin(), positions.end());
}

std::vector<double> Objective::contact_stiffness(double scale, double dt) const {
    std::vector<double> stiffness(table.count(), std::numeric_limits<double>::infinity());
    for (int b = 0; b < blocks.count(); ++b) blocks[b].contact_stiffness(dt, stiffness);
    for (int v = 0; v < table.dynamic_vertices; ++v) stiffness[v] *= scale;
    return stiffness;
}

void Objective::find_contacts(const std::vector<ContactPair> &pairs, View<unsigned char> objects, View<Vec3> start,
                              View<Vec3> positions, double damping) {
    contacts.find(table.mesh, table.material, pairs, objects, start, positions, damping);
    values_.resize(contacts.count());
    couplings.find(contacts, table, blocks);
    touched_ = {size_t(blocks.count()), int(contacts.vertices().size()), [&](int k, const auto &add) {
                    const int v = contacts.vertices()[k];
                    add(blocks.block_of(table.object_of(v)), v);
                }};
    find_neighbours(objects);
}

void Objective::find_neighbours(View<unsigned char> objects) {
    std::erase_if(neighbours_, [&](const Neighbours &two) { return !two.pushes || any_marked(two.objects, objects); });
    const auto found = collect_ranges<Neighbours>(contacts.count(), [&](int begin, int end, std::vector<Neighbours> &list) {
        for (int pair = begin; pair < end; ++pair) { // most follow one of the same objects
            const std::array<int, 2> both = table.objects_of(contacts.stencil_of(pair));
            if (both[0] < 0 || both[1] < 0 || both[0] == both[1]) continue;
            if (list.empty() || list.back().objects != both) list.push_back({both, false});
            list.back().pushes |= contacts.pushes(pair);
        }
    });
    neighbours_.insert(neighbours_.end(), found.begin(), found.end());
}

std::vector<unsigned char> Objective::with_touched(const std::vector<unsigned char> &objects) const {
    std::vector<unsigned char> all = objects;
    for (const Neighbours &two : neighbours_) {
        const auto [a, b] = two.objects;
        if (objects[a]) all[b] = 1;
        if (objects[b]) all[a] = 1;
    }
    return all;
}

void Objective::evaluate(const AlignedVector &x, const std::vector<unsigned char> &changed) {
    const std::vector<unsigned char> asked = blocks.blocks_with(changed);
    blocks.for_active([&](int b) {
        if (!asked[b]) return;
        double energies[max_lanes] = {};
        blocks[b].energies(blocks.of(b, x), energies);
        blocks.from_lanes(b, energies, own_energies_);
    });
    parallel_for(table.dynamic_vertices, [&](int v) {
        if (changed[table.mesh.object[v]]) positions_[v] = blocks.position(x, v);
    });
}

std::vector<unsigned char> Objective::active_among(const std::vector<unsigned char> &objects) const {
    std::vector<unsigned char> active = blocks.active_objects();
    for (size_t object = 0; object < active.size(); ++object) active[object] &= objects[object] != 0;
    return active;
}

void Objective::sum_energies(std::vector<double> &of_objects) const {
    of_objects = own_energies_;
    for (const RecoverySpring &spring : springs)
        of_objects[table.object_of(spring.vertex)] += spring.energy(positions_[spring.vertex]);
    contact_energy_.add_to(of_objects);
}

void Objective::energies_at_linearisation(std::vector<double> &of_objects) {
    contact_energy_.at_linearisation(positions_);
    sum_energies(of_objects);
}

void Objective::exact_energies(const AlignedVector &x, const ReachablePairs &pairs, View<double> traveled,
                               const std::vector<unsigned char> &changed, std::vector<double> &of_objects) {
    evaluate(x, changed);
    contact_energy_.exact(pairs, positions_, traveled, active_among(changed));
    sum_energies(of_objects);
}

void Objective::linearise_contacts(const AlignedVector &x) {
    blocks.gather(x, positions_);
    parallel_for(contacts.count(),
                 [&](int pair) { values_[pair] = contacts.value(pair, contacts.stencil_of(pair).separation(positions_)); });
}

void Objective::assemble(int block, const AlignedVector &x) {
    Block &of = blocks[block];
    double energies[max_lanes] = {};
    of.assemble(blocks.of(block, x), energies);
    blocks.from_lanes(block, energies, own_energies_);
    for (const int v : touched_.of(block)) add_pair_forces(v, of);
    for (const RecoverySpring &spring : springs)
        if (blocks.block_of(table.object_of(spring.vertex)) == block)
            if (const double depth = spring.depth(blocks.position(x, spring.vertex)); depth > 0.0) {
                of.add_gradient(spring.vertex, -spring.stiffness * depth * spring.normal);
                of.add_block(spring.vertex, spring.vertex, spring.stiffness * spring.normal * spring.normal.transpose());
            }
}

// Of each pair what it does to the vertex, and by the vertex to those before it on the same side.
void Objective::add_pair_forces(int vertex, Block &block) const {
    Vec3 gradient = Vec3::Zero();
    Mat3 diagonal = Mat3::Zero();
    for (const auto &[pair, as] : contacts.of(vertex)) {
        const Stencil &at = contacts.stencil_of(pair);
        const auto &[energy, of_separation, hessian] = values_[pair];
        const double weight = at.weight[as];
        gradient += weight * of_separation;
        diagonal += weight * weight * hessian;
        const auto [first, end] = at.side_of(as);
        for (int i = first; i < end; ++i)
            if (const int other = at.vertex[i]; other < vertex && table.mesh.moves[other] && at.weight[i] != 0.0)
                block.add_block(vertex, other, weight * at.weight[i] * hessian);
    }
    block.add_gradient(vertex, gradient);
    block.add_block(vertex, vertex, diagonal);
}

void Objective::lag_normal_forces(const AlignedVector &direction) {
    const std::vector<Contact> &all = contacts.contacts();
    parallel_for(int(all.size()), [&](int k) {
        const Contact &c = all[k];
        if (!any_marked(table.objects_of(c.at), blocks.active_objects())) return;
        Vec3 change = Vec3::Zero();
        for (int i = 0; i < 4; ++i)
            if (table.mesh.moves[c.at.vertex[i]] && c.at.weight[i] != 0.0)
                change += c.at.weight[i] * blocks.position(direction, c.at.vertex[i]);
        const Barrier &push = c.barrier;
        const double most =
            std::max(c.force(), -push.stiffness * barrier(solver_settings::closest_gap * push.d_hat, push.d_hat, 0.0).first);
        const Vec3 pushed = values_[k].hessian * change - c.damping.coefficient * change;
        contacts.set_lagged_force(k, std::min(std::max(0.0, c.force() - push.normal.dot(pushed)), most));
    });
}

} // namespace ringlet
