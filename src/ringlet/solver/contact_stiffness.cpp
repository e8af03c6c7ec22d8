#include "ringlet/solver/contact_stiffness.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ringlet {

void ContactStiffness::begin(const SceneSystem &system, double scale, double dt) {
    constexpr double half_forgotten = 0.25; // [s]
    for (double &borne : borne_) borne *= std::exp2(-dt / half_forgotten);
    const SceneVertices &vertices = system.vertices;
    const StrandModel &model = system.model;
    hardest_.assign(vertices.count(), std::numeric_limits<double>::infinity());
    for (int v = 0; v < vertices.strand_vertices(); ++v) {
        if (model.held[v]) continue;
        const double length = std::max(model.rest_length[v], model.rest_length[v - 1]);
        const double bend = std::max(model.bend_stiffness[v], model.bend_stiffness[v - 1]) / (length * length);
        hardest_[v] = scale * (model.mass[v] / (dt * dt) + bend + 0.1 * model.stretch_stiffness[v - 1]);
    }
    for (int v = vertices.strand_vertices(); v < vertices.moving_vertices(); ++v) {
        const int cloth = vertices.part_of(v) - vertices.strands;
        if (vertices.mesh.moves[v]) hardest_[v] = scale * system.cloths[cloth].stiffness(v - vertices.cloths[cloth], dt);
    }
}

bool ContactStiffness::bear(const ContactSet &contacts) {
    const std::vector<Contact> &all = contacts.contacts();
    bool more = false;
    for (size_t k = 0; k < all.size(); ++k)
        for (const int v : all[k].vertex) {
            const double force = contacts.expected()[k].force / all[k].room;
            if (force > borne_[v]) borne_[v] = force, more = true;
        }
    return more;
}

std::vector<double> ContactStiffness::needed(const SceneVertices &vertices, double distance) const {
    constexpr double softest = 0.01, level = 10.0;
    std::vector<double> stiffness = hardest_;
    for (int v = 0; v < vertices.strand_vertices(); ++v) {
        if (!vertices.mesh.moves[v]) continue;
        double borne = borne_[v]; // what slides along goes on from one to the next
        for (const int other : {v - 1, v + 1})
            if (other < vertices.strand_vertices() && vertices.mesh.object[other] == vertices.mesh.object[v])
                borne = std::max(borne, borne_[other]);
        double enough = softest * hardest_[v];
        while (enough < borne / distance && enough < hardest_[v]) enough *= level;
        stiffness[v] = std::min(enough, hardest_[v]);
    }
    return stiffness;
}

} // namespace ringlet
