// Winds curves into curls.
#pragma once

#include "ringlet/geometry/frames.h"

#include <vector>

namespace ringlet {

// One value per lock in each array, and a row per lock in each table. Ramps are sampled evenly from root to tip.
struct CurlSettings {
    View<Vec3> axis;         // where the phase counts from: a direction that moves with the scalp
    View<double> radius;     // [m]
    View<double> turns;      // over the whole shape
    View<double> phase;      // [rad]
    View<double> flip;       // where the lock, left-handed before, becomes right-handed: -1 from the root on … 2 nowhere
    View<double> start, end; // length over which the curl opens at the root and closes at the tip [m]
    View<double> taper;      // how much narrower the curl gets, as taper_ramp goes from 0 to 1
    View<double> flatness;   // 0 round … 1 flat
    View<double> kink;       // 0 a helix … 1 a zigzag
    View<double> wave;       // amplitude of the plane wave under the curl [m]
    View<double> wave_turns; // periods of that wave over the whole shape

    View<double> width_ramp, rate_ramp; // factors on the radius and on the turns per length, shared by all locks
    View<double> opening, closing;      // the curl's width over start and end, shared by all locks
    View<double> taper_ramp, wave_ramp; // factors on taper and wave, shared by all locks
    View<double> width_noise;           // factor - 1 on the radius, `noise_count` values a lock
    View<double> rate_noise;            // factor - 1 on the turns per length, `noise_count` values a lock
    View<double> sway;                  // angle by which the whole turns about the shape [rad], `noise_count` values a lock
    View<double> switchbacks;           // where the curl changes its hand, 0…1 from root to tip, `event_count` a lock
    View<double> skips;                 // where it leaves out a turn, 0…1 from root to tip, `event_count` a lock

    View<int> leader;       // the lock in whose phase this one falls; itself where in none
    View<double> join;      // how far it does, 0…1
    View<double> join_over; // length from the root over which it does [m]
    View<double> cohesion;  // how far its middle line is drawn to the leader's, 0…1

    int noise_count = 1, event_count = 0;
    bool counted = false;     // turns are all there are, however short the curled shape is; else they are per length
    bool keep_length = false; // the curled length is that of the shape, and the silhouette shortens; else the reverse
};

// The helix p(v) = c(v) + r(v) (a(v) cos φ(v) + b(v) sin φ(v)) about each shape curve c, where a and b are its
// rotation-minimising frame and φ' the turns per length; `count` points per lock, evenly spaced along the curl.
// With `kink` cos φ becomes a zigzag in the plane of a; with a leader, φ, r and c go over into the leader's.
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
