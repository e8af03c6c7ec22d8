// Impact zones (Provot 1997; Harmon et al. 2008): vertices of impacts share one motion where kinematic bodies leave no choice.
#pragma once

#include "ringlet/ccd/advected_move.h"
#include "ringlet/ccd/settings.h"
#include "ringlet/math/disjoint_sets.h"

#include <functional>
#include <vector>

namespace ringlet {

struct ImpactZonesInput {
    View<double> mass; // per vertex [kg]
    // Where a point ends that is advected with a kinematic vertex.
    std::function<Vec3(int vertex, const Vec3 &point)> advect;
};

// Corrects a move by zones for some rounds; impacts may be left. Vertices of impacts form zones; a zone moves as the body that
// it touches, or by its mean motion. Zones grow while there are impacts at their border. Only relative motion counts.
void resolve_impact_zones(const ImpactZonesInput &input, AdvectedMove &move);

// The zones of a move.
class ImpactZones {
public:
    ImpactZones(const ImpactZonesInput &input, const AdvectedMove &move);

    // Kinematic vertices never merge zones: one body would tie together all that touches it.
    void merge(const std::vector<Impact> &impacts);

    // Gives each zone with an impact one motion. With `keep_own`, zones keep their own motion up to the impact, so that contact
    // forces arise.
    void correct(const std::vector<Impact> &impacts, bool keep_own);

private:
    const ImpactZonesInput &input_;
    const AdvectedMove &move_;
    DisjointSets zones_; // of vertices
    std::vector<unsigned char> in_zone_;
    std::vector<int> body_vertex_; // per vertex: a kinematic vertex that it had an impact with; −1: none
};

} // namespace ringlet
