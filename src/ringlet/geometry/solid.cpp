#include "ringlet/geometry/solid.h"

#include "ringlet/geometry/sides.h"

#include <algorithm>
#include <array>
#include <numeric>

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
    std::vector<int> itself(points_.size());
    std::iota(itself.begin(), itself.end(), 0);
    for_edges(sides_by_edge(triangles_, itself, int(itself.size())), [&](View<Side> sides) {
        Vec3 sum = Vec3::Zero();
        for (const Side &side : sides) sum += normals_[side.triangle].face;
        const bool open = sides.size() == 1;
        for (const Side &side : sides) {
            normals_[side.triangle].edge[side.opposite] = sum.stableNormalized();
            normals_[side.triangle].open_edge[side.opposite] = open;
        }
        if (open) open_[sides[0].low] = open_[sides[0].high] = 1;
    });
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
