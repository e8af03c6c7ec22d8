// What Newton's method works on: the unknowns of strands and cloths in one vector, and of the energy of all of them, contacts
// included, its parts, its gradient and its matrix A = P + C. P is what every part has for itself, with what contacts do to
// each of their sides alone; C is what they do from side to side.
#pragma once

#include "ringlet/cloth/coupled_cloth.h"
#include "ringlet/solver/couplings.h"
#include "ringlet/solver/lift.h"
#include "ringlet/solver/scene_vertices.h"
#include "ringlet/strand/coupled_strands.h"

#include <numeric>
#include <vector>

namespace ringlet {

class SceneSystem {
public:
    SceneSystem(const StrandModel &model, const std::vector<SceneCloth> &cloths, const SceneVertices &vertices);

    CoupledStrands strands;
    std::vector<CoupledCloth> cloths;
    ContactSet contacts;
    Couplings couplings;     // C
    std::vector<Lift> lifts; // of vertices of strands
    const SceneVertices &vertices;
    const StrandModel &model;

    // Opens a step of the strands; each cloth has its own begin(). `given` says where what is kinematic is, of all vertices.
    void begin(const StrandArrays &arrays, const StrandStep &step, View<Vec3> given);

    std::vector<unsigned char> active; // per unit; the others stay where they are, and are not asked
    bool is_active(int part) const { return active[unit_of(part)]; }
    std::vector<unsigned char> active_parts() const;

    // Units are what is computed at once, each with its range of the unknowns: groups of strands, then cloths.
    int group_count() const { return strands.group_count(); }
    int unit_count() const { return group_count() + int(cloths.size()); }
    int unit_of(int part) const { return unit_of_[part]; }
    size_t unit_begin(int unit) const {
        return unit < group_count() ? strands.group_begin(unit)
                                    : strands.size() + 3 * size_t(vertices.cloths[unit - group_count()] - vertices.cloths[0]);
    }
    size_t unit_end(int unit) const {
        return unit < group_count() ? strands.group_end(unit) : unit_begin(unit) + cloths[unit - group_count()].size();
    }
    size_t size() const { return strands.size() + 3 * size_t(vertices.cloths.back() - vertices.cloths[0]); }
    // Groups of strands forwards or backwards, then cloths.
    template <class Work> void for_units(const Work &work, bool backwards = false) const {
#pragma omp parallel for schedule(dynamic)
        for (int k = 0; k < group_count(); ++k)
            if (const int u = backwards ? group_count() - 1 - k : k; active[u]) work(u);
        for (int u = group_count(); u < unit_count(); ++u)
            if (active[u]) work(u); // parallel inside
    }
    // Σ over units of what `of` says, in a fixed order.
    template <class Of> double sum(const Of &of) const {
        std::vector<double> values(unit_count(), 0.0);
        for_units([&](int u) { values[u] = of(u); });
        return std::accumulate(values.begin(), values.end(), 0.0);
    }

    // Coordinate k of a part's vertex stands at slot + k · stride; a strand's may have more than three.
    size_t slot(int vertex) const {
        const int in_cloths = vertex - vertices.strand_vertices();
        return in_cloths < 0 ? strands.slot(vertex) : strands.size() + 3 * size_t(in_cloths);
    }
    size_t stride(int vertex) const { return vertex < vertices.strand_vertices() ? strands.stride() : 1; }
    int freedoms(int vertex) const {
        return vertex < vertices.strand_vertices() ? strands.system(unit_of(vertices.part_of(vertex))).freedoms() : 3;
    }
    Vec3 position(const AlignedVector &at, int vertex) const {
        if (vertex >= vertices.moving_vertices()) return given_[vertex];
        const size_t first = slot(vertex), step = stride(vertex);
        return {at[first], at[first + step], at[first + 2 * step]};
    }
    void gather(const AlignedVector &at, std::vector<Vec3> &into) const; // positions of the vertices of parts
    void scatter(View<Vec3> from, AlignedVector &into) const;

    // Goes over to the contacts of what touches where everything is now.
    void touch(const std::vector<ContactPair> &touching, View<Vec3> now);
    // Of a cloth P has no more than an incomplete factor: it counts as coupled whatever touches it.
    bool is_alone(int part) const { return part < vertices.strands && !couplings.couples(part); }
    bool any_coupled() const { return !cloths.empty() || couplings.count() > 0; } // their own factors do not solve all
    const std::vector<int> &clusters() const { return couplings.clusters(); }
    // Per part, whether it is a cloth or touches one, so that a search goes by planes: see scene_search.h.
    const std::vector<unsigned char> &by_planes() const { return by_planes_; }

    // Energies [J] of the parts at x, somewhere on the last move: each with its share of what pushes there, be it a contact yet
    // or not (without `pairs`, all that may touch there: of what its contacts push, by their planes if it goes by these and
    // otherwise expanded where they were found), and of the contacts' friction. Contacts of parts that are `undecided` do not
    // count; none are if it is empty. `gone` says which part of its way each part is there. Only parts that have `changed`
    // since this was last asked, or since they were assembled, are asked again, and contacts only of these. What is asked first
    // after contacts were found has to be asked there.
    void energies(const AlignedVector &x, const ReachablePairs *pairs, View<unsigned char> undecided,
                  const std::vector<double> &gone, const std::vector<unsigned char> &changed, std::vector<double> &of_parts);

    void linearise(const AlignedVector &x);               // the contacts, before units are assembled
    void assemble(int unit, const AlignedVector &x);      // its own energy, the gradient and A
    double gradient(size_t i, int unit) const;            // its entry i of the whole vector, which is the unit's; 0 of padding
    void negative_gradient(int unit, double *into) const; // all that the unit has of a vector, as below

    // Expects the contacts to bear what they push with where the direction ends, by their matrix: there, all forces balance. No
    // more than they could bear when near, though, of a direction of which little may be gone.
    void expect(const AlignedVector &direction);

    void factor(int unit);                        // of P, exactly or nearly
    void precondition(int unit, double *b) const; // by it, in place

    // Numbers of a unit's parts, a lane each (lane_vectors.h).
    void to_lanes(int unit, const std::vector<double> &of_parts, double *of_lanes) const;
    void from_lanes(int unit, const double *of_lanes, std::vector<double> &of_parts) const;

    const std::vector<ContactValue> &values() const { return values_; } // of the contacts

private:
    void find_planes(const std::vector<ContactPair> &touching);
    void share_contacts(const ReachablePairs *pairs, View<unsigned char> undecided, const std::vector<double> &gone,
                        const std::vector<unsigned char> &changed);
    void evaluate(int unit, const AlignedVector &x, bool to_assemble); // its own energies
    void add_to_strand(int vertex);
    void add_lift(const Lift &lift, const AlignedVector &x);
    void add_to_cloth(int vertex);

    View<Vec3> given_;
    std::vector<int> unit_of_; // per part
    std::vector<ContactValue> values_;
    Lists<int> touched_;                   // vertices that contacts act on, of units
    std::vector<unsigned char> by_planes_; // per part
    std::vector<double> own_energies_;     // per part, without contacts
    std::vector<Vec3> places_;             // of all vertices, where energies were asked last
    struct Shared {                        // by two parts; −1: by one and what is kinematic
        int a, b;
        double energy; // [J]
    };
    std::vector<Shared> pushed_;  // where energies were asked last
    std::vector<double> rubbed_;  // the contacts' friction there [J]
    bool contacts_found_ = false; // since then
    bool asked_planes_ = false;   // what pushed
};

} // namespace ringlet
