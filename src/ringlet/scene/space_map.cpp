#include "ringlet/scene/space_map.h"

#include "ringlet/scene/settings.h"

#include <algorithm>
#include <limits>

namespace ringlet {

// The farthest vertex from the patches of its body begins the next, while they keep vertices enough to determine a rotation.
SpaceMap::SpaceMap(const PrescribedMotion &motion) {
    const std::vector<int> &bodies = motion.vertices.bodies;
    const int first = bodies.front(), count = motion.vertices.count() - first;
    std::vector<double> distance2(count, std::numeric_limits<double>::infinity());
    std::vector<int> nearest(count, -1);
    std::vector<size_t> begun(bodies.size() - 1, 0);
    while (count > 0 && patches_.size() < size_t(scene_settings::max_patches)) {
        const int seed = first + int(std::max_element(distance2.begin(), distance2.end()) - distance2.begin());
        if (distance2[seed - first] == 0.0) break;
        const int body = int(std::upper_bound(bodies.begin(), bodies.end(), seed) - bodies.begin()) - 1;
        const int begin = bodies[body], end = bodies[body + 1];
        for (int v = begin; v < end; ++v) {
            const double away2 = (motion.start[v] - motion.start[seed]).squaredNorm();
            if (away2 < distance2[v - first]) distance2[v - first] = away2, nearest[v - first] = int(patches_.size());
        }
        if (++begun[body] * scene_settings::vertices_of_patch >= size_t(end - begin)) // it has enough
            std::fill(distance2.begin() + (begin - first), distance2.begin() + (end - first), 0.0);
        patches_.emplace_back();
    }
    for (int v = 0; v < count; ++v)
        if (nearest[v] >= 0) patches_[nearest[v]].vertices.push_back(first + v);
    std::erase_if(patches_, [](const Patch &patch) { return patch.vertices.empty(); });
    for (Patch &patch : patches_) patch.motion = fit_rigid_motion(patch.vertices, motion.start, motion.target);
}

Vec3 SpaceMap::operator()(const Vec3 &point) const {
    Vec3 sum = Vec3::Zero();
    double weights = 0.0;
    for (const Patch &patch : patches_) {
        const double away2 = (point - patch.motion.from).squaredNorm() + 1e-12, weight = 1.0 / (away2 * away2 * away2);
        sum += weight * (patch.motion(point) - point);
        weights += weight;
    }
    return weights > 0.0 ? Vec3(point + sum / weights) : point;
}

} // namespace ringlet
