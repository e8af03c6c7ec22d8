#include "ringlet/geometry/solid.h"

#include <algorithm>
#include <array>
#include <tuple>

namespace ringlet {

Solid::Solid(const TriangleMesh &mesh)
    : points_(mesh.points.begin(), mesh.points.end()), triangles_(mesh.triangles.begin(), mesh.triangles.end()),
      mesh_{points_, triangles_}, tree_(mesh_), normals_(triangles_.size()), corners_(vertex_normals(mesh_)),
      open_(points_.size(), 0) {
    for (size_t t = 0; t < triangles_.size(); ++t) {
        const Vec3 &a = mesh_.corner(static_cast<int>(t), 0);
        const Vec3 ab = mesh_.corner(static_cast<int>(t), 1) - a, ac = mesh_.corner(static_cast<int>(t), 2) - a;
        normals_[t].face = ab.cross(ac).stableNormalized();
    }
    find_edges();
}

std::shared_ptr<const ProximityGrid> Solid::cells_within(double distance) const {
    const std::lock_guard lock(grid_in_use_);
    if (!grid_ || grid_->distance() != distance) grid_ = std::make_shared<const ProximityGrid>(mesh_, distance);
    return grid_;
}

void Solid::find_edges() {
    struct Side {
        int low, high, triangle, k;
    };
    std::vector<Side> sides;
    sides.reserve(3 * triangles_.size());
    for (size_t t = 0; t < triangles_.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const int i = triangles_[t][(k + 1) % 3], j = triangles_[t][(k + 2) % 3];
            sides.push_back({std::min(i, j), std::max(i, j), static_cast<int>(t), k});
        }
    std::sort(sides.begin(), sides.end(), [](const Side &a, const Side &b) {
        return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
    });
    for (size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
        Vec3 sum = Vec3::Zero();
        for (; end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high; ++end)
            sum += normals_[sides[end].triangle].face;
        const bool open = end - begin == 1;
        for (size_t i = begin; i < end; ++i) {
            normals_[sides[i].triangle].edge[sides[i].k] = sum.stableNormalized();
            normals_[sides[i].triangle].open_edge[sides[i].k] = open;
        }
        if (open) open_[sides[begin].low] = open_[sides[begin].high] = 1;
    }
}

SignedDistance Solid::signed_distance(const Vec3 &place, double within, int hint) const {
    constexpr double on_edge = 1e-7; // a barycentric coordinate below this is 0
    if (hint >= 0) within = std::min(within, 1.001 * closest_point(mesh_, hint, place).distance);
    const SurfacePoint found = tree_.closest(place, within);
    if (found.triangle < 0) return {};
    const Normals &normals = normals_[found.triangle];
    const std::array<bool, 3> zero = {found.barycentric[0] < on_edge, found.barycentric[1] < on_edge,
                                      found.barycentric[2] < on_edge};
    SignedDistance result{found.triangle, found.position, normals.face, {}, found.distance};
    result.smooth_normal = smooth_normal(mesh_, corners_, found.triangle, found.barycentric);
    bool rim = false;
    if (const int zeros = zero[0] + zero[1] + zero[2]; zeros == 1) {
        const int k = zero[0] ? 0 : zero[1] ? 1 : 2;
        result.normal = normals.edge[k];
        rim = normals.open_edge[k];
    } else if (zeros == 2) {
        const int corner = triangles_[found.triangle][!zero[0] ? 0 : !zero[1] ? 1 : 2];
        result.normal = corners_[corner];
        rim = open_[corner] != 0;
    }
    if (!rim && (place - found.position).dot(result.normal) < 0.0) result.distance = -found.distance;
    return result;
}

} // namespace ringlet
