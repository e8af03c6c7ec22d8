#include "ringlet/solver/newton_rules.h"

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

void Stall::add_steps(const BlockSet &blocks, const std::vector<int> &cluster, const std::vector<double> &step, bool extra) {
    const int objects = int(step.size());
    std::vector<unsigned char> moved(objects, 0); // clusters
    for (int o = 0; o < objects; ++o) moved[cluster[o]] |= blocks.is_active(o) && step[o] > 0.0;
    for (int o = 0; o < objects; ++o) {
        if (!blocks.is_active(o)) continue;
        moved_[o] |= step[o] > 0.0;
        stuck_[o] = step[o] == 0.0 && (extra || cautious_[o]);
        cautious_[o] = !moved[cluster[o]];
    }
}

std::vector<unsigned char> Stall::stalled(const std::vector<double> &largest, double tolerance) const {
    std::vector<unsigned char> stalled(moved_.size());
    for (size_t o = 0; o < stalled.size(); ++o) stalled[o] = !moved_[o] && largest[o] > tolerance;
    return stalled;
}

std::vector<unsigned char> Stall::may_move(const std::vector<double> &largest, double tolerance) const {
    std::vector<unsigned char> may = stalled(largest, tolerance);
    for (size_t o = 0; o < may.size(); ++o) may[o] &= !stuck_[o];
    return may;
}

} // namespace ringlet
