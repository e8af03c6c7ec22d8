// Smooth curves through given points, sampled evenly.
#pragma once

#include "ringlet/geometry/frames.h"

#include <vector>

namespace ringlet {

// A cubic: the point is c0 + t (c1 + t (c2 + t c3)) for t from 0 to 1.
struct Cubic {
    Vec3 c0, c1, c2, c3;
    Vec3 operator()(double t) const { return c0 + t * (c1 + t * (c2 + t * c3)); }
};

// The uniform Catmull–Rom spline through one polyline between its points i and i + 1.
Cubic spline_piece(View<Vec3> points, int i);

// The same at `at` in [0, points.size() - 1]; passes exactly through the points.
Vec3 spline(View<Vec3> points, double at);

// `count` points evenly spaced along that spline, ends kept; written to `result`, whose size is the count.
void resample(View<Vec3> points, std::span<Vec3> result);

// The points at even arc length along the spline through a finely sampled curve, ends kept.
void space_evenly(View<Vec3> fine, std::span<Vec3> result);

} // namespace ringlet
