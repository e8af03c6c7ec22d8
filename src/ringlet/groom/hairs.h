// Hairs carried in the frames of their locks.
#pragma once

#include "ringlet/geometry/frames.h"

#include <vector>

namespace ringlet {

// Curl of hairs within their locks; all arrays are empty where hairs only follow their lock. Phases are in turns.
struct HairCurl {
    View<int> window;   // points of a turn of each lock's coil; 0 where it has none
    View<float> slip;   // phase of the hair relative to its lock: knots from root to tip
    View<float> escape; // offset of the hair's coil from the lock's centre line [m], two numbers a hair
    View<float> relax;  // relative loss of the coil's radius, 0…1, per hair
    View<float> family; // vector to the hair's place in its sub-clump [m], two numbers a hair
    View<float> coil;   // coil of the hair itself, per hair: radius times its direction [m] (2), turns, kink
    View<float> phase;  // phase of that coil: knots from root to tip
    View<float> escaping, relaxing, tight, opening; // factors on escape, relax, family and coil, per point
    bool empty() const { return window.empty(); }
};

// Layout of the hairs of all locks: places in the cross-section per hair, and ramps from root to tip that all hairs share.
struct HairLayout {
    View<int> first;     // the hairs of lock i are first[i] up to first[i + 1]
    View<float> offset;  // place in the lock's cross-section [m], two numbers a hair
    View<float> tip;     // place on the lock where the hair ends, 0 root … 1 tip, per hair
    View<float> join;    // place on the lock where the hair joins it, 0 root … 1 tip, per hair
    View<float> flat;    // 0…1, per hair: 1 where it first goes straight to that place, 0 where it runs along the lock at once
    View<float> taper;   // relative loss of the offset at the tip, 0…1, per hair
    View<float> frizz;   // noise across the lock [m]: knots from root to tip, two numbers each
    int knots = 4;       // per hair
    View<float> profile; // factor on the offset, per point
    View<float> hold;    // per point: 1 where the hair follows its own root, 0 where it follows the lock
    View<float> pace;    // per point: how far along the lock a flat hair is, 0…1
    View<int> other;     // neighbouring lock that each hair blends with; may be empty
    View<float> share;   // weight of that lock, 0…1, per hair
    View<float> blend;   // factor on the share, per point
    HairCurl curl;
};

// Hair p(s) = c(u) + (1 - hold) (x a(u) + y b(u)) + hold · (root + c(0) - c(join)), with the lock c, its rotation-minimising
// frame (a, b), u = join + (tip - join) (s + flat · (pace - s)) and (x, y) = profile · (1 - taper · s) · offset + frizz. A hair
// of offset 0 and root 0 is the lock itself, bit for bit where the points coincide. With a share of another lock it is p +
// share · blend (q - p), where q is the same hair about that lock.
//
// With a curl, (x, y) are taken to the hair's sub-clump and wind about that in a coil of their own: a cosine across and a sine
// up, or a triangle wave with kink. The radius D = c - m of the lock's coil about its centre line m turns about the tangent of
// m by the slip δ and shrinks by the relaxation g: p gains (1 - g) R(δ) D - D + escape, in a rotation-minimising frame of m.
//
// `axis`: first axis of each lock's frame; `root`: vector from the lock's root to the hair's [m], three numbers a hair.
// Writes hair.first.back() × profile.size() points to `result`, three numbers each.
void warp_hairs(View<Vec3f> lock_points, View<int> lock_offsets, View<Vec3> axis, View<float> root, const HairLayout &layout,
                std::span<float> result);

} // namespace ringlet
