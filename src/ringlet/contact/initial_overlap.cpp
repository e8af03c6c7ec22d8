#include "ringlet/contact/initial_overlap.h"

#include <algorithm>

namespace ringlet {
namespace {

uint64_t name(const ContactPair &pair) { return contact_name(pair); }

} // namespace

void InitialOverlaps::grow(double length) {
    for (InitialOverlap &overlap : all_) overlap.activation = overlap.gap += length;
}

void InitialOverlaps::settle(const std::vector<ContactPair> &pairs, const std::vector<Contact> &contacts, View<Vec3> positions,
                             double length) {
    for (InitialOverlap &overlap : all_) overlap.force = 0.0;
    for_known(
        all_, contacts, [](const Contact &contact) { return pair_of(contact.name); },
        [&](InitialOverlap &overlap, const Contact &contact) {
            overlap.force += contact.barrier.force(contact.barrier.normal.dot(contact.at.separation(positions)));
        });
    std::vector<InitialOverlap> left;
    for_known(all_, pairs, name, [&](const InitialOverlap &overlap, const ContactPair &pair) {
        left.push_back(overlap);
        const double least = contact_settings::least_gap * pair.d_hat;
        if (overlap.gap < least) left.back().gap = std::min(overlap.gap + length, least);
    });
    all_ = std::move(left);
}

void InitialOverlaps::activate(const CollisionMesh &mesh, const ContactMaterial &material,
                               const std::vector<ContactPair> &pairs) {
    parallel_for_known(all_, pairs, name, [&](InitialOverlap &overlap, const ContactPair &pair) {
        const double stiffness = pair_stiffness(mesh, stencil(mesh, pair, pair.closest), material);
        overlap.activation = activation_distance(overlap.force / stiffness, overlap.gap);
    });
}

const InitialOverlap *InitialOverlaps::Search::find(const ContactPair &pair) {
    const auto is_before = [](const InitialOverlap &overlap, uint64_t name) { return overlap.name < name; };
    const uint64_t name = contact_name(pair);
    if (!begun_) left_ = left_.subspan(std::lower_bound(left_.begin(), left_.end(), name, is_before) - left_.begin());
    begun_ = true;
    while (!left_.empty() && is_before(left_.front(), name)) left_ = left_.subspan(1);
    return !left_.empty() && left_.front().name == name && left_.front().gap < pair.d_hat ? &left_.front() : nullptr;
}

} // namespace ringlet
