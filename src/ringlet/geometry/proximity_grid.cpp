#include "ringlet/geometry/proximity_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ringlet {

ProximityGrid::ProximityGrid(const TriangleMesh &mesh, double distance) : distance_(distance) {
    constexpr double max_cells = 128.0; // along the longest side
    const Vec3 infinite = Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 low = infinite, high = -infinite;
    for (const Vec3 &p : mesh.points) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    low.array() -= distance;
    high.array() += distance;
    const double cell = std::max(distance, (high - low).maxCoeff() / max_cells);
    if (!(cell > 0.0) || !std::isfinite(cell)) return;
    low_ = low;
    per_length_ = 1.0 / cell;
    size_ = ((high - low).array() * per_length_).cast<int>() + 1;
    near_.assign(static_cast<size_t>(size_[0]) * size_[1] * size_[2], 0);

    const auto at = [&](const Vec3 &p) { return Eigen::Array3i(((p - low_).array() * per_length_).cast<int>()); };
    for (const Triangle &t : mesh.triangles) {
        const Vec3 &a = mesh.points[t[0]], &b = mesh.points[t[1]], &c = mesh.points[t[2]];
        const Eigen::Array3i first = at(a.cwiseMin(b).cwiseMin(c).array() - distance).max(0);
        const Eigen::Array3i last = at(a.cwiseMax(b).cwiseMax(c).array() + distance).min(size_ - 1);
        for (int x = first[0]; x <= last[0]; ++x)
            for (int y = first[1]; y <= last[1]; ++y) {
                unsigned char *row = near_.data() + index({x, y, 0});
                std::fill(row + first[2], row + last[2] + 1, 1);
            }
    }
}

} // namespace ringlet
