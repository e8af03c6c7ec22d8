#include "ringlet/rest/rest_shape.h"

#include "ringlet/geometry/frames.h"

#include <Eigen/Geometry>
#include <cmath>

namespace ringlet {

RestShape measure_rest_shape(View<int> offsets, View<Vec3> points) {
    const size_t n = points.size();
    RestShape rest{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n), std::vector<Vec3>(n, Vec3::Zero())};
    for (size_t strand = 0; strand + 1 < offsets.size(); ++strand) {
        const int first = offsets[strand], end = offsets[strand + 1];
        const auto edge = [&](int i) -> Vec3 { return points[i + 1] - points[i]; };
        for (int i = first; i + 1 < end; ++i) rest.length[i] = edge(i).norm();

        // Corners and their normals. A straight corner takes that of its neighbour, so that dihedral angles add up.
        int bent = first;
        for (int i = first + 1; i + 1 < end; ++i) {
            const Vec3 product = edge(i - 1).cross(edge(i));
            rest.angle[i] = std::atan2(product.norm(), edge(i - 1).dot(edge(i)));
            if (product.norm() <= 1e-9 * rest.length[i - 1] * rest.length[i]) continue;
            rest.normal[i] = product.normalized();
            if (bent == first)
                for (int k = i - 1; k > first; --k) rest.normal[k] = transport(rest.normal[k + 1], edge(k + 1), edge(k));
            bent = i;
        }
        for (int i = first + 1; i + 1 < end; ++i)
            if (rest.normal[i].isZero())
                rest.normal[i] =
                    i == first + 1 ? edge(i).unitOrthogonal() : transport(rest.normal[i - 1], edge(i - 1), edge(i));
        for (int i = first + 1; i + 2 < end; ++i) {
            const Vec3 along = edge(i).normalized(), next = transport(rest.normal[i + 1], edge(i + 1), edge(i));
            rest.dihedral[i] = std::atan2(along.cross(rest.normal[i]).dot(next), rest.normal[i].dot(next));
        }
    }
    return rest;
}

} // namespace ringlet
