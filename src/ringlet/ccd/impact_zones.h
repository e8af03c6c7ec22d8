// Impact zones (Provot 1997; Harmon et al. 2008): vertices of impacts share one motion where kinematic bodies leave no choice.
#pragma once

#include "ringlet/ccd/impact.h"
#include "ringlet/ccd/settings.h"
#include "ringlet/ccd/spread_correction.h"
#include "ringlet/geometry/rigid_motion.h"

#include <algorithm>
#include <functional>
#include <vector>

namespace ringlet {

struct ImpactZonesInput {
    ConnectedMesh connected;
    View<Vec3> start;  // [m]
    View<double> mass; // per vertex [kg]
    // Where a point ends that is advected with a kinematic vertex.
    std::function<Vec3(int vertex, const Vec3 &point)> advect;
    RigidMotion rigid_motion = {}; // that nearly everything follows
    View<int> rigid = {};          // per vertex: those with one number ≥ 0 share an affine motion and have no impacts
    int hopeful_rounds = ccd::max_zone_rounds; // later rounds need that few of the first impacts remain
};

// Changes `end` so that no pair has an impact while every vertex moves straight from `start` to `end`. Vertices of impacts form
// zones; a zone moves as the body that it touches, or by its mean motion. Zones grow while there are impacts at their border.
// Where this fails the whole move, kinematic bodies included, is truncated. Only relative motion counts.
CcdReport resolve_impact_zones(const ImpactZonesInput &input, PairCache &pairs, std::vector<Vec3> &end);

// The zones of a move as disjoint sets, each named by its smallest vertex, so that the order of merging has no effect.
class ImpactZones {
public:
    explicit ImpactZones(const ImpactZonesInput &input);

    // Kinematic vertices never merge zones: one body would tie together all that touches it.
    void merge(const std::vector<Impact> &impacts);

    // Gives each zone with an impact one motion. With `keep_own`, zones keep their own motion up to the impact, so that contact
    // forces arise.
    void correct(const std::vector<Impact> &impacts, bool keep_own, std::vector<Vec3> &end);

private:
    int find(int v) {
        while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
        return v;
    }
    void merge(int a, int b) {
        a = find(a), b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

    const ImpactZonesInput &input_;
    std::vector<int> parent_;
    std::vector<unsigned char> in_zone_;
    std::vector<int> body_vertex_; // per vertex: a kinematic vertex that it had an impact with; −1: none
    std::vector<int> all_strands_;
};

} // namespace ringlet
