#include "ringlet/ccd/advected_move.h"

#include <algorithm>
#include <limits>

namespace ringlet {

AdvectedMove::AdvectedMove(const ConnectedMesh &connected_, PairCache &pairs, View<Vec3> start_, std::vector<Vec3> &end_,
                           const RigidMotion &motion_, View<int> rigid)
    : connected(connected_), start(start_), end(end_), motion(motion_), pairs_(pairs), rigid_(rigid.begin(), rigid.end()),
      follows_(end.size(), 0), corrected_(end.size(), 0) {
    rigid_.resize(end.size(), -1);
    pairs_.begin_rigid_move({start, end}, motion, rigid_);
    impacts_ = find_impacts(connected.mesh, pairs_.impact_candidates(), start, end, rigid_);
    report_.candidates = pairs_.size(), report_.impacts = int(impacts_.size());
    mark_vertices(connected.mesh, impacts_, corrected_);
}

void AdvectedMove::find_impacts_again(View<Vec3> before) {
    constexpr int follows = std::numeric_limits<int>::max();
    std::vector<unsigned char> changed(end.size(), 0);
    for (const Impact &impact : impacts_)
        for (const int v : impact.vertices) changed[v] = 1;
    for (size_t v = 0; v < end.size(); ++v) {
        if (end[v] != before[v]) changed[v] = 1, rigid_[v] = -1;
        if (follows_[v]) rigid_[v] = follows;
    }
    pairs_.update_rigid_move({start, end}, motion, rigid_, changed);
    impacts_ = find_impacts(connected.mesh, pairs_.impact_candidates(), start, end, rigid_);
    mark_vertices(connected.mesh, impacts_, corrected_);
    ++report_.rounds;
}

CcdReport AdvectedMove::report() const {
    CcdReport report = report_;
    report.corrected_vertices = int(std::count(corrected_.begin(), corrected_.end(), 1));
    return report;
}

} // namespace ringlet
