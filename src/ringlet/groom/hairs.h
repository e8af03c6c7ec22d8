// Hairs carried in the frames of their locks.
#pragma once

#include "ringlet/geometry/frames.h"

#include <vector>

namespace ringlet {

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
};

// Hair p(s) = c(u) + (1 - hold) (x a(u) + y b(u)) + hold · (root + c(0) - c(join)), with the lock c, its rotation-minimising
// frame (a, b), u = join + (tip - join) (s + flat · (pace - s)) and (x, y) = profile · (1 - taper · s) · offset + frizz. A hair
// of offset 0 and root 0 is the lock itself, bit for bit where the points coincide. With a share of another lock it is p +
// share · blend (q - p), where q is the same hair about that lock.
//
// `axis`: first axis of each lock's frame; `root`: vector from the lock's root to the hair's [m], three numbers a hair.
// Writes hair.first.back() × profile.size() points to `result`, three numbers each.
void warp_hairs(View<Vec3f> lock_points, View<int> lock_offsets, View<Vec3> axis, View<float> root, const HairLayout &layout,
                std::span<float> result);

} // namespace ringlet
