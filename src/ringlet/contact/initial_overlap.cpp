#include "ringlet/contact/initial_overlap.h"

#include <algorithm>

namespace ringlet {

void InitialOverlaps::grow(double length) {
    for (auto &[name, overlap] : pairs_) overlap.activation = overlap.gap += length;
}

void InitialOverlaps::settle(const std::vector<ContactPair> &pairs, const std::vector<Contact> &contacts, View<Vec3> positions,
                             double length) {
    for (auto &[name, overlap] : pairs_) overlap.force = 0.0;
    for (const Contact &contact : contacts) {
        const auto found = pairs_.find(pair_of(contact.pair));
        if (found != pairs_.end()) found->second.force += normal_force(contact, separation(contact, positions));
    }
    Pairs left;
    for (const ContactPair &pair : pairs) {
        const auto found = pairs_.find(contact_name(pair));
        if (found == pairs_.end()) continue;
        InitialOverlap &overlap = left[found->first] = found->second;
        const double least = contact_settings::least_gap * pair.d_hat;
        if (overlap.gap < least) overlap.gap = std::min(overlap.gap + length, least);
    }
    pairs_ = std::move(left);
}

void InitialOverlaps::activate(const CollisionMesh &mesh, const ContactMaterial &material,
                               const std::vector<ContactPair> &pairs) {
    for (const ContactPair &pair : pairs) {
        const auto found = pairs_.find(contact_name(pair));
        if (found == pairs_.end()) continue;
        InitialOverlap &overlap = found->second;
        const double stiffness = pair_stiffness(mesh, stencil(mesh, pair, pair.closest), material);
        overlap.activation = activation_distance(overlap.force / stiffness, overlap.gap);
    }
}

const InitialOverlap *InitialOverlaps::find(const ContactPair &pair) const {
    const auto found = pairs_.find(contact_name(pair));
    return found != pairs_.end() && found->second.gap < pair.d_hat ? &found->second : nullptr;
}

} // namespace ringlet
