// Backtracking Armijo line search along the limited path, with one step length per cluster of objects in contact.
#pragma once

#include "ringlet/collision/narrow_phase.h"
#include "ringlet/solver/objective.h"
#include "ringlet/solver/search_path.h"

namespace ringlet {

// These objects, and those in contact with one of them.
std::vector<unsigned char> with_touched(const Objective &objective, const std::vector<unsigned char> &objects);

struct LineSearchResult {
    bool moved = false;       // false: no object found a step on which the energy falls
    int cuts = 0;             // of step lengths
    std::vector<double> step; // per object
};

// Energies along a path in one of the models of contact_energy.h.
class SearchModel {
public:
    virtual ~SearchModel() = default;
    virtual void at_start(std::vector<double> &of_objects) = 0;
    virtual void at(const AlignedVector &x, const std::vector<double> &step, const std::vector<unsigned char> &changed,
                    std::vector<double> &of_objects) = 0;
};

// The energy itself, of all pairs that may come into contact on the last move.
class ExactModel final : public SearchModel {
public:
    ExactModel(Objective &objective, ReachablePairs pairs) : objective_(objective), pairs_(std::move(pairs)) {}
    void at_start(std::vector<double> &of_objects) override { objective_.energies_at_linearisation(of_objects); }
    void at(const AlignedVector &x, const std::vector<double> &step, const std::vector<unsigned char> &changed,
            std::vector<double> &of_objects) override;

private:
    Objective &objective_;
    ReachablePairs pairs_;
};

// Moves x along the path as far as each object may. One that touches nothing dynamic halves its step, later quarters it, until
// its energy decreases sufficiently. Of a cluster only the sum of energies must. Else those whose own energy rises take a
// shorter step, and with them those that they touch: a direction's effects on both sides of a contact belong together. A
// cluster whose limited path leads uphill stays. `accepted` objects take their whole path, whatever their energy.
LineSearchResult line_search(Objective &objective, SearchModel &model, const SearchPath &path,
                             const std::vector<unsigned char> &accepted, AlignedVector &x);

// A cloth that is limited here and there is strained there, and its energy rises for once. So a cloth and what touches it are
// searched before the limiter; the contacts' planes stand for it. What touches these in turn takes part: were it to take its
// whole step, none of the cloth's would lead downhill, and it would stand still. Between strands the quadratic model stands: by
// planes, which iterates cross, nearly all hair that touches hair and somewhere a cloth would stay.
class PlaneModel final : public SearchModel {
public:
    PlaneModel(Objective &objective, View<unsigned char> ignored) : objective_(objective), ignored_(ignored) {}
    void at_start(std::vector<double> &of_objects) override {
        objective_.linearised_energies_at_linearisation(ignored_, of_objects);
    }
    void at(const AlignedVector &x, const std::vector<double> &, const std::vector<unsigned char> &changed,
            std::vector<double> &of_objects) override {
        objective_.linearised_energies(x, ignored_, changed, of_objects);
    }

private:
    Objective &objective_;
    View<unsigned char> ignored_; // objects whose search comes later
};

// Shortens the path from x to where these energies fall; false: no object has moved. Those of `converged`
// objects are not searched.
bool search_by_planes(Objective &objective, const AlignedVector &x, const std::vector<unsigned char> &converged,
                      SearchPath &path);

} // namespace ringlet
