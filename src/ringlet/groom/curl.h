// Winds curves into curls.
#pragma once

#include "ringlet/geometry/frames.h"

#include <vector>

namespace ringlet {

// One value per lock in each array. Ramps and noises are sampled evenly from root to tip.
struct CurlSettings {
    View<Vec3> axis;          // where the phase counts from: a direction that moves with the scalp
    View<double> radius;      // [m]
    View<double> turns;       // over the whole shape; negative winds left-handed
    View<double> phase;       // [rad]
    View<double> start;       // length over which the curl opens [m]
    View<double> width_ramp;  // factor on the radius, shared by all locks
    View<double> rate_ramp;   // factor on the turns per length, shared by all locks
    View<double> width_noise; // factor - 1 on the radius, `noise_count` values a lock
    View<double> rate_noise;  // factor - 1 on the turns per length, `noise_count` values a lock
    View<double> hand;        // +1 or -1 along the lock, `noise_count` values a lock: a change is a switchback
    int noise_count = 1;
    double flatness = 0.0;    // 0 round … 1 flat
    bool keep_length = false; // the curled arc length is that of the shape, and the silhouette shortens; else the reverse
};

// The helix p(u) = c(u) + r(u) (a(u) cos φ(u) + b(u) sin φ(u)) about each shape curve c, where a and b are its
// rotation-minimising frame and φ' the turns per length; `count` points per lock, evenly spaced along the curl.
std::vector<Vec3> curl(const CurveView &shapes, const CurlSettings &settings, int count);

} // namespace ringlet
