#include "ringlet/solver/configuration.h"

#include "ringlet/math/parallel_copy.h"
#include "ringlet/solver/settings.h"

#include <algorithm>

namespace ringlet {

Configuration::Configuration(const VertexTable &table, std::vector<Vec3> positions_, double radius)
    : positions(std::move(positions_)), candidates(table.mesh), pairs(candidates), table_(table), radius_(radius) {}

void Configuration::begin(const Move &move, Candidates::Serve serve) {
    candidates.enclose(move, {solver_settings::bound_margin * radius_, solver_settings::max_bound_length}, serve);
    pairs.begin(move);
}

void Configuration::find_candidates() {
    if (candidates.empty()) begin({positions, positions}, Candidates::Serve::later_moves);
}

std::vector<ContactPair> Configuration::contact_pairs() { return contact_pairs(std::vector<unsigned char>(table_.objects, 1)); }

std::vector<ContactPair> Configuration::contact_pairs(View<unsigned char> objects) {
    find_candidates();
    return pairs.contact_pairs(positions, objects);
}

void Configuration::limit(PlannedMove &move, Yield yield, Candidates::Serve serve, SceneReport &report) {
    if (std::equal(move.to.begin(), move.to.end(), positions.begin()) &&
        std::equal(move.apex.begin(), move.apex.end(), positions.begin()))
        return; // it stays
    const Stopwatch watch(report.time_filter);
    begin({positions, move.to, move.apex}, serve);
    limit_begun(move, yield, report);
}

void Configuration::limit_again(PlannedMove &move, Yield yield, View<unsigned char> changed, SceneReport &report) {
    const Stopwatch watch(report.time_filter);
    pairs.update({positions, move.to, move.apex}, changed);
    limit_begun(move, yield, report);
}

void Configuration::limit_begun(PlannedMove &move, Yield yield, SceneReport &report) {
    add(limit_move(pairs, positions, move, yield), report);
}

void Configuration::add(const CcdReport &limited, SceneReport &report) {
    report.candidates = limited.candidates;
    report.violations += limited.impacts;
    report.zone_vertices += limited.corrected_vertices;
}

void Configuration::commit(const std::vector<Vec3> &to) {
    pairs.commit(positions, to);
    parallel_copy(to, positions);
    add_to_record();
}

void Configuration::begin_step(const RigidMotion &motion_of_most) {
    find_candidates();
    candidates.move_rigidly(motion_of_most, positions);
    for (Vec3 &x : positions) x = motion_of_most(x);
    recorded_.clear();
    add_to_record();
}

void Configuration::add_to_record() {
    if (recording_) recorded_.push_back(positions);
}

} // namespace ringlet
