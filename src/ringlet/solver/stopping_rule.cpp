#include "ringlet/solver/stopping_rule.h"

#include <algorithm>

namespace ringlet {

void StoppingRule::measure(const Objective &objective, const std::vector<double> &largest) {
    const std::vector<int> &cluster = objective.couplings.clusters();
    const size_t objects = converged_.size();
    std::vector<unsigned char> small(objects, 1), before(objects, 1); // of clusters
    for (const Contact &contact : objective.contacts.contacts())
        if (contact.damping.coefficient > 0.0) small[cluster[objective.table.object_of(contact.at.vertex[0])]] = 0;
    for (size_t o = 0; o < objects; ++o) {
        small[cluster[o]] &= largest[o] <= tolerance_;
        before[cluster[o]] &= converged_[o];
    }
    part_.assign(objects, 1.0);
    for (size_t o = 0; o < objects; ++o) {
        converged_[o] = small[cluster[o]];
        if (small[cluster[o]] && before[cluster[o]]) part_[o] = 0.0;
    }
}

bool StoppingRule::all_converged() const { return std::count(converged_.begin(), converged_.end(), 0) == 0; }

} // namespace ringlet
