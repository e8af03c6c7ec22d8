#include "ringlet/solver/stall.h"

namespace ringlet {

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
