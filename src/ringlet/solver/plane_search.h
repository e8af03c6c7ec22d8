// A line search that knows contacts by their planes alone, before the path is limited.
#pragma once

#include "ringlet/solver/line_search.h"

namespace ringlet {

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

// Shortens the path from x to where these energies fall; false: no object has moved. `converged` directions are not searched.
bool search_by_planes(Objective &objective, const AlignedVector &x, bool converged, SearchPath &path);

} // namespace ringlet
