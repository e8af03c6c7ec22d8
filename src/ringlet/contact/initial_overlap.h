// Initial overlaps: pairs that begin closer than their activation distance, and from where on they push.
#pragma once

#include "ringlet/contact/contact.h"
#include "ringlet/contact/material.h"

#include <vector>

namespace ringlet {

struct InitialOverlap {
    uint64_t name;     // of the pair
    double gap;        // how close the pair began [m]; grows as it parts
    double force;      // normal force there [N]
    double activation; // distance at which it pushes from now on [m]
};

// An overlapping pair activates at its initial gap, so that nothing pops. Its activation distance then grows by a length a
// step. Or it stays, and the pair keeps the normal force that it has there, whatever the stiffness is.
class InitialOverlaps {
public:
    void clear() { all_.clear(); }
    void add(uint64_t pair, double gap, double force) { all_.push_back({pair, gap, force, gap}); } // in the order of names

    void grow(double length);

    // Forgets the pairs that have parted, and notes the force of the others. What is closer than a hundredth of its activation
    // distance can hardly move: it parts by a length a step until it is no longer.
    void settle(const std::vector<ContactPair> &pairs, const std::vector<Contact> &contacts, View<Vec3> positions,
                double length);

    // Activates each pair where its normal force balances at the present stiffness.
    void activate(const CollisionMesh &mesh, const ContactMaterial &material, const std::vector<ContactPair> &pairs);

    // Finds pairs, each after the one before in the order of names.
    class Search {
    public:
        explicit Search(View<InitialOverlap> all) : left_(all) {}
        const InitialOverlap *find(const ContactPair &pair); // null where it did not overlap, or has parted

    private:
        View<InitialOverlap> left_;
        bool begun_ = false;
    };
    Search search() const { return Search(all_); }

    const std::vector<InitialOverlap> &all() const { return all_; } // in the order of names
    void recall(std::vector<InitialOverlap> all) { all_ = std::move(all); }

private:
    std::vector<InitialOverlap> all_;
};

} // namespace ringlet
