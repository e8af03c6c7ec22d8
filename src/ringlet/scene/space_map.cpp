#include "ringlet/scene/space_map.h"

#include "ringlet/scene/settings.h"

#include <algorithm>
#include <limits>

namespace ringlet {

namespace {

// The vertices of each body, and the pins of each cloth.
std::vector<std::vector<int>> prescribed_groups(const SceneVertices &vertices) {
    std::vector<std::vector<int>> groups;
    for (const std::vector<int> &begins : {vertices.bodies, vertices.cloths})
        for (size_t k = 0; k + 1 < begins.size(); ++k) {
            groups.emplace_back();
            for (int v = begins[k]; v < begins[k + 1]; ++v)
                if (!vertices.mesh.moves[v]) groups.back().push_back(v);
        }
    std::erase_if(groups, [](const std::vector<int> &group) { return group.empty(); });
    return groups;
}

} // namespace

// The farthest vertex from the patches of its group begins the next, while they keep vertices enough to determine a rotation.
SpaceMap::SpaceMap(const PrescribedMotion &motion) {
    struct Place {
        int vertex, group, patch;
        double distance2;
    };
    const std::vector<std::vector<int>> groups = prescribed_groups(motion.vertices);
    std::vector<Place> places;
    for (size_t g = 0; g < groups.size(); ++g)
        for (const int v : groups[g]) places.push_back({v, int(g), -1, std::numeric_limits<double>::infinity()});
    std::vector<size_t> begun(groups.size(), 0);
    const auto nearer = [](const Place &a, const Place &b) { return a.distance2 < b.distance2; };
    while (!places.empty() && patches_.size() < size_t(scene_settings::max_patches)) {
        const Place seed = *std::max_element(places.begin(), places.end(), nearer);
        if (seed.distance2 == 0.0) break;
        const size_t size = groups[seed.group].size();
        const bool enough = ++begun[seed.group] * scene_settings::vertices_of_patch >= size;
        for (Place &place : places) {
            if (place.group != seed.group) continue;
            const double away2 = (motion.start[place.vertex] - motion.start[seed.vertex]).squaredNorm();
            if (away2 < place.distance2) place.distance2 = away2, place.patch = int(patches_.size());
            if (enough) place.distance2 = 0.0;
        }
        patches_.emplace_back();
    }
    for (const Place &place : places)
        if (place.patch >= 0) patches_[place.patch].vertices.push_back(place.vertex);
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
