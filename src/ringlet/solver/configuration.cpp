#include "ringlet/solver/configuration.h"

#include "ringlet/solver/settings.h"

#include <algorithm>

namespace ringlet {

Configuration::Configuration(const VertexTable &table, View<int> strands, View<int> cloths, std::vector<Vec3> positions_,
                             double strand_radius)
    : positions(std::move(positions_)), pairs(table.mesh), table_(table), strands_(strands), cloths_(cloths),
      cloth_neighbours_(neighbours(table.mesh, cloths.front(), cloths.back())), strand_radius_(strand_radius) {}

void Configuration::bound(const PlannedMove &move, bool lasts) {
    pairs.update_bounds({positions, move.to, move.apex}, {.margin = solver_settings::bound_margin * strand_radius_,
                                                          .max_path = solver_settings::max_bound_length,
                                                          .lasting = lasts});
}

std::vector<ContactPair> Configuration::contact_pairs() {
    if (!pairs.is_complete()) bound({positions, {}}, true);
    return pairs.contact_pairs(positions);
}

void Configuration::limit(PlannedMove &move, const LimitSettings &settings, SceneReport &report) {
    if (std::equal(move.to.begin(), move.to.end(), positions.begin()) &&
        std::equal(move.apex.begin(), move.apex.end(), positions.begin()))
        return; // it stays
    if (!settings.few) {
        const Stopwatch watch(report.time_filter);
        bound(move, settings.lasts);
    }
    limit(move, settings.whole, {}, report);
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

void Configuration::begin_step(const RigidMotion &motion_of_most) {
    std::vector<Vec3> moved;
    moved.reserve(positions.size());
    for (const Vec3 &x : positions) moved.push_back(motion_of_most(x));
    pairs.move_rigidly(positions, moved);
    positions = std::move(moved);
    recorded_.clear();
    add_to_record();
}

void Configuration::add_to_record() {
    if (recording_) recorded_.push_back(positions);
}

} // namespace ringlet
