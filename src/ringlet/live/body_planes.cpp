#include "ringlet/live/body_planes.h"

#include <algorithm>
#include <stdexcept>

namespace ringlet {

void BodyPlanes::check(View<Vec3> positions, View<double> clearance) const {
    if (positions.size() != gap.size() || clearance.size() != gap.size())
        throw std::invalid_argument("body planes: arrays do not fit one another");
}

void BodyPlanes::add(const DistanceGrid &body, const Pose &from, const Pose &to, View<Vec3> positions, View<double> clearance) {
    check(positions, clearance);
    for (size_t i = 0; i < positions.size(); ++i) {
        const Vec3 groomed = from.to_groom(positions[i]);
        const DistanceGrid::Sample sample = body.at(groomed);
        const double of_body = sample.distance - clearance[i];
        if (!(of_body < gap[i])) continue;
        gap[i] = of_body;
        normal[i] = to.rotation * sample.gradient;
        offset[i] = normal[i].dot(to.to_world(groomed)) - of_body;
    }
}

void BodyPlanes::add_ball(const Vec3 &from, const Vec3 &to, double radius, double most, View<Vec3> positions,
                          View<double> clearance) {
    check(positions, clearance);
    for (size_t i = 0; i < positions.size(); ++i) {
        const Vec3 away = positions[i] - from;
        const double distance = away.norm(), of_ball = std::max(distance - radius - clearance[i], -most);
        if (distance == 0 || !(of_ball < gap[i])) continue;
        gap[i] = of_ball;
        normal[i] = away / distance;
        offset[i] = normal[i].dot(positions[i] + to - from) - of_ball;
    }
}

} // namespace ringlet
