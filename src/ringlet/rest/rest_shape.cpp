#include "ringlet/rest/rest_shape.h"

#include <Eigen/Geometry>
#include <cmath>

namespace ringlet {

RestShape measure_rest_shape(View<int> offsets, View<Vec3> points) {
    RestShape rest{std::vector<double>(points.size()), std::vector<double>(points.size()), std::vector<double>(points.size())};
    for (size_t strand = 0; strand + 1 < offsets.size(); ++strand) {
        const int first = offsets[strand], end = offsets[strand + 1];
        const auto edge = [&](int i) -> Vec3 { return points[i + 1] - points[i]; };
        for (int i = first; i + 1 < end; ++i) {
            rest.length[i] = edge(i).norm();
            if (i == first) continue;
            const Vec3 a = edge(i - 1).cross(edge(i));
            rest.angle[i] = std::atan2(a.norm(), edge(i - 1).dot(edge(i)));
            if (i + 2 == end) continue;
            const Vec3 b = edge(i).cross(edge(i + 1));
            rest.dihedral[i] = std::atan2(rest.length[i] * edge(i - 1).dot(b), a.dot(b));
        }
    }
    return rest;
}

} // namespace ringlet
