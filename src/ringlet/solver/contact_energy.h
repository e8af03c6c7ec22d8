// Contact energies shared out to the objects, cached between the trials of a line search.
#pragma once

#include "ringlet/collision/narrow_phase.h"
#include "ringlet/contact/contact_set.h"
#include "ringlet/solver/vertex_table.h"

#include <vector>

namespace ringlet {

// The barrier energy is that
//   at_linearisation  of the contacts, where they were found: their gaps are known
//   exact             of all pairs in reach, measured at the positions, be they contacts yet or not
// Friction, and the energy of ties, are those of the contacts in both. What no changed object has a part in is kept.
class ContactEnergy {
public:
    ContactEnergy(const VertexTable &table, const ContactSet &contacts) : table_(table), contacts_(contacts) {}

    void at_linearisation(View<Vec3> positions, View<unsigned char> active);

    // `traveled` says which part of its longest path each object has covered: a lower bound on gaps.
    void exact(const ReachablePairs &pairs, View<Vec3> positions, View<double> traveled, View<unsigned char> changed);

    // Adds the energies to those of the objects, half to each of two [J].
    void add_to(std::vector<double> &of_objects) const;

private:
    struct Shared {
        int a, b; // objects; −1: none, the side's motion is prescribed
        double energy;
    };
    void remove(View<unsigned char> changed);
    void measure_kept(View<Vec3> positions, View<unsigned char> changed);

    const VertexTable &table_;
    const ContactSet &contacts_;
    std::vector<Shared> barriers_;
    std::vector<std::array<int, 2>> objects_; // of each pair, as in Shared
    std::vector<double> kept_;                // of each pair: friction, or that of a tie [J]
};

} // namespace ringlet
