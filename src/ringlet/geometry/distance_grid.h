// Signed distance to a solid, sampled on a grid.
#pragma once

#include "ringlet/geometry/solid.h"

namespace ringlet {

// Trilinear between its corners: a distance and its gradient take a hundredth of the time of the closest triangle. Corners
// within `band` of the surface have their own distance. Farther ones take it from a grid of cells that are four times as wide.
class DistanceGrid {
public:
    DistanceGrid(const Solid &solid, const Vec3 &low, const Vec3 &high, double cell, double band); // [m]

    struct Sample {
        double distance = std::numeric_limits<double>::infinity(); // [m], negative inside; infinite outside the grid
        Vec3 gradient = Vec3::Zero();                              // of length 1
    };
    Sample at(const Vec3 &place) const;

private:
    size_t corner(int x, int y, int z) const { return (size_t(x) * count_[1] + y) * count_[2] + z; }
    double between_coarse(int x, int y, int z) const;

    Vec3 low_;
    double cell_;
    int count_[3];
    std::vector<float> corners_;
};

} // namespace ringlet
