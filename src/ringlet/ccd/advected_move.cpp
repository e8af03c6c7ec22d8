#include "ringlet/ccd/advected_move.h"

#include "ringlet/ccd/settings.h"
#include "ringlet/ccd/spread_correction.h"
#include "ringlet/math/disjoint_sets.h"
#include "ringlet/math/parallel.h"

#include <algorithm>
#include <map>

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

namespace {

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

ImpactZones::ImpactZones(const ImpactZonesInput &input, const AdvectedMove &move)
    : input_(input), move_(move), zones_(int(move.start.size())), in_zone_(move.start.size(), 0),
      body_vertex_(move.start.size(), -1) {}

void ImpactZones::merge(const std::vector<Impact> &impacts) {
    const std::vector<unsigned char> &moves = move_.mesh.moves;
    for (const Impact &impact : impacts)
        for (const int i : impact.vertices)
            for (const int j : impact.vertices) {
                if (!moves[i]) continue;
                in_zone_[i] = 1;
                if (moves[j])
                    zones_.join(i, j);
                else
                    body_vertex_[i] = j;
            }
}

void ImpactZones::correct(const std::vector<Impact> &impacts, bool keep_own) {
    struct Zone {
        double mass = 0.0;          // [kg]
        Vec3 moment = Vec3::Zero(); // Σ mass × displacement
        int body_vertex = -1;
        double own = 1.0; // fraction of their own motion that its vertices keep
    };
    const View<Vec3> start = move_.start;
    std::vector<Vec3> &end = move_.end;
    std::map<int, Zone> zones; // with an impact
    for (const Impact &impact : impacts)
        for (const int v : impact.vertices)
            if (move_.mesh.moves[v]) {
                double &own = zones[zones_.find(v)].own;
                own = keep_own ? std::min(own, impact.toi) : 0.0;
            }
    const auto zone_of = [&](int v) { return in_zone_[v] ? zones.find(zones_.find(v)) : zones.end(); };
    const int vertices = int(start.size());
    for (int v = 0; v < vertices; ++v)
        if (const auto zone = zone_of(v); zone != zones.end()) {
            zone->second.mass += input_.mass[v];
            zone->second.moment += input_.mass[v] * (end[v] - start[v]);
            zone->second.body_vertex = std::max(zone->second.body_vertex, body_vertex_[v]);
        }
    std::vector<Correction> corrections(vertices);
    for (int v = 0; v < vertices; ++v)
        if (const auto found = zone_of(v); found != zones.end()) {
            const Zone &zone = found->second;
            corrections[v] = {1.0 - zone.own, zone.body_vertex >= 0 ? Vec3(input_.advect(zone.body_vertex, start[v]) - start[v])
                                                                    : Vec3(zone.moment / zone.mass)};
        }
    spread_correction(move_.candidates, start, end, ccd::max_strain, corrections);
    parallel_for(vertices, [&](int v) {
        if (corrections[v].weight > 0.0) end[v] += corrections[v].weight * (start[v] + corrections[v].motion - end[v]);
    });
}

} // namespace

void resolve_impact_zones(const ImpactZonesInput &input, AdvectedMove &move) {
    if (move.impacts().empty()) return;
    ImpactZones zones(input, move);
    for (int round = 0; round < ccd::zone_rounds && !move.impacts().empty(); ++round)
        move.round([&](const std::vector<Impact> &impacts) {
            zones.merge(impacts);
            zones.correct(impacts, round < ccd::own_motion_rounds);
        });
}

namespace {

// Marks all vertices of the objects of some vertices; of bodies only where they may.
void mark_objects(const CollisionMesh &mesh, const std::vector<int> &vertices, bool bodies,
                  std::vector<Correction> &corrections) {
    std::vector<unsigned char> dynamic(mesh.objects.size(), 0), marked(mesh.objects.size(), 0);
    for (size_t v = 0; v < mesh.object.size(); ++v) dynamic[mesh.object[v]] |= mesh.moves[v];
    for (const int v : vertices) marked[mesh.object[v]] = dynamic[mesh.object[v]] || bodies;
    for (size_t v = 0; v < mesh.object.size(); ++v)
        if (marked[mesh.object[v]]) corrections[v].weight = 1.0;
}

// All vertices of a uniform object make the move of that which makes the least.
void spread_over_objects(const CollisionMesh &mesh, View<unsigned char> uniform, std::vector<Correction> &corrections) {
    if (uniform.empty()) return;
    std::vector<double> weight(uniform.size(), 0.0);
    for (size_t v = 0; v < corrections.size(); ++v)
        weight[mesh.object[v]] = std::max(weight[mesh.object[v]], corrections[v].weight);
    for (size_t v = 0; v < corrections.size(); ++v)
        if (uniform[mesh.object[v]]) corrections[v].weight = weight[mesh.object[v]];
}

} // namespace

void truncate_locally(AdvectedMove &move, View<unsigned char> uniform) {
    const CollisionMesh &mesh = move.mesh;
    for (int round = 0; !move.impacts().empty(); ++round)
        move.round([&](const std::vector<Impact> &impacts) {
            std::vector<Correction> corrections(move.end.size());
            std::vector<int> vertices;
            for (const Impact &impact : impacts)
                for (const int v : impact.vertices) {
                    const bool partial = round < ccd::partial_rounds && !impact.close;
                    const double weight = partial ? 1.0 - ccd::before_first_impact * impact.toi : 1.0;
                    corrections[v].weight = std::max(corrections[v].weight, weight);
                    vertices.push_back(v);
                }
            spread_over_objects(mesh, uniform, corrections);
            if (round >= ccd::vertex_rounds) mark_objects(mesh, vertices, round >= ccd::object_rounds, corrections);
            spread_correction(move.candidates, move.start, move.end, ccd::max_strain, corrections);
            for (size_t v = 0; v < corrections.size(); ++v) {
                const double weight = corrections[v].weight;
                if (weight == 1.0)
                    move.end[v] = move.start[v];
                else if (weight > 0.0)
                    move.end[v] += weight * (move.start[v] - move.end[v]);
            }
        });
}

} // namespace ringlet
