// Initial overlaps: pairs that begin closer than their activation distance, and from where on they push.
#pragma once

#include "ringlet/contact/contact.h"
#include "ringlet/contact/stencil.h"

#include <unordered_map>
#include <vector>

namespace ringlet {

struct InitialOverlap {
    double gap;        // how close the pair began [m]; grows as it parts
    double force;      // normal force there [N]
    double activation; // distance at which it pushes from now on [m]
};

// An overlapping pair activates at its initial gap, so that nothing pops. Its activation distance then grows by a length a
// step. Or it stays, and the pair keeps the normal force that it has there, whatever the stiffness is.
class InitialOverlaps {
public:
    using Pairs = std::unordered_map<uint64_t, InitialOverlap>; // by the name of the pair

    void clear() { pairs_.clear(); }
    void add(uint64_t pair, double gap, double force) { pairs_[pair] = {gap, force, gap}; }

    void grow(double length);

    // Forgets the pairs that have parted, and notes the force of the others. What is closer than a hundredth of its activation
    // distance can hardly move: it parts by a length a step until it is no longer.
    void settle(const std::vector<ContactPair> &pairs, const std::vector<Contact> &contacts, View<Vec3> positions,
                double length);

    // Activates each pair where its normal force balances at the present stiffness.
    void activate(const CollisionMesh &mesh, const ContactMaterial &material, const std::vector<ContactPair> &pairs);

    const InitialOverlap *find(const ContactPair &pair) const; // null where it did not overlap, or has parted

    const Pairs &pairs() const { return pairs_; }
    void recall(Pairs pairs) { pairs_ = std::move(pairs); }

private:
    Pairs pairs_;
};

} // namespace ringlet
