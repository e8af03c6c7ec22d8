// Smooth curves through given points, sampled evenly.
#pragma once

#include "ringlet/geometry/frames.h"

#include <vector>

namespace ringlet {

// The uniform Catmull–Rom spline through one polyline at `at` in [0, points.size() - 1]; passes exactly through the points.
Vec3 spline(View<Vec3> points, double at);

// `count` points evenly spaced along that spline, ends kept; written to `result`, whose size is the count.
void resample(View<Vec3> points, std::span<Vec3> result);

// The points at even arc length along the spline through a finely sampled curve, ends kept.
void space_evenly(View<Vec3> fine, std::span<Vec3> result);

} // namespace ringlet
