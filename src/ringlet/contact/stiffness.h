// Contact stiffness, in levels: each vertex is as stiff as its load asks for.
#pragma once

#include "ringlet/contact/contact_set.h"

#include <vector>

namespace ringlet {

// Were contacts always as stiff as the largest load needs, dense hair would stand still: nearly every search direction leads
// into a new contact whose energy is thousands of times that of the motion. A strand's vertex is a thousandth as stiff as it
// may have to be; a hundredth, a tenth or all of it where its load is more than that can carry. With so few levels a step has
// one solution, whatever iterates lead to it.
class ContactStiffness {
public:
    explicit ContactStiffness(int vertices) : load_(vertices, 0.0) {}

    // Opens a step of dt [s] with the largest stiffness of each vertex [N/m], infinite where it is prescribed. Loads decay
    // slowly: hair that rests on hair must not become soft, sink in and become stiff again.
    void begin_step(std::vector<double> largest, double dt);

    // Raises loads to the lagged normal forces of the contacts; returns whether one has risen. None falls within a step.
    bool raise_loads(const ContactSet &contacts);

    const std::vector<double> &largest() const { return largest_; }

    // Sets the stiffness of every vertex. Against a cloth or a body it is not as soft as between strands.
    void set_levels(const CollisionMesh &mesh, ContactMaterial &material) const;

    const std::vector<double> &loads() const { return load_; } // per vertex, decayed: the largest force of a contact [N]
    void recall(std::vector<double> loads) { load_ = std::move(loads); }

private:
    std::vector<double> largest_, load_;
};

} // namespace ringlet
