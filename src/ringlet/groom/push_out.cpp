#include "ringlet/groom/push_out.h"

#include "ringlet/geometry/triangle_tree.h"

#include <algorithm>
#include <limits>

namespace ringlet {
namespace {

// How far each point of one curve has to move; returns whether any has to.
bool find_pushes(std::span<const Vec3> points, const TriangleTree &tree, View<Vec3> normals, double margin,
                 std::span<Vec3> pushes) {
    bool any = false;
    double along = 0.0;
    // The last place whose distance was looked up: a point that has not moved farther from it than it was clear is clear too.
    Vec3 known = points[0];
    SurfacePoint near;
    double height = -std::numeric_limits<double>::infinity();
    for (size_t k = 1; k < points.size(); ++k) {
        along += (points[k] - points[k - 1]).norm();
        pushes[k].setZero();
        const double moved = (points[k] - known).norm();
        if (height - moved > margin) continue;
        double reach = near.distance + moved; // the surface is no farther than this, nor than its last nearest triangle
        if (near.triangle >= 0) reach = std::min(reach, closest_point(tree.mesh(), near.triangle, points[k]).distance);
        near = tree.closest(points[k], 1.001 * reach);
        if (near.triangle < 0) continue; // a point that is not finite is near nothing
        known = points[k];
        const Vec3 normal = smooth_normal(tree.mesh(), normals, near.triangle, near.barycentric);
        height = (points[k] - near.position).dot(normal) < 0.0 ? -near.distance : near.distance;
        const double wanted = std::min(margin, 0.5 * along);
        if (height >= wanted) continue;
        pushes[k] = near.position + wanted * normal - points[k];
        any = true;
    }
    return any;
}

} // namespace

std::vector<Vec3> push_out(const CurveView &curves, const TriangleMesh &body, double margin) {
    const TriangleTree tree(body);
    const std::vector<Vec3> normals = vertex_normals(body);
    std::vector<Vec3> result(curves.points.begin(), curves.points.end());
#pragma omp parallel for schedule(dynamic, 16)
    for (int i = 0; i < curves.count(); ++i) {
        const size_t n = curves[i].size();
        const std::span<Vec3> points = std::span(result).subspan(curves.offsets[i], n);
        std::vector<Vec3> pushes(n, Vec3::Zero()), shared(n);
        for (int pass = 0; pass < 4 && find_pushes(points, tree, normals, margin, pushes); ++pass) {
            if (pass < 3) // the last pass only clears what is left
                for (int smoothing = 0; smoothing < 3; ++smoothing) {
                    shared = pushes;
                    for (size_t k = 1; k < n; ++k) {
                        const Vec3 &after = shared[std::min(k + 1, n - 1)];
                        const Vec3 mean = 0.25 * shared[k - 1] + 0.5 * shared[k] + 0.25 * after;
                        pushes[k] = mean.squaredNorm() > shared[k].squaredNorm() ? mean : shared[k];
                    }
                }
            for (size_t k = 1; k < n; ++k) points[k] += pushes[k];
        }
    }
    return result;
}

} // namespace ringlet
