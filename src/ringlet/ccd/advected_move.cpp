#include "ringlet/ccd/advected_move.h"

#include <algorithm>

namespace ringlet {

AdvectedMove::AdvectedMove(MoveCandidates &pairs, View<Vec3> start_, std::vector<Vec3> &end_)
    : candidates(pairs.candidates()), mesh(candidates.mesh()), start(start_), end(end_), pairs_(pairs),
      corrected_(end.size(), 0) {
    find_impacts();
    report_.candidates = pairs_.size(), report_.impacts = int(impacts_.size());
}

void AdvectedMove::find_impacts() {
    pairs_.begin({start, end});
    impacts_ = ringlet::find_impacts(mesh, pairs_.impact_candidates(), start, end);
    mark_vertices(mesh, impacts_, corrected_);
}

CcdReport AdvectedMove::report() const {
    CcdReport report = report_;
    report.corrected_vertices = int(std::count(corrected_.begin(), corrected_.end(), 1));
    return report;
}

} // namespace ringlet
