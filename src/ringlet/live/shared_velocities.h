// Neighbours in a crowd of hair share their motion: a grid of velocities in the frame of the head stands in for contact.
#pragma once

#include "ringlet/geometry/uniform_grid.h"
#include "ringlet/live/pose.h"

#include <vector>

namespace ringlet {

struct Sharing {
    double share = 0.7; // of a vertex's velocity, that is the mean of its neighbours'
    double keep = 0.9;  // of that mean: friction between neighbours takes the rest
};

// A grid over a box in the head's frame, whose cells are some hair clumps wide. As in the material point method, velocities go
// to its corners with trilinear weights, and back (Sulsky, Chen and Schreyer 1994; McAdams et al. 2009 for hair).
class VelocityGrid {
public:
    VelocityGrid(const Vec3 &low, const Vec3 &high, double cell); // [m]

    // Velocities [m/s] after a step of `dt` in which the head went from one pose to another, relative to the head's there, go
    // towards those of the grid. Held vertices move with the head; what is outside the box keeps its velocity.
    void share(View<Vec3> positions, View<double> masses, View<unsigned char> held, const Pose &from, const Pose &to, double dt,
               const Sharing &sharing, std::span<Vec3> velocities);

private:
    struct Corner {
        double mass;
        Vec3 velocity; // momentum, until all vertices are there
    };
    UniformGrid grid_;
    std::vector<Corner> corners_;
    std::vector<std::optional<UniformGrid::Place>> places_; // of vertices
    std::vector<Vec3> relative_;
};

} // namespace ringlet
