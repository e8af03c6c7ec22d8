// The pair forces of a scene at given positions, contacts and ties, with what friction remembers from step to step.
#pragma once

#include "ringlet/contact/initial_overlap.h"
#include "ringlet/contact/material.h"
#include "ringlet/contact/tie.h"
#include "ringlet/math/lists.h"

#include <vector>

namespace ringlet {

// The slip that friction still holds as a step ends: the spring that the next step begins with.
struct FrictionState {
    uint64_t name; // of the contact
    Vec3 slip;     // [m]
};

// The normal force that friction uses next: that which the contact is expected to have.
struct LaggedForce {
    uint64_t name; // of the contact
    double force;  // [N]
};

// The force of a pair as a scene begins.
struct InitialForce {
    std::array<int, 4> vertex; // of the pair, as contacts have them
    Vec3 force;                // on the first primitive [N]: along the normal; towards the last vertex from the one before, as
                               // far as that is tangential; along the cross product of both
};

// The barrier energy of a contact at other positions than those it was found at.
struct PairEnergy {
    uint64_t name;
    std::array<int, 2> objects;
    double stiffness, barrier; // [N/m], [m²]

    double energy() const { return stiffness * barrier; } // [J]
};

class ContactSet {
public:
    InitialOverlaps overlaps;
    std::vector<Tie> ties;

    // The contact pairs before the first step are initial overlaps; some have a force.
    void begin(const CollisionMesh &mesh, const ContactMaterial &material, const std::vector<ContactPair> &pairs,
               View<InitialForce> forces, View<Vec3> positions);

    // Opens a step with the initial guess of all positions. Separations turn as it turns primitives from where the step began.
    void begin_step(std::vector<Vec3> guess) { guess_ = std::move(guess); }

    // Replaces the contacts by those of the contact pairs at `positions`; `start` says where the step began, for the slip.
    // The pairs are all that have a marked object; forces between others are remembered until they are found again.
    // The normal force of friction is lagged; it is 0 for a new contact: the force at an iterate says little of the solution.
    // With `damping`, a part of their stiffness, pairs of moving primitives are contacts even where initial overlaps do not
    // push.
    void find(const CollisionMesh &mesh, const ContactMaterial &material, const std::vector<ContactPair> &pairs,
              View<unsigned char> objects, View<Vec3> start, View<Vec3> positions, double damping = 0.0);

    // Keeps the slip of the contacts as a step ends, up to the stick length: what has slipped farther has slid.
    void commit_friction(View<Vec3> positions);

    // Barrier energies at other positions, of the contact pairs there. A pair that is a contact keeps its stiffness, so that
    // energies can be compared.
    std::vector<PairEnergy> energies(const CollisionMesh &mesh, const ContactMaterial &material,
                                     const std::vector<ContactPair> &pairs, View<Vec3> positions) const;

    const std::vector<Contact> &contacts() const { return contacts_; }
    void set_lagged_force(int contact, double force) { lagged_[contact].force = force; }

    // Pairs are the contacts, then the ties.
    int count() const { return int(contacts_.size() + ties.size()); }
    const Stencil &stencil_of(int pair) const { return is_contact(pair) ? contacts_[pair].at : tie(pair).at; }
    PairValue value(int pair, const Vec3 &separation) const {
        return is_contact(pair) ? contacts_[pair].value(separation) : tie(pair).value(separation);
    }
    bool pushes(int pair) const { // or is a tie; not only damped
        return !is_contact(pair) || contacts_[pair].gap < contacts_[pair].barrier.d_hat;
    }
    double kept_energy(int pair, const Vec3 &separation) const { // as of a contact
        return is_contact(pair) ? contacts_[pair].kept_energy(separation) : tie(pair).energy(separation);
    }

    // The pairs that act on a vertex, and as which of their four.
    struct Role {
        int pair, as;
    };
    View<Role> of(int vertex) const { return roles_.of(vertex); }
    const std::vector<int> &vertices() const { return vertices_; } // dynamic ones of pairs

    // What a step remembers, in the order of names.
    const std::vector<FrictionState> &friction() const { return friction_; }
    const std::vector<LaggedForce> &lagged_forces() const { return lagged_; }
    void recall(std::vector<FrictionState> friction) { friction_ = std::move(friction); }
    void recall(std::vector<LaggedForce> forces) { lagged_ = std::move(forces), resting_.clear(); }

private:
    bool is_contact(int pair) const { return pair < int(contacts_.size()); }
    const Tie &tie(int pair) const { return ties[pair - contacts_.size()]; }

    template <class T, class Add> std::vector<T> collect_of_pairs(const std::vector<ContactPair> &pairs, const Add &add) const;
    std::vector<Contact> linearise(const CollisionMesh &mesh, const ContactMaterial &material,
                                   const std::vector<ContactPair> &pairs, View<Vec3> start, View<Vec3> positions,
                                   double damping) const;
    void index(const CollisionMesh &mesh);

    std::vector<Vec3> guess_; // before the first step: empty
    std::vector<FrictionState> friction_;
    std::vector<Contact> contacts_;
    std::vector<LaggedForce> lagged_;  // of each contact
    std::vector<LaggedForce> resting_; // between objects that were not marked when contacts were found last
    Lists<Role> roles_;                // of vertices
    std::vector<int> vertices_;
};

} // namespace ringlet
