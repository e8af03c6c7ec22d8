#include "ringlet/geometry/distance_grid.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ringlet {
namespace {

constexpr double most_corners = 1 << 24;
constexpr int coarse = 4; // cells of a coarse one

} // namespace

DistanceGrid::DistanceGrid(const Solid &solid, const Vec3 &low, const Vec3 &high, double cell, double band)
    : grid_(low, high, cell, most_corners, coarse), corners_(grid_.size()) {
    const double far = band + coarse * cell; // a distance changes by less within a coarse cell
    const int *const count = grid_.count();
    for (const int stride : {coarse, 1}) {
#pragma omp parallel for schedule(dynamic)
        for (int x = 0; x < count[0]; x += stride)
            for (int y = 0; y < count[1]; y += stride) {
                int hint = -1; // the closest triangle of a corner is near that of the one before
                for (int z = 0; z < count[2]; z += stride) {
                    float &distance = corners_[grid_.corner(x, y, z)];
                    if (stride == 1) {
                        if (x % coarse == 0 && y % coarse == 0 && z % coarse == 0) continue;
                        const double about = between_coarse({x, y, z});
                        distance = float(about);
                        if (std::abs(about) > far) continue;
                    }
                    const SignedDistance found =
                        solid.signed_distance(grid_.at(x, y, z), std::numeric_limits<double>::infinity(), hint);
                    hint = found.triangle;
                    distance = float(found.distance);
                }
            }
    }
}

double DistanceGrid::between_coarse(const std::array<int, 3> &corner) const {
    std::array<int, 3> low;
    Vec3 within;
    for (int k = 0; k < 3; ++k) {
        low[k] = std::min(corner[k] / coarse, (grid_.count()[k] - 1) / coarse - 1) * coarse;
        within[k] = double(corner[k] - low[k]) / coarse;
    }
    double sum = 0;
    grid_.for_corners(
        {grid_.corner(low[0], low[1], low[2]), within},
        [&](size_t at, double weight, const Vec3 &) { sum += weight * corners_[at]; }, coarse);
    return sum;
}

DistanceGrid::Sample DistanceGrid::at(const Vec3 &place) const {
    const auto found = grid_.locate(place);
    if (!found) return {};
    Sample sample{0, Vec3::Zero()};
    grid_.for_corners(*found, [&](size_t at, double weight, const Vec3 &slope) {
        sample.distance += weight * corners_[at];
        sample.gradient += corners_[at] * slope;
    });
    const double length = sample.gradient.norm();
    if (length > 0) sample.gradient /= length;
    return sample;
}

} // namespace ringlet
