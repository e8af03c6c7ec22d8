#include "ringlet/geometry/distance_grid.h"

#include <cmath>
#include <stdexcept>

namespace ringlet {
namespace {

constexpr double most_corners = 1 << 24;

} // namespace

DistanceGrid::DistanceGrid(const Solid &solid, const Vec3 &low, const Vec3 &high, double cell) : low_(low), cell_(cell) {
    double corners = 1;
    for (int k = 0; k < 3; ++k) {
        const double cells = std::ceil((high[k] - low[k]) / cell);
        corners *= cells + 1;
        if (!(cells >= 1 && corners <= most_corners)) throw std::invalid_argument("distance grid: too many cells, or none");
        count_[k] = int(cells) + 1;
    }
    corners_.resize(size_t(corners));
#pragma omp parallel for schedule(dynamic)
    for (int x = 0; x < count_[0]; ++x)
        for (int y = 0; y < count_[1]; ++y) {
            int hint = -1; // the closest triangle of a corner is near that of the one before
            for (int z = 0; z < count_[2]; ++z) {
                const SignedDistance found = solid.signed_distance(low_ + cell_ * Vec3(x, y, z), //
                                                                   std::numeric_limits<double>::infinity(), hint);
                hint = found.triangle;
                corners_[(size_t(x) * count_[1] + y) * count_[2] + z] = float(found.distance);
            }
        }
}

DistanceGrid::Sample DistanceGrid::at(const Vec3 &place) const {
    const Vec3 cells = (place - low_) / cell_;
    size_t corner = 0;
    double t[3];
    for (int k = 0; k < 3; ++k) {
        const double cell = std::floor(cells[k]);
        if (!(cell >= 0 && cell < count_[k] - 1)) return {};
        corner = corner * count_[k] + size_t(cell);
        t[k] = cells[k] - cell;
    }
    const size_t stride[3] = {size_t(count_[1]) * count_[2], size_t(count_[2]), 1};
    Sample sample{0, Vec3::Zero()};
    for (int which = 0; which < 8; ++which) {
        double weight[3], sign[3];
        size_t at = corner;
        for (int k = 0; k < 3; ++k) {
            const bool upper = which >> k & 1;
            weight[k] = upper ? t[k] : 1 - t[k];
            sign[k] = upper ? 1 : -1;
            at += upper * stride[k];
        }
        const double value = corners_[at];
        sample.distance += weight[0] * weight[1] * weight[2] * value;
        sample.gradient +=
            value * Vec3(sign[0] * weight[1] * weight[2], weight[0] * sign[1] * weight[2], weight[0] * weight[1] * sign[2]);
    }
    const double length = sample.gradient.norm();
    if (length > 0) sample.gradient /= length;
    return sample;
}

} // namespace ringlet
