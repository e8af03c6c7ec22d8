#include "ringlet/live/body_planes.h"

#include <stdexcept>

namespace ringlet {

void BodyPlanes::add(const DistanceGrid &body, const Pose &from, const Pose &to, View<Vec3> positions, View<double> clearance) {
    if (positions.size() != gap.size() || clearance.size() != gap.size())
        throw std::invalid_argument("body planes: arrays do not fit one another");
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

} // namespace ringlet
