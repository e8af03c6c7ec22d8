// A box of equal cells, with values at their corners and trilinear interpolation between these.
#pragma once

#include "ringlet/math/types.h"

#include <cmath>
#include <optional>
#include <stdexcept>

namespace ringlet {

class UniformGrid {
public:
    // Has at most `most` corners; the number of cells along each axis is a multiple of `multiple`. Throws
    // std::invalid_argument.
    UniformGrid(const Vec3 &low, const Vec3 &high, double cell, double most, int multiple = 1) : low_(low), cell_(cell) {
        double corners = 1;
        for (int k = 0; k < 3; ++k) {
            const double cells = multiple * std::ceil((high[k] - low[k]) / (multiple * cell));
            corners *= cells + 1;
            if (!(cells >= 1 && corners <= most)) throw std::invalid_argument("grid: too many cells, or none");
            count_[k] = int(cells) + 1;
        }
    }

    const int *count() const { return count_; } // of corners along each axis
    size_t size() const { return size_t(count_[0]) * count_[1] * count_[2]; }
    size_t corner(int x, int y, int z) const { return (size_t(x) * count_[1] + y) * count_[2] + z; }
    Vec3 at(int x, int y, int z) const { return low_ + cell_ * Vec3(x, y, z); } // [m]

    struct Place {
        size_t corner; // the first of eight
        Vec3 within;   // 0 … 1
    };
    std::optional<Place> locate(const Vec3 &x) const { // none outside
        Place place{0, (x - low_) / cell_};
        for (int k = 0; k < 3; ++k) {
            const double cell = std::floor(place.within[k]);
            if (!(cell >= 0 && cell < count_[k] - 1)) return std::nullopt;
            place.corner = place.corner * count_[k] + size_t(cell);
            place.within[k] -= cell;
        }
        return place;
    }

    // Calls work(corner, weight, derivative of the weight by the place within) for the corners, which are `apart`.
    template <class Work> void for_corners(const Place &place, const Work &work, int apart = 1) const {
        const size_t stride[3] = {size_t(count_[1]) * count_[2], size_t(count_[2]), 1};
        for (int which = 0; which < 8; ++which) {
            Vec3 weight, sign;
            size_t corner = place.corner;
            for (int k = 0; k < 3; ++k) {
                const bool upper = which >> k & 1;
                weight[k] = upper ? place.within[k] : 1 - place.within[k];
                sign[k] = upper ? 1 : -1;
                corner += upper * apart * stride[k];
            }
            work(corner, weight.prod(),
                 Vec3(sign[0] * weight[1] * weight[2], weight[0] * sign[1] * weight[2], weight[0] * weight[1] * sign[2]));
        }
    }

private:
    Vec3 low_;
    double cell_; // [m]
    int count_[3];
};

} // namespace ringlet
