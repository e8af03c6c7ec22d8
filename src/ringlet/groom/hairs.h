// Hairs around moving guides.
#pragma once

#include "ringlet/geometry/frames.h"

#include <vector>

namespace ringlet {

// Per hair: where it sits in its lock. Per point: ramps shared by all hairs, sampled from root to tip.
struct HairLayout {
    View<int> first;     // the hairs of lock i are first[i] up to first[i + 1]
    View<float> offset;  // place in the lock's cross-section [m], two numbers a hair
    View<float> tip;     // the part of the lock that the hair reaches along, 0…1
    View<float> taper;   // how much narrower the cross-section gets towards the tip, 0…1, per hair
    View<float> frizz;   // wander across the lock [m]: knots from root to tip, two numbers each
    int knots = 4;       // per hair
    View<float> profile; // factor on the offset, per point
    View<float> hold;    // per point: 1 where the hair stands on its root, 0 where it follows the lock
    View<int> other;     // a neighbouring lock that each hair is drawn to; may be empty: none is
    View<float> share;   // how far, 0…1, per hair
    View<float> blend;   // factor on the share, per point
};

// p(s) = c(s) + (1 - hold) (x a(s) + y b(s)) + hold · root, with the lock c, its rotation-minimising frame (a, b) and
// (x, y) = profile · (1 - taper · s) · offset + frizz: a hair of offset 0 and root 0 is the lock itself, bit for bit where the
// points fall together. A hair with a share of another lock is p + share · blend (q - p), with q the same hair about the other.
// `axis`: where each lock's frame starts; `root`: from each lock's root to each hair's [m], three numbers a hair.
// Writes hair.first.back() × profile.size() points to `result`, three numbers each.
void warp_hairs(View<Vec3f> lock_points, View<int> lock_offsets, View<Vec3> axis, View<float> root, const HairLayout &layout,
                std::span<float> result);

} // namespace ringlet
