// Bodies as planes in front of the vertices of hair, for a step.
#pragma once

#include "ringlet/geometry/distance_grid.h"
#include "ringlet/live/pose.h"

#include <vector>

namespace ringlet {

// The planes n · x ≥ d that keep vertices outside, at the end of a step.
struct BodyPlanes {
    std::vector<Vec3> normal;
    std::vector<double> offset; // d [m]
    std::vector<double> gap;    // of a vertex from its plane at the start, by the motion of its body [m]; infinite: no plane

    explicit BodyPlanes(size_t vertices)
        : normal(vertices, Vec3::Zero()), offset(vertices, 0.0), gap(vertices, std::numeric_limits<double>::infinity()) {}

    // Takes a body, with vertices where they start the step. Each gets the plane that touches the surface `clearance` [m] away
    // from the body, nearest to where it starts; of several bodies that of the least gap.
    void add(const DistanceGrid &body, const Pose &from, const Pose &to, View<Vec3> positions, View<double> clearance);

    // The same of a ball whose centre goes from one place to another. What is inside comes out by `most` [m] at most.
    void add_ball(const Vec3 &from, const Vec3 &to, double radius, double most, View<Vec3> positions, View<double> clearance);

private:
    void check(View<Vec3> positions, View<double> clearance) const;
};

} // namespace ringlet
