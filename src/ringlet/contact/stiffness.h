// Contact stiffness, in levels: each vertex is as stiff as its load asks for.
#pragma once

#include "ringlet/contact/contact_set.h"

#include <vector>

namespace ringlet {

// Were contacts always as stiff as the largest load needs, dense hair would stand still: nearly every search direction leads
// into a new contact whose energy is thousands of times that of the motion. A strand's vertex is a hundredth as stiff as it may
// have to be, a tenth where its load is more than that can carry, and all of it where it must. With so few levels a step has
// one solution, whatever iterates lead to it.
class ContactStiffness {
public:
    explicit ContactStiffness(int vertices) : load_(vertices, 0.0) {}

    // Opens a step of dt [s] with the largest stiffness of each vertex [N/m], infinite where it is prescribed. Loads decay
    // slowly: hair that rests on hair must not become soft, sink in and become stiff again.
    void begin_step(std::vector<double> largest, double dt);

    // Loads become the lagged normal forces of the contacts, where those are larger than what the step began with; returns
    // whether one has changed. A force that only an early iterate had leaves no trace in the solution.
    bool update_loads(const ContactSet &contacts);

    const std::vector<double> &largest() const { return largest_; }

    std::vector<double> levels(const CollisionMesh &mesh) const; // per vertex [N/m]

    const std::vector<double> &loads() const { return load_; } // per vertex, decayed: the largest force of a contact [N]
    void recall(std::vector<double> loads) { load_ = std::move(loads); }

private:
    std::vector<double> largest_, carried_, load_;
};

} // namespace ringlet
