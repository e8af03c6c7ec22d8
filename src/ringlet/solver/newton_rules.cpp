#include "ringlet/solver/newton_rules.h"

#include "ringlet/solver/settings.h"

#include <algorithm>
#include <cmath>

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

void Refinement::add(const ObjectMoves &moves, double tolerance) {
    const BlockSet &blocks = objective_.blocks;
    for (int object = 0; object < objective_.table.objects; ++object) {
        if (!blocks.is_active(object)) continue;
        const double length = moves.length[object], settled = blocks.of_object(object).settled_distance(blocks.lane_of(object));
        limited_[object] = length > tolerance &&
                           (moves.fraction[object] < solver_settings::full_move || (limited_[object] && length > settled));
    }
}

bool Refinement::activate_unfinished(BlockSet &blocks, View<Vec3> now, const std::vector<unsigned char> &stay) {
    for (int object = 0; object < objective_.table.objects; ++object)
        limited_[object] =
            stay[object] || (limited_[object] && blocks.of_object(object).is_stretched(blocks.lane_of(object), now));
    std::vector<unsigned char> active = limited_;
    for (int ring = 0; ring < solver_settings::refined_rings; ++ring) active = objective_.with_touched(active);
    blocks.activate(std::move(active));
    return std::count(limited_.begin(), limited_.end(), 1) > 0;
}

} // namespace ringlet
