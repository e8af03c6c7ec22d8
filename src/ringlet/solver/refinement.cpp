#include "ringlet/solver/refinement.h"

#include "ringlet/solver/settings.h"

#include <algorithm>
#include <cmath>

namespace ringlet {

Refinement::Refinement(const Objective &objective)
    : objective_(objective), length_(objective.table.objects), fraction_(length_.size(), 1.0), limited_(length_.size(), 0) {}

void Refinement::add_move(View<Vec3> now, View<Vec3> wanted, View<Vec3> to) {
    std::fill(length_.begin(), length_.end(), 0.0);
    std::fill(fraction_.begin(), fraction_.end(), 1.0);
    objective_.blocks.for_active_objects([&](const BlockObject &object) {
        double &longest = length_[object.number], &least = fraction_[object.number];
        for (int v = object.first; v < object.end; ++v) {
            const double length = (wanted[v] - now[v]).norm();
            longest = std::max(longest, length);
            if (length > 0.0) least = std::min(least, (to[v] - now[v]).norm() / length);
        }
    });
}

void Refinement::add_steps(const std::vector<double> &t) {
    for (size_t object = 0; object < t.size(); ++object) fraction_[object] *= t[object];
}

void Refinement::end_iteration(double tolerance) {
    const BlockSet &blocks = objective_.blocks;
    for (int object = 0; object < objective_.table.objects; ++object) {
        if (!blocks.is_active(object)) continue;
        const double settled = blocks.of_object(object).settled_distance(blocks.lane_of(object));
        limited_[object] = length_[object] > tolerance &&
                           (fraction_[object] < solver_settings::full_move || (limited_[object] && length_[object] > settled));
    }
}

bool Refinement::all_moved_fully() const {
    return std::all_of(fraction_.begin(), fraction_.end(),
                       [](double fraction) { return fraction > 1.0 - solver_settings::move_rounding; });
}

bool Refinement::activate_unfinished(BlockSet &blocks, View<Vec3> now, const std::vector<unsigned char> &stay) {
    for (int object = 0; object < objective_.table.objects; ++object)
        limited_[object] =
            stay[object] || (limited_[object] && blocks.of_object(object).is_stretched(blocks.lane_of(object), now));
    std::vector<unsigned char> active = limited_;
    for (int ring = 0; ring < solver_settings::refined_rings; ++ring) active = objective_.with_touched(active);
    blocks.activate(std::move(active));
    return std::count(limited_.begin(), limited_.end(), 1) > 0;
}

} // namespace ringlet
