#include "ringlet/ccd/step_filter.h"

#include "ringlet/ccd/hold_back.h"
#include "ringlet/ccd/meeting.h"
#include "ringlet/ccd/zones.h"

#include <algorithm>
#include <optional>

namespace ringlet {

FilterReport filter_step(const FilterScene &scene, NearPairs &near, View<Vec3> start, std::vector<Vec3> &end) {
    constexpr int to_touch = 3; // rounds in which zones keep some of their own motion
    const int most_rounds = scene.still ? int(scene.offsets.size() + scene.cloths.size()) + 16 : scene.most_rounds;
    FilterReport report;
    const size_t vertices = start.size();
    std::vector<unsigned char> in_the_way(vertices, 0);
    std::optional<HoldBack> held;
    std::optional<Zones> zones;
    std::vector<int> rigid(scene.rigid.begin(), scene.rigid.end()); // still: what is pushed out of a way no longer is
    FilterScene now = scene;
    now.rigid = rigid;
    const auto via = [&] { return scene.via != nullptr ? View<Vec3>(*scene.via) : View<Vec3>(); };
    const auto set_out = [&] {
        if (scene.still)
            near.set_out(start, end, via());
        else
            near.set_out_as_one(start, end, scene.as_one, rigid);
    };
    if (scene.changed.empty())
        set_out();
    else
        near.set_out_anew(start, end, scene.changed, via());
    for (;; ++report.rounds) {
        const std::vector<Met> met = find_met(now, near, start, end);
        if (report.rounds == 0) {
            report.candidates = near.count();
            report.violations = int(met.size());
        }
        if (met.empty()) break;
        for (const Met &pair : met)
            for (const int v : pair.vertices) in_the_way[v] = scene.mesh.moves[v];
        const bool hopeless = !scene.still && report.rounds >= scene.hopeful && 10 * int(met.size()) > report.violations;
        if (hopeless || report.rounds >= most_rounds) { // no way out was found: everything stops before the first pair meets
            report.fraction = 1.0;
            for (const Met &pair : met) report.fraction = std::min(report.fraction, 0.9 * pair.time);
            for (size_t v = 0; v < vertices; ++v) end[v] = start[v] + report.fraction * (end[v] - start[v]);
            set_out();
            break;
        }
        if (scene.still) { // what has not changed since the last round has not met
            if (!held) held.emplace(scene, near, start, end);
            held->round(met);
            near.set_out_anew(start, end, held->changed(), via());
        } else {
            if (!zones) zones.emplace(scene);
            const std::vector<Vec3> before = end;
            zones->join(met);
            zones->move_as_one(start, met, report.rounds < to_touch, end);
            std::vector<unsigned char> changed(vertices, 0);
            for (const Met &pair : met)
                for (const int v : pair.vertices) changed[v] = 1;
            for (size_t v = 0; v < vertices; ++v) {
                if (end[v] == before[v]) continue;
                changed[v] = 1;
                if (!rigid.empty()) rigid[v] = -1;
            }
            near.set_out_as_one_anew(start, end, scene.as_one, rigid, changed);
        }
    }
    report.zone_vertices = int(std::count(in_the_way.begin(), in_the_way.end(), 1));
    return report;
}

} // namespace ringlet
