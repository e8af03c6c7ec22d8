#include "ringlet/solver/configuration.h"

#include "ringlet/ccd/step_filter.h"

#include <algorithm>

namespace ringlet {
namespace {

constexpr double max_bound_length = 0.3; // [m]: motion bounds as long as that hold too many pairs
constexpr double bound_margin = 0.2;     // of the radius of strands, for moves to come

} // namespace

Configuration::Configuration(const VertexTable &table, Connectivity connectivity_, std::vector<Vec3> positions_,
                             double strand_radius)
    : positions(std::move(positions_)), pairs(table.mesh), connectivity(std::move(connectivity_)), table_(table),
      strand_radius_(strand_radius) {}

void Configuration::limit(Move &move, const LimitSettings &settings, SceneReport &report) {
    const bool stays = std::equal(move.to.begin(), move.to.end(), positions.begin()) &&
                       std::equal(move.apex.begin(), move.apex.end(), positions.begin());
    if (!(pairs.knows_all_here() && (stays || settings.few))) {
        const Stopwatch watch(report.time_filter);
        const double margin = stays ? 0.0 : bound_margin * strand_radius_; // what stays rarely does so for long
        pairs.note(positions, move.to, margin, max_bound_length, move.apex, settings.lasts);
    }
    if (!stays) limit(move, settings.whole, {}, report);
}

void Configuration::limit_again(Move &move, bool whole, View<unsigned char> changed, SceneReport &report) {
    limit(move, whole, changed, report);
}

void Configuration::limit(Move &move, bool whole, View<unsigned char> changed, SceneReport &report) {
    const Stopwatch watch(report.time_filter);
    const FilterScene scene{.mesh = table_.mesh,
                            .mass = table_.mass,
                            .offsets = connectivity.strands,
                            .carried_by = {},
                            .rigid = {},
                            .as_one = {},
                            .still = true,
                            .whole = whole,
                            .changed = changed,
                            .via = move.apex.empty() ? nullptr : &move.apex,
                            .cloths = connectivity.cloths,
                            .neighbours = &connectivity.neighbours};
    const FilterReport limited = filter_step(scene, pairs, positions, move.to);
    report.candidates = limited.candidates;
    report.violations += limited.violations;
    report.zone_vertices += limited.zone_vertices;
}

void Configuration::commit(const std::vector<Vec3> &to) {
    pairs.arrive(positions, to);
    positions = to;
    add_to_record();
}

void Configuration::commit_rigid(const std::vector<Vec3> &to) {
    pairs.arrive_as_one(positions, to);
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
