#include "ringlet/solver/refinement.h"

#include "ringlet/solver/settings.h"

#include <algorithm>
#include <cmath>

namespace ringlet {

ObjectMoves::ObjectMoves(const BlockSet &blocks, View<Vec3> now, View<Vec3> wanted, View<Vec3> to)
    : length(blocks.objects(), 0.0), fraction(blocks.objects(), 1.0) {
    blocks.for_active_objects([&](const BlockObject &object) {
        double &longest = length[object.number], &least = fraction[object.number];
        for (int v = object.first; v < object.end; ++v) {
            const double of_vertex = (wanted[v] - now[v]).norm();
            longest = std::max(longest, of_vertex);
            if (of_vertex > 0.0) least = std::min(least, (to[v] - now[v]).norm() / of_vertex);
        }
    });
}

void ObjectMoves::shorten(const std::vector<double> &t) {
    for (size_t object = 0; object < t.size(); ++object) fraction[object] *= t[object];
}

bool ObjectMoves::are_full() const {
    return std::all_of(fraction.begin(), fraction.end(), [](double t) { return t > 1.0 - solver_settings::move_rounding; });
}

void Refinement::add(const ObjectMoves &moves, double tolerance) {
    const BlockSet &blocks = objective_.blocks;
    for (int object = 0; object < objective_.table.objects; ++object) {
        if (!blocks.is_active(object)) continue;
        const double length = moves.length[object], settled = blocks.of_object(object).settled_distance(blocks.lane_of(object));
        limited_[object] = length > tolerance &&
                           (moves.fraction[object] < solver_settings::full_move || (limited_[object] && length > settled));
    }
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
