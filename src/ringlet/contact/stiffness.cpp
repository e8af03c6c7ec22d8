#include "ringlet/contact/stiffness.h"

#include "ringlet/math/parallel.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace ringlet {

void ContactStiffness::begin_step(std::vector<double> largest, double dt) {
    for (double &load : load_) load *= std::exp2(-dt / contact_settings::load_half_life);
    largest_ = std::move(largest);
}

bool ContactStiffness::raise_loads(const ContactSet &contacts) {
    const std::vector<Contact> &all = contacts.contacts();
    std::atomic<bool> raised = false;
    parallel_for(int(all.size()), [&](int k) {
        const double force = contacts.lagged_forces()[k].force / all[k].loaded_fraction;
        for (const int v : all[k].at.vertex) {
            const std::atomic_ref<double> load(load_[v]); // several contacts have this vertex
            double before = load.load(std::memory_order_relaxed);
            while (force > before && !load.compare_exchange_weak(before, force, std::memory_order_relaxed)) {
            }
            if (force > before) raised.store(true, std::memory_order_relaxed);
        }
    });
    return raised;
}

void ContactStiffness::set_levels(const CollisionMesh &mesh, ContactMaterial &material) const {
    material.stiffness = material.firm_stiffness = largest_;
    const int strand_vertices = int(mesh.along_curve.size());
    parallel_for(strand_vertices, [&](int v) {
        if (!mesh.moves[v]) return;
        double load = load_[v]; // a contact that slides passes on to the next vertex
        for (const int next : {v - 1, v + 1})
            if (next >= 0 && next < strand_vertices && mesh.object[next] == mesh.object[v]) load = std::max(load, load_[next]);
        const double d_hat = 2.0 * mesh.radius[v]; // of two such strands
        double enough = contact_settings::softest_level * largest_[v];
        while (enough < load / d_hat && enough < largest_[v]) enough *= contact_settings::level_factor;
        material.stiffness[v] = std::min(enough, largest_[v]);
        material.firm_stiffness[v] = std::max(material.stiffness[v], contact_settings::firm_level * largest_[v]);
    });
}

} // namespace ringlet
