#include "ringlet/solver/configuration.h"

#include "ringlet/solver/settings.h"

#include <algorithm>

namespace ringlet {
Configuration::Configuration(const VertexTable &table, View<int> strands, View<int> cloths, std::vector<Vec3> positions_,
                             double strand_radius)
    : positions(std::move(positions_)), pairs(table.mesh), table_(table), strands_(strands), cloths_(cloths),
      cloth_neighbours_(neighbours(table.mesh, cloths.front(), cloths.back())), strand_radius_(strand_radius) {}

void Configuration::limit(PlannedMove &move, const LimitSettings &settings, SceneReport &report) {
    const bool stays = std::equal(move.to.begin(), move.to.end(), positions.begin()) &&
                       std::equal(move.apex.begin(), move.apex.end(), positions.begin());
    if (!(pairs.is_complete() && (stays || settings.few))) {
        const Stopwatch watch(report.time_filter);
        const double margin = stays ? 0.0 : solver_settings::bound_margin * strand_radius_; // rest rarely lasts
        pairs.update_bounds({positions, move.to, move.apex},
                            {.margin = margin, .max_path = solver_settings::max_bound_length, .lasting = settings.lasts});
    }
    if (!stays) limit(move, settings.whole, {}, report);
}

void Configuration::limit_again(PlannedMove &move, bool whole, View<unsigned char> changed, SceneReport &report) {
    limit(move, whole, changed, report);
}

void Configuration::limit(PlannedMove &move, bool whole, View<unsigned char> changed, SceneReport &report) {
    const Stopwatch watch(report.time_filter);
    add(limit_motion({.connected = connected(), .start = positions, .whole_strands = whole, .changed = changed}, pairs, move.to,
                     move.apex.empty() ? nullptr : &move.apex),
        report);
}

void Configuration::add(const CcdReport &limited, SceneReport &report) {
    report.candidates = limited.candidates;
    report.violations += limited.impacts;
    report.zone_vertices += limited.corrected_vertices;
}

void Configuration::commit(const std::vector<Vec3> &to) {
    pairs.commit_move(positions, to);
    positions = to;
    add_to_record();
}

void Configuration::commit_rigid(const std::vector<Vec3> &to) {
    pairs.commit_rigid_move(positions, to);
    positions = to;
    add_to_record();
}

void Configuration::begin_record() {
    recorded_.clear();
    add_to_record();
}

void Configuration::add_to_record() {
    if (recording_) recorded_.push_back(positions);
}

} // namespace ringlet
