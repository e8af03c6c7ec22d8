#include "ringlet/geometry/distance_grid.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace ringlet {
namespace {

constexpr double most_corners = 1 << 24;
constexpr int coarse = 4; // cells of a coarse one

} // namespace

DistanceGrid::DistanceGrid(const Solid &solid, const Vec3 &low, const Vec3 &high, double cell, double band)
    : low_(low), cell_(cell) {
    double corners = 1;
    for (int k = 0; k < 3; ++k) {
        const double cells = coarse * std::ceil((high[k] - low[k]) / (coarse * cell));
        corners *= cells + 1;
        if (!(cells >= 1 && corners <= most_corners)) throw std::invalid_argument("distance grid: too many cells, or none");
        count_[k] = int(cells) + 1;
    }
    corners_.resize(size_t(corners));
    const double far = band + coarse * cell; // a distance changes by less within a coarse cell
    for (const int stride : {coarse, 1}) {
#pragma omp parallel for schedule(dynamic)
        for (int x = 0; x < count_[0]; x += stride)
            for (int y = 0; y < count_[1]; y += stride) {
                int hint = -1; // the closest triangle of a corner is near that of the one before
                for (int z = 0; z < count_[2]; z += stride) {
                    float &distance = corners_[corner(x, y, z)];
                    if (stride == 1) {
                        if (x % coarse == 0 && y % coarse == 0 && z % coarse == 0) continue;
                        const double about = between_coarse(x, y, z);
                        distance = float(about);
                        if (std::abs(about) > far) continue;
                    }
                    const SignedDistance found =
                        solid.signed_distance(low_ + cell_ * Vec3(x, y, z), std::numeric_limits<double>::infinity(), hint);
                    hint = found.triangle;
                    distance = float(found.distance);
                }
            }
    }
}

double DistanceGrid::between_coarse(int x, int y, int z) const {
    const int at[3] = {x, y, z};
    int low[3];
    double t[3];
    for (int k = 0; k < 3; ++k) {
        low[k] = std::min(at[k] / coarse, (count_[k] - 1) / coarse - 1) * coarse;
        t[k] = double(at[k] - low[k]) / coarse;
    }
    double sum = 0;
    for (int which = 0; which < 8; ++which) {
        double weight = 1;
        int of[3];
        for (int k = 0; k < 3; ++k) {
            const bool upper = which >> k & 1;
            weight *= upper ? t[k] : 1 - t[k];
            of[k] = low[k] + upper * coarse;
        }
        sum += weight * corners_[corner(of[0], of[1], of[2])];
    }
    return sum;
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
