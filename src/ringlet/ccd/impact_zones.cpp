#include "ringlet/ccd/impact_zones.h"

#include <map>
#include <numeric>
#include <optional>

namespace ringlet {

ImpactZones::ImpactZones(const ImpactZonesInput &input)
    : input_(input), parent_(input.start.size()), in_zone_(parent_.size(), 0), body_vertex_(parent_.size(), -1),
      all_strands_(input.connected.strands.size() - 1) {
    std::iota(parent_.begin(), parent_.end(), 0);
    std::iota(all_strands_.begin(), all_strands_.end(), 0);
}

void ImpactZones::merge(const std::vector<Impact> &impacts) {
    const std::vector<unsigned char> &moves = input_.connected.mesh.moves;
    for (const Impact &impact : impacts)
        for (const int i : impact.vertices)
            for (const int j : impact.vertices) {
                if (!moves[i]) continue;
                in_zone_[i] = 1;
                if (moves[j])
                    merge(i, j);
                else
                    body_vertex_[i] = j;
            }
}

void ImpactZones::correct(const std::vector<Impact> &impacts, bool keep_own, std::vector<Vec3> &end) {
    struct Zone {
        double mass = 0.0;          // [kg]
        Vec3 moment = Vec3::Zero(); // Σ mass × displacement
        int body_vertex = -1;
        double own = 1.0; // fraction of their own motion that its vertices keep
    };
    const View<Vec3> start = input_.start;
    std::map<int, Zone> zones; // with an impact
    for (const Impact &impact : impacts)
        for (const int v : impact.vertices)
            if (input_.connected.mesh.moves[v]) {
                double &own = zones[find(v)].own;
                own = keep_own ? std::min(own, impact.toi) : 0.0;
            }
    const auto zone_of = [&](int v) { return in_zone_[v] ? zones.find(find(v)) : zones.end(); };
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
    spread_correction(input_.connected, start, end, {ccd::max_strain, ccd::max_strain}, all_strands_, corrections);
#pragma omp parallel for schedule(static)
    for (int v = 0; v < vertices; ++v)
        if (corrections[v].weight > 0.0) end[v] += corrections[v].weight * (start[v] + corrections[v].motion - end[v]);
}

CcdReport resolve_impact_zones(const ImpactZonesInput &input, PairCache &pairs, std::vector<Vec3> &end) {
    const CollisionMesh &mesh = input.connected.mesh;
    CcdReport report;
    std::vector<unsigned char> corrected(end.size(), 0);
    std::optional<ImpactZones> zones;
    std::vector<int> rigid(input.rigid.begin(), input.rigid.end()); // without the vertices that are corrected
    pairs.begin_rigid_move({input.start, end}, input.rigid_motion, rigid);
    for (;; ++report.rounds) {
        const std::vector<Impact> impacts = find_impacts(mesh, pairs.impact_candidates(), input.start, end, rigid);
        const int count = int(impacts.size());
        if (report.rounds == 0) report.candidates = pairs.size(), report.impacts = count;
        if (impacts.empty()) break;
        mark_vertices(mesh, impacts, corrected);
        const bool hopeless = report.rounds >= input.hopeful_rounds && ccd::hopeful_reduction * count > report.impacts;
        if (hopeless || report.rounds >= ccd::max_zone_rounds) {
            report.fraction = truncate_before_first(impacts, input.start, end);
            pairs.begin_rigid_move({input.start, end}, input.rigid_motion, rigid);
            break;
        }
        if (!zones) zones.emplace(input);
        const std::vector<Vec3> before = end;
        zones->merge(impacts);
        zones->correct(impacts, report.rounds < ccd::own_motion_rounds, end);
        std::vector<unsigned char> changed(end.size(), 0);
        for (const Impact &impact : impacts)
            for (const int v : impact.vertices) changed[v] = 1;
        for (size_t v = 0; v < end.size(); ++v) {
            if (end[v] == before[v]) continue;
            changed[v] = 1;
            if (!rigid.empty()) rigid[v] = -1;
        }
        pairs.update_rigid_move({input.start, end}, input.rigid_motion, rigid, changed);
    }
    report.corrected_vertices = int(std::count(corrected.begin(), corrected.end(), 1));
    return report;
}

} // namespace ringlet
