#include "ringlet/contact/contact_set.h"

#include "ringlet/contact/collect.h"

#include <algorithm>
#include <cmath>

namespace ringlet {
namespace {

uint64_t name(const Touch &touch) {
    return uint64_t(touch.of_edges) << 63 | uint64_t(touch.of[0]) << 32 | uint64_t(touch.of[1]);
}

} // namespace

void ContactSet::begin(const std::vector<Touch> &touching) {
    early_.clear();
    for (const Touch &touch : touching) early_[name(touch)] = std::sqrt(touch.nearest.distance2);
}

void ContactSet::part_early(double way) {
    for (auto &[pair, distance] : early_) distance += way;
}

void ContactSet::find(const CollisionMesh &mesh, const ContactMaterial &material, const std::vector<Touch> &touching,
                      View<Vec3> start, View<Vec3> now) {
    contacts_ = collect<Contact>(int(touching.size()), [&](int k, std::vector<Contact> &contacts) {
        const Touch &touch = touching[k];
        const double apart = std::sqrt(touch.nearest.distance2);
        const auto early = early_.find(name(touch));
        const double distance = early == early_.end() ? touch.distance : std::min(touch.distance, early->second);
        if (!(apart > 0.0)) return;
        Contact contact{};
        with_vertices(mesh, touch, [&](const auto &a, const auto &b) {
            std::copy(a.begin(), a.end(), contact.vertex.begin());
            std::copy(b.begin(), b.end(), contact.vertex.begin() + a.size());
            contact.first = int(a.size());
        });
        contact.weight = touch.nearest.weights;
        contact.distance = distance;
        contact.barrier_end = std::min(std::clamp(0.25 * apart, touch.distance / 2000, touch.distance / 64), distance / 64);
        contact.normal = separation(contact, now) / apart;
        contact.start = separation(contact, start);
        double softness[2] = {0.0, 0.0};
        for (int i = 0; i < 4; ++i)
            softness[i >= contact.first] += std::abs(contact.weight[i]) / material.stiffness[contact.vertex[i]];
        contact.stiffness = 1.0 / std::max({softness[0], softness[1], 1e-12});
        contact.friction =
            material.friction[material.material[contact.vertex[0]] * material.materials + material.material[contact.vertex[3]]];
        contact.creep = material.creep;
        contact.force = contact_force(contact, separation(contact, now));
        contacts.push_back(contact);
    });
    index(mesh);
}

void ContactSet::index(const CollisionMesh &mesh) {
    const int vertices = int(mesh.moves.size());
    role_begin_.assign(vertices + 1, 0);
    for (const Contact &c : contacts_)
        for (int i = 0; i < 4; ++i)
            if (mesh.moves[c.vertex[i]] && c.weight[i] != 0.0) ++role_begin_[c.vertex[i] + 1];
    vertices_.clear();
    for (int v = 0; v < vertices; ++v) {
        if (role_begin_[v + 1] > 0) vertices_.push_back(v);
        role_begin_[v + 1] += role_begin_[v];
    }
    roles_.resize(role_begin_.back());
    std::vector<int> next(role_begin_.begin(), role_begin_.end() - 1);
    for (int k = 0; k < int(contacts_.size()); ++k)
        for (int i = 0; i < 4; ++i)
            if (mesh.moves[contacts_[k].vertex[i]] && contacts_[k].weight[i] != 0.0)
                roles_[next[contacts_[k].vertex[i]]++] = {k, i};
}

} // namespace ringlet
