#include "ringlet/contact/stiffness.h"

#include <algorithm>
#include <cmath>

namespace ringlet {

void ContactStiffness::begin_step(std::vector<double> largest, double dt) {
    for (double &load : load_) load *= std::exp2(-dt / contact_settings::load_half_life);
    largest_ = std::move(largest);
    carried_ = load_;
}

bool ContactStiffness::update_loads(const ContactSet &contacts) {
    const std::vector<Contact> &all = contacts.contacts();
    const std::vector<double> before = load_;
    load_ = carried_;
    for (size_t k = 0; k < all.size(); ++k)
        for (const int v : all[k].vertex) {
            const double force = contacts.lagged_forces()[k].force / all[k].loaded_fraction;
            load_[v] = std::max(load_[v], force);
        }
    return load_ != before;
}

std::vector<double> ContactStiffness::levels(const CollisionMesh &mesh) const {
    std::vector<double> stiffness = largest_;
    const int strand_vertices = int(mesh.along_strand.size());
    for (int v = 0; v < strand_vertices; ++v) {
        if (!mesh.moves[v]) continue;
        double load = load_[v]; // a contact that slides passes on to the next vertex
        for (const int next : {v - 1, v + 1})
            if (next >= 0 && next < strand_vertices && mesh.object[next] == mesh.object[v]) load = std::max(load, load_[next]);
        const double d_hat = 2.0 * mesh.radius[v]; // of two such strands
        double enough = contact_settings::softest_level * largest_[v];
        while (enough < load / d_hat && enough < largest_[v]) enough *= contact_settings::level_factor;
        stiffness[v] = std::min(enough, largest_[v]);
    }
    return stiffness;
}

} // namespace ringlet
