// The objective of a step: the energy of all blocks and contacts, per object, with its gradient and its Hessian A = P + C.
// P is block-diagonal: each block's own Hessian with what contacts do within each of their sides. C couples the sides.
#pragma once

#include "ringlet/collision/narrow_phase.h"
#include "ringlet/math/types.h"
#include "ringlet/solver/block_set.h"
#include "ringlet/solver/couplings.h"

#include <algorithm>
#include <vector>

namespace ringlet {

// A one-sided spring that draws a vertex out of a body that it began in.
// Energy ½ k (h − n · x)² below the plane n · x = h, none above. Implicit, it lifts no farther, however stiff it is.
struct RecoverySpring {
    int vertex;
    Vec3 normal;              // n
    double height, stiffness; // h [m], k [N/m]

    double depth(const Vec3 &x) const { return std::max(height - normal.dot(x), 0.0); } // [m]
    double energy(const Vec3 &x) const { return 0.5 * stiffness * depth(x) * depth(x); }
};

// Contact energies shared out to the objects, cached between the trials of a line search.
// The barrier energy is that
//   at_linearisation  of the contacts, where they were found: their gaps are known
//   exact             of all pairs in reach, measured at the positions, be they contacts yet or not
// Friction, and the energy of ties, are those of the contacts in both. What no changed object has a part in is kept.
class ContactEnergy {
public:
    ContactEnergy(const VertexTable &table, const ContactSet &contacts) : table_(table), contacts_(contacts) {}

    void at_linearisation(View<Vec3> positions);

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

class Objective {
public:
    Objective(BlockSet &blocks, const VertexTable &table);

    BlockSet &blocks;
    const VertexTable &table;
    ContactSet contacts;
    Couplings couplings; // C
    std::vector<RecoverySpring> springs;

    // Opens a step; `positions` are those of all vertices, of which the prescribed ones have arrived.
    void begin_step(const BlockStep &step, View<Vec3> positions);

    // The largest stiffness of each vertex against contacts, `scale` times that of its block [N/m]; infinite where prescribed.
    std::vector<double> contact_stiffness(double scale, double dt) const;

    // Replaces the contacts by those of the contact pairs at `positions`, which are all that have one of `objects`, of which
    // all active ones must be; the step began at `start`. The Hessian damps the relative motion of strands by `damping`, a part
    // of the contacts' stiffness (Levenberg 1944).
    void find_contacts(const std::vector<ContactPair> &pairs, View<unsigned char> objects, View<Vec3> start,
                       View<Vec3> positions, double damping = 0.0);

    // These objects, and those in contact with one of them, where contacts were found last.
    std::vector<unsigned char> with_touched(const std::vector<unsigned char> &objects) const;

    // Objects that a factor of their own solves: exact blocks that nothing couples.
    bool is_alone(int object) const { return blocks.of_object(object).is_exact() && !couplings.couples(object); }

    // Energies [J] of the objects, in one of the models of contact_energy.h. Those at the linearisation come first after
    // contacts were found and the system assembled; later only objects that have `changed` since are evaluated.
    void energies_at_linearisation(std::vector<double> &of_objects);
    void exact_energies(const AlignedVector &x, const ReachablePairs &pairs, View<double> traveled,
                        const std::vector<unsigned char> &changed, std::vector<double> &of_objects);

    // Linearises the contacts at x, before blocks are assembled there.
    void linearise_contacts(const AlignedVector &x);
    // Gradient and P of a block at x.
    void assemble(int block, const AlignedVector &x);
    const std::vector<PairValue> &pair_values() const { return values_; }
    const Vec3 &position(int vertex) const { return positions_[vertex]; } // where energies or contacts were evaluated last

    // Lags the normal forces: those that the contacts' matrix gives at the end of the search direction, where all forces
    // balance. Between objects that are not active they stay. They are limited to what a small gap would give, since little of
    // the direction may be taken.
    void lag_normal_forces(const AlignedVector &direction);

private:
    void find_neighbours(View<unsigned char> objects);
    void add_pair_forces(int vertex, Block &block) const;
    void evaluate(const AlignedVector &x, const std::vector<unsigned char> &changed);
    std::vector<unsigned char> active_among(const std::vector<unsigned char> &objects) const;
    void sum_energies(std::vector<double> &of_objects) const;

    std::vector<PairValue> values_;
    ContactEnergy contact_energy_;
    Lists<int> touched_; // vertices that contacts act on, of blocks
    struct Neighbours {
        std::array<int, 2> objects;
        bool pushes; // or is damped
    };
    std::vector<Neighbours> neighbours_;
    std::vector<double> own_energies_; // per object, without contacts
    std::vector<Vec3> positions_;      // of all vertices, where energies were evaluated last
};

} // namespace ringlet
