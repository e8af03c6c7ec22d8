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
    double along = 0.0, clear = 0.0; // `clear`: how far the curve can still go before it may come within the margin again
    double reach = std::numeric_limits<double>::infinity(); // the surface is no farther than this
    for (size_t k = 1; k < points.size(); ++k) {
        const double edge = (points[k] - points[k - 1]).norm();
        along += edge;
        clear -= edge;
        reach += edge;
        pushes[k].setZero();
        if (clear > 0.0) continue;
        const SurfacePoint near = tree.closest(points[k], 1.001 * reach);
        if (near.triangle < 0) continue; // a point that is not finite is near nothing
        reach = near.distance;
        const Vec3 normal = smooth_normal(tree.mesh(), normals, near.triangle, near.barycentric);
        const double height = (points[k] - near.position).dot(normal) < 0.0 ? -near.distance : near.distance;
        const double wanted = std::min(margin, 0.5 * along);
        clear = height - margin;
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
