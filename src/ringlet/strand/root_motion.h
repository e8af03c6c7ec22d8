// Rigid motion of a strand's root in one step: p → to + R (p − from). T = double or one strand per lane (T = Pack).
#pragma once

#include "ringlet/energy/strand/bend.h"
#include "ringlet/math/pack.h"
#include "ringlet/strand/settings.h"

namespace ringlet::RINGLET_SIMD {

template <class T> inline Vec<T> unit(Vec<T> v) { return (1.0 / max(norm(v), constant<T>(1e-30))) * v; }

template <class T> struct RootMotion {
    Vec<T> from, to;    // of the first vertex
    Vec<T> rotation[3]; // rows of R

    // Takes the first three vertices from `start` to `target`. They define a rotation where all three are held and not in
    // line; elsewhere the root translates.
    RootMotion(const Vec<T> *start, const Vec<T> *target, MaskOf<T> third_is_held) : from(start[0]), to(target[0]) {
        const Vec<T> t0 = unit(start[1] - start[0]), t1 = unit(target[1] - target[0]);
        const Corner<T> before = corner(t0, unit(start[2] - start[1])), after = corner(t1, unit(target[2] - target[1]));
        const Vec<T> side0 = cross(before.normal, t0), side1 = cross(after.normal, t1);
        const auto rotates =
            third_is_held & (before.sine > strand_settings::rotation_sine) & (after.sine > strand_settings::rotation_sine);
        for (int k = 0; k < 3; ++k) {
            const Vec<T> row = t1[k] * t0 + after.normal[k] * before.normal + side1[k] * side0;
            Vec<T> identity{};
            identity[k] = constant<T>(1.0);
            rotation[k] = select<T>(rotates, row, identity);
        }
    }

    Vec<T> rotate(Vec<T> v) const { return {dot(rotation[0], v), dot(rotation[1], v), dot(rotation[2], v)}; }
    Vec<T> apply(Vec<T> p) const { return to + rotate(p - from); }
};

} // namespace ringlet::RINGLET_SIMD
