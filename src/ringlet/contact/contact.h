// A contact: the pair forces between two primitives, linearised at their closest points.
#pragma once

#include "ringlet/contact/barrier.h"
#include "ringlet/contact/damping.h"
#include "ringlet/contact/friction.h"
#include "ringlet/contact/stencil.h"

#include <cstdint>

namespace ringlet {

struct Contact {
    Stencil at;
    uint64_t name;          // of the pair of primitives, and of the place on it
    double gap;             // where it was linearised [m]
    double loaded_fraction; // of the activation distance, over which it takes up its load; below 1 for initial overlaps
    Barrier barrier;
    Friction friction;
    Damping damping;

    double force() const { return barrier.force(gap); } // normal force where it was linearised [N]

    // Energy besides that of the barrier, which is known for pairs that are no contacts as well.
    double kept_energy(const Vec3 &s) const { return friction.energy(s) + damping.energy(s); }
    double energy(const Vec3 &s) const { return barrier.energy(s) + kept_energy(s); }
    PairValue value(const Vec3 &s) const {
        PairValue sum = barrier.value(s);
        sum += friction.value(s);
        sum += damping.value(s);
        return sum;
    }
};
static_assert(PairForce<Contact>);

} // namespace ringlet
