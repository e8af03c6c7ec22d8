// Catmull–Rom splines through the points of a polyline, and their resampling by arc length.
#pragma once

#include "ringlet/geometry/frames.h"

#include <vector>

namespace ringlet {

// Cubic c0 + t (c1 + t (c2 + t c3)), t in 0…1.
struct Cubic {
    Vec3 c0, c1, c2, c3;
    Vec3 operator()(double t) const { return c0 + t * (c1 + t * (c2 + t * c3)); }
};

// The uniform Catmull–Rom spline through one polyline between its points i and i + 1.
Cubic spline_piece(View<Vec3> points, int i);

// The spline at the parameter `at` in [0, points.size() - 1]; it passes exactly through the points.
Vec3 spline(View<Vec3> points, double at);

// Points evenly spaced along the spline, as many as `result` has; the ends are kept.
void resample(View<Vec3> points, std::span<Vec3> result);

// Points at even arc length along the spline through a finely sampled curve; the ends are kept.
void space_evenly(View<Vec3> fine, std::span<Vec3> result);

} // namespace ringlet
