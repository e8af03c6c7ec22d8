// Signed distance to a solid, sampled on a grid.
#pragma once

#include "ringlet/geometry/solid.h"

namespace ringlet {

// Trilinear between its corners: a distance and its gradient take a hundredth of the time of the closest triangle.
class DistanceGrid {
public:
    DistanceGrid(const Solid &solid, const Vec3 &low, const Vec3 &high, double cell); // [m]

    struct Sample {
        double distance = std::numeric_limits<double>::infinity(); // [m], negative inside; infinite outside the grid
        Vec3 gradient = Vec3::Zero();                              // of length 1
    };
    Sample at(const Vec3 &place) const;

private:
    Vec3 low_;
    double cell_;
    int count_[3];
    std::vector<float> corners_;
};

} // namespace ringlet
