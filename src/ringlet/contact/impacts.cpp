#include "ringlet/contact/impacts.h"

#include "ringlet/contact/impact.h"

namespace ringlet {
namespace {

template <class Impact>
double impact_of(View<Vec3> start, View<Vec3> end, const std::array<int, 4> &vertices, double fraction, const Impact &impact) {
    std::array<Vec3, 4> x, p;
    for (int i = 0; i < 4; ++i) {
        x[i] = start[vertices[i]];
        p[i] = end[vertices[i]] - start[vertices[i]];
    }
    return impact(x.data(), p.data(), 0.0, fraction);
}

} // namespace

void impacts(const CollisionMesh &mesh, View<Vec3> start, View<Vec3> end, const Candidates &candidates, double fraction,
             std::vector<double> &times) {
    const size_t edge_pairs = candidates.edge_edge.size(), pairs = edge_pairs + candidates.point_triangle.size();
    times.resize(pairs);
#pragma omp parallel for schedule(dynamic, 1024)
    for (size_t k = 0; k < pairs; ++k) {
        if (k < edge_pairs) {
            const auto &a = mesh.edges[candidates.edge_edge[k][0]], &b = mesh.edges[candidates.edge_edge[k][1]];
            times[k] = impact_of(start, end, {a[0], a[1], b[0], b[1]}, fraction, edge_edge_impact);
        } else {
            const auto [point, triangle] = candidates.point_triangle[k - edge_pairs];
            const auto &t = mesh.triangles[triangle];
            times[k] = impact_of(start, end, {point, t[0], t[1], t[2]}, fraction, point_triangle_impact);
        }
    }
}

} // namespace ringlet
