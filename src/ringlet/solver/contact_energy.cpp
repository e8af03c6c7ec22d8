#include "ringlet/solver/contact_energy.h"

#include "ringlet/math/collect.h"

#include <algorithm>

namespace ringlet {
namespace {

// Whether one of two objects is marked; −1 is none.
bool either(View<unsigned char> marked, int a, int b) { return (a >= 0 && marked[a] != 0) || (b >= 0 && marked[b] != 0); }

} // namespace

void ContactEnergy::remove(View<unsigned char> changed) {
    std::erase_if(barriers_, [&](const Shared &shared) { return either(changed, shared.a, shared.b); });
}

void ContactEnergy::measure_kept(View<Vec3> positions, View<unsigned char> changed) {
#pragma omp parallel for schedule(static)
    for (int k = 0; k < contacts_.count(); ++k)
        if (const auto [a, b] = objects_[k]; either(changed, a, b))
            kept_[k] = contacts_.kept_energy(k, contacts_.stencil_of(k).separation(positions));
}

void ContactEnergy::at_linearisation(View<Vec3> positions, View<unsigned char> active) {
    objects_.resize(contacts_.count());
    kept_.assign(contacts_.count(), 0.0);
#pragma omp parallel for schedule(static)
    for (int k = 0; k < contacts_.count(); ++k) objects_[k] = table_.objects_of(contacts_.stencil_of(k));
    remove(active);
    const std::vector<Contact> &all = contacts_.contacts();
    const std::vector<Shared> of_active = collect<Shared>(int(all.size()), [&](int k, std::vector<Shared> &barriers) {
        if (const auto [a, b] = objects_[k]; either(active, a, b))
            barriers.push_back({a, b, all[k].barrier.energy_at(all[k].gap)});
    });
    barriers_.insert(barriers_.end(), of_active.begin(), of_active.end());
    measure_kept(positions, active);
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

} // namespace ringlet
