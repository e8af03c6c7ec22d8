// All contacts of a scene at the present positions, and how vertices find those that act on them.
#pragma once

#include "ringlet/collision/pair_cache.h"
#include "ringlet/contact/contact.h"
#include "ringlet/math/lists.h"

#include <unordered_map>
#include <vector>

namespace ringlet {

// What the pairs of a scene are made of, per vertex of the collision mesh.
struct ContactMaterial {
    std::vector<double> stiffness; // a pair takes the softer side's [N/m]; kinematic vertices: infinity
    std::vector<int> material;     // which material a vertex is made of
    std::vector<double> friction;  // μ of a pair of materials, row-major, materials × materials
    int materials = 1;
    double give = 0.0; // [m]
};

// What a pair that touched as a step ended remembers of it.
struct Hold {
    uint64_t pair;
    Vec3 shear, normal; // [m], 1
};

class ContactSet {
public:
    // Pairs that begin nearer than their contact distance push only from there on, which then grows by `way` a step: nothing
    // pops. Or they stay, with what they bear there: they push from so much further on, whatever their stiffness. Those of
    // which it is known how they bear what they touch do so from the start. What is nearer than a hundredth of its distance
    // can hardly move, and parts by `way` a step until it is no longer.
    struct Bearing {
        std::array<int, 4> vertex; // as contacts have them
        Vec3 force;                // on the first of the two: away from the second, towards the last vertex from the one
                                   // before as far as that is across, and across both [N]
    };
    void begin(const CollisionMesh &mesh, const ContactMaterial &material, const std::vector<ContactPair> &touching,
               View<Bearing> bearing, View<Vec3> now);
    void part_early(double way);
    void stay_early(const std::vector<ContactPair> &touching, View<Vec3> now, double way);
    struct Beginning {
        double apart; // how near they began [m]
        double bears; // what they push with as near as that [N]
        double push;  // from where on they push, then [m]
    };
    using Early = std::unordered_map<uint64_t, Beginning>; // by pair
    const Early &early() const { return early_; }
    void recall(Early early) { early_ = std::move(early); }

    // What pairs that were contacts last are expected to bear, in the order of their names: friction's next normal force.
    struct Expected {
        uint64_t pair;
        double force; // [N]
    };
    const std::vector<Expected> &expected() const { return expected_; }
    void recall(std::vector<Expected> expected) { expected_ = std::move(expected); }
    // Keeps how far the contacts are sheared where a step ends. One that is sheared further than it gives has slid.
    void hold(View<Vec3> now);
    const std::vector<Hold> &held() const { return held_; } // in the order of pairs
    void recall(std::vector<Hold> held) { held_ = std::move(held); }

    // Of objects that go by planes (per object; beyond the end: none), a search knows the contacts by their planes alone, which
    // are overstepped then: their barriers end early.
    void go_by_planes(View<unsigned char> objects) { by_planes_.assign(objects.begin(), objects.end()); }

    // What pushes elsewhere, of those that touch there. What is a contact is as stiff as here, so that energies can be
    // compared.
    struct Push {
        uint64_t pair;
        std::array<int, 2> objects;
        double stiffness, potential;                            // [N/m], [m²]
        double energy() const { return stiffness * potential; } // [J]
    };
    std::vector<Push> pushing(const CollisionMesh &mesh, const ContactMaterial &material,
                              const std::vector<ContactPair> &touching, View<Vec3> elsewhere) const;

    // Goes over to the contacts of those that touch at the positions `now`; `start` says where the step began, for how they
    // were sheared since. Friction's normal force is what was expected of the pair before, nothing if it is new: what a contact
    // pushes with on the way to balance says little of what it will bear.
    void find(const CollisionMesh &mesh, const ContactMaterial &material, const std::vector<ContactPair> &touching,
              View<Vec3> start, View<Vec3> now);

    void expect(int contact, double force) { expected_[contact].force = force; }

    const std::vector<Contact> &contacts() const { return contacts_; }

    // The contacts that act on a vertex, and as which of their four.
    struct Role {
        int contact, as;
    };
    View<Role> of(int vertex) const { return roles_.of(vertex); }
    const std::vector<int> &vertices() const { return vertices_; } // those that move and have contacts

private:
    template <class Work>
    void for_pushing(const CollisionMesh &mesh, const ContactPair &touch, View<Vec3> now, const Work &work) const;
    std::vector<Contact> of_touching(const CollisionMesh &mesh, const ContactMaterial &material,
                                     const std::vector<ContactPair> &touching, View<Vec3> start, View<Vec3> now) const;
    void index(const CollisionMesh &mesh);
    bool goes_by_planes(int object) const { return size_t(object) < by_planes_.size() && by_planes_[object]; }

    Early early_;
    std::vector<Hold> held_;
    std::vector<unsigned char> by_planes_;
    std::vector<Contact> contacts_;
    std::vector<Expected> expected_; // of each of them
    Lists<Role> roles_;              // of vertices
    std::vector<int> vertices_;
};

} // namespace ringlet
