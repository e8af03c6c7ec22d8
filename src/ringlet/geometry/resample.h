// Cubic splines through the points of a polyline, and their resampling by arc length.
#pragma once

#include "ringlet/geometry/frames.h"

#include <vector>

namespace ringlet {

// Cubic c0 + t (c1 + t (c2 + t c3)), t in 0…1.
struct Cubic {
    Vec3 c0, c1, c2, c3;
    Vec3 operator()(double t) const { return c0 + t * (c1 + t * (c2 + t * c3)); }
};

// The cubic spline through a polyline of at least two points, piece by piece: curvature is continuous, so that a smooth shape
// of few points shows no bends at them. Its parameter is the chord length, so that points may be unevenly spaced.
std::vector<Cubic> spline(View<Vec3> points);

// Points of the spline at lengths along the polyline [m], as many as `result` has; beyond the ends, on the tangents there.
void on_spline(View<Vec3> points, View<double> along, std::span<Vec3> result);

// Points evenly spaced along the spline, as many as `result` has; the ends are kept.
void resample(View<Vec3> points, std::span<Vec3> result);

// Points at even arc length along the spline through a finely sampled curve; the ends are kept.
void space_evenly(View<Vec3> fine, std::span<Vec3> result);

} // namespace ringlet
