// Curls: helices wound about shape curves.
#pragma once

#include "ringlet/geometry/frames.h"

#include <vector>

namespace ringlet {

// Settings of all curls: arrays with one value per lock, tables with one row per lock. Ramps are sampled evenly from root to
// tip.
struct CurlSettings {
    View<Vec3> axis;         // direction of phase 0; moves with the scalp
    View<double> radius;     // [m]
    View<double> turns;      // over the whole shape
    View<double> phase;      // [rad]
    View<double> flip;       // place where the left-handed curl becomes right-handed: -1 before the root … 2 beyond the tip
    View<double> start, end; // length over which the curl opens at the root and closes at the tip [m]
    View<double> taper;      // relative loss of width where taper_ramp is 1
    View<double> flatness;   // 0 round … 1 flat
    View<double> kink;       // 0 a helix … 1 a zigzag
    View<double> wave;       // amplitude of the plane wave under the curl [m]
    View<double> wave_turns; // periods of that wave over the whole shape

    View<double> width_ramp, rate_ramp; // factors on the radius and on the turns per length, shared by all locks
    View<double> opening, closing;      // the curl's width over start and end, shared by all locks
    View<double> taper_ramp, wave_ramp; // factors on taper and wave, shared by all locks
    View<double> width_noise;           // factor - 1 on the radius, `noise_count` values a lock
    View<double> rate_noise;            // factor - 1 on the turns per length, `noise_count` values a lock
    View<double> sway;                  // rotation of the curl about its shape [rad], `noise_count` values a lock
    View<double> switchbacks;           // places where the hand changes, 0…1 from root to tip, `event_count` a lock
    View<double> skips;                 // places where a turn is left out, 0…1 from root to tip, `event_count` a lock

    View<int> leader;       // the lock whose phase this one joins; its own index: none
    View<double> join;      // weight of the leader's phase, 0…1
    View<double> join_over; // length from the root over which that weight rises [m]
    View<double> cohesion;  // weight of the leader's centre line, 0…1

    int noise_count = 1, event_count = 0;
    bool counted = false;     // whether `turns` is the total also where the shape is shortened; else turns are per length
    bool keep_length = false; // whether the arc length of the curl is that of the shape; else the silhouette is kept
};

// Helix p(v) = c(v) + r(v) (a(v) cos φ(v) + b(v) sin φ(v)) about each shape curve c. The axes a and b are its
// rotation-minimising frame, and φ' is the number of turns per length. Each lock gets `count` points, evenly spaced along the
// curl. With `kink`, cos φ becomes a zigzag in the plane of a. With a leader, φ, r and c blend into those of the leader.
std::vector<Vec3> curl(const CurveView &shapes, const CurlSettings &settings, int count);

// The arrays of a curl by name, for callers that fill them by name: a new array needs a line here, and none where it is bound.
enum class CurlArray { value, ramp, noise, events }; // one a lock; samples for all locks; noise_count or event_count a lock

struct CurlField {
    const char *name;
    View<double> CurlSettings::*array;
    CurlArray kind;
};

inline constexpr CurlField curl_fields[] = {
    {"radius", &CurlSettings::radius, CurlArray::value},
    {"turns", &CurlSettings::turns, CurlArray::value},
    {"phase", &CurlSettings::phase, CurlArray::value},
    {"flip", &CurlSettings::flip, CurlArray::value},
    {"start", &CurlSettings::start, CurlArray::value},
    {"end", &CurlSettings::end, CurlArray::value},
    {"taper", &CurlSettings::taper, CurlArray::value},
    {"flatness", &CurlSettings::flatness, CurlArray::value},
    {"kink", &CurlSettings::kink, CurlArray::value},
    {"wave", &CurlSettings::wave, CurlArray::value},
    {"wave_turns", &CurlSettings::wave_turns, CurlArray::value},
    {"join", &CurlSettings::join, CurlArray::value},
    {"join_over", &CurlSettings::join_over, CurlArray::value},
    {"cohesion", &CurlSettings::cohesion, CurlArray::value},
    {"width_ramp", &CurlSettings::width_ramp, CurlArray::ramp},
    {"rate_ramp", &CurlSettings::rate_ramp, CurlArray::ramp},
    {"opening", &CurlSettings::opening, CurlArray::ramp},
    {"closing", &CurlSettings::closing, CurlArray::ramp},
    {"taper_ramp", &CurlSettings::taper_ramp, CurlArray::ramp},
    {"wave_ramp", &CurlSettings::wave_ramp, CurlArray::ramp},
    {"width_noise", &CurlSettings::width_noise, CurlArray::noise},
    {"rate_noise", &CurlSettings::rate_noise, CurlArray::noise},
    {"sway", &CurlSettings::sway, CurlArray::noise},
    {"switchbacks", &CurlSettings::switchbacks, CurlArray::events},
    {"skips", &CurlSettings::skips, CurlArray::events},
};

} // namespace ringlet
