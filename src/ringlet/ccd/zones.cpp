#include "ringlet/ccd/zones.h"

#include "ringlet/ccd/fade.h"

#include <map>
#include <numeric>

namespace ringlet {

Zones::Zones(const FilterScene &scene)
    : scene_(scene), parent_(scene.mesh.moves.size()), in_zone_(parent_.size(), 0), carrier_(parent_.size(), -1),
      strands_(scene.offsets.size() - 1) {
    std::iota(parent_.begin(), parent_.end(), 0);
    std::iota(strands_.begin(), strands_.end(), 0);
}

void Zones::join(const std::vector<Met> &met) {
    for (const Met &pair : met)
        for (const int i : pair.vertices)
            for (const int j : pair.vertices) {
                if (!scene_.mesh.moves[i]) continue;
                in_zone_[i] = 1;
                if (scene_.mesh.moves[j])
                    join(i, j);
                else
                    carrier_[i] = j;
            }
}

void Zones::move_as_one(View<Vec3> start, const std::vector<Met> &met, bool to_touch, std::vector<Vec3> &end) {
    struct Zone {
        double mass = 0.0;
        Vec3 moved = Vec3::Zero(); // Σ mass × displacement
        int carrier = -1;          // a kinematic vertex that it met
        double safe = 1.0;         // part of its vertices' own motion
    };
    std::map<int, Zone> hit;
    for (const Met &pair : met)
        for (const int v : pair.vertices)
            if (scene_.mesh.moves[v]) {
                double &safe = hit[find(v)].safe;
                safe = to_touch ? std::min(safe, pair.time) : 0.0;
            }
    const auto zone_of = [&](int v) { return in_zone_[v] ? hit.find(find(v)) : hit.end(); };
    const int vertices = int(start.size());
    for (int v = 0; v < vertices; ++v)
        if (const auto zone = zone_of(v); zone != hit.end()) {
            zone->second.mass += scene_.mass[v];
            zone->second.moved += scene_.mass[v] * (end[v] - start[v]);
            zone->second.carrier = std::max(zone->second.carrier, carrier_[v]);
        }
    std::vector<Pull> pulls(vertices);
    for (int v = 0; v < vertices; ++v)
        if (const auto found = zone_of(v); found != hit.end()) {
            const Zone &zone = found->second;
            pulls[v] = {1.0 - zone.safe, zone.carrier >= 0 ? Vec3(scene_.carried_by(zone.carrier, start[v]) - start[v])
                                                           : Vec3(zone.moved / zone.mass)};
        }
    fade(scene_, start, end, {most_strain, most_strain}, strands_, pulls);
#pragma omp parallel for schedule(static)
    for (int v = 0; v < vertices; ++v)
        if (pulls[v].part > 0.0) end[v] += pulls[v].part * (start[v] + pulls[v].motion - end[v]);
}

} // namespace ringlet
