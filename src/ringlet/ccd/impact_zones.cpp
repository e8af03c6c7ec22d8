#include "ringlet/ccd/impact_zones.h"

#include "ringlet/ccd/spread_correction.h"

#include <map>

namespace ringlet {

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
#pragma omp parallel for schedule(static)
    for (int v = 0; v < vertices; ++v)
        if (corrections[v].weight > 0.0) end[v] += corrections[v].weight * (start[v] + corrections[v].motion - end[v]);
}

void resolve_impact_zones(const ImpactZonesInput &input, AdvectedMove &move) {
    if (move.impacts().empty()) return;
    ImpactZones zones(input, move);
    for (int round = 0; round < ccd::zone_rounds && !move.impacts().empty(); ++round)
        move.round([&](const std::vector<Impact> &impacts) {
            zones.merge(impacts);
            zones.correct(impacts, round < ccd::own_motion_rounds);
        });
}

} // namespace ringlet
