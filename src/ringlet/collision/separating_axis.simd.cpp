#include "ringlet/collision/separating_axis.h"

#include "ringlet/math/floats.h"

namespace ringlet::RINGLET_SIMD {
namespace {

struct Vector {
    Floats of[3];

    Floats &operator[](int axis) { return of[axis]; }
    const Floats &operator[](int axis) const { return of[axis]; }
};

Vector operator-(const Vector &a, const Vector &b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vector operator+(const Vector &a, const Vector &b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vector operator*(Floats s, const Vector &a) { return {s * a[0], s * a[1], s * a[2]}; }
Floats dot(const Vector &a, const Vector &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// a / b in [0, 1]; 0 where it is not a number.
Floats fraction(Floats a, Floats b) {
    const Floats none = {};
    return lesser(greater(a / b, none), none + 1.0f);
}

// The vector between the closest points of two edges; the first begins at the origin.
Vector shortest(const Vector &u, const Vector &w, const Vector &v) {
    const Floats uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), uw = dot(u, w), vw = dot(v, w);
    const Floats t = fraction(fraction(uw * vv - uv * vw, uu * vv - uv * uv) * uv - vw, vv), s = fraction(uw + t * uv, uu);
    return w + t * v - s * u;
}

// The ends of a pair, relative to the first at the start.
struct Ends {
    Vector of[4];

    Vector &operator[](int end) { return of[end]; }
    const Vector &operator[](int end) const { return of[end]; }
};

template <int positions> void read_ends(const MovingEdgePairs &pairs, int from, Ends (&at)[positions]) {
    for (int axis = 0; axis < 3; ++axis) {
        const Floats first = read(pairs.at[0][0][axis] + from);
        for (int position = 0; position < positions; ++position)
            for (int end = 0; end < 4; ++end) at[position][end][axis] = read(pairs.at[position][end][axis] + from) - first;
    }
}

Vector shortest(const Ends &at) { return shortest(at[1] - at[0], at[2] - at[0], at[3] - at[2]); }

// The gap of the projections of two edges onto n, over all given positions together.
Floats gap(const Vector &n, const Ends *first, const Ends *last) {
    Floats most = dot(n, (*first)[0]), least = dot(n, (*first)[2]);
    for (const Ends *at = first; at != last; ++at) {
        most = greater(most, greater(dot(n, (*at)[0]), dot(n, (*at)[1])));
        least = lesser(least, lesser(dot(n, (*at)[2]), dot(n, (*at)[3])));
    }
    return least - most;
}

Bits exceeds(Floats gap, Floats reach, const Vector &n) {
    const Floats none = {};
    return (gap > none) & (gap * gap > reach * reach * dot(n, n));
}

// The axis joins the closest points of the edges between the centres of their boxes.
Bits in_boxes(const BoxedEdgePairs &pairs, int from) {
    const Floats none = {};
    Vector centre[4], width[4]; // both doubled, centres relative to the first
    for (int end = 0; end < 4; ++end)
        for (int axis = 0; axis < 3; ++axis) {
            const Floats low = read(pairs.low[end][axis] + from), high = read(pairs.high[end][axis] + from);
            centre[end][axis] = low + high;
            width[end][axis] = high - low;
        }
    for (int axis = 0; axis < 3; ++axis) {
        for (int end = 1; end < 4; ++end) centre[end][axis] -= centre[0][axis];
        centre[0][axis] = none;
    }
    const Vector n = shortest(centre[1], centre[2], centre[3] - centre[2]);
    Vector sizes;
    for (int axis = 0; axis < 3; ++axis) sizes[axis] = n[axis] < none ? -n[axis] : n[axis];
    const auto least = [&](int end) { return dot(n, centre[end]) - dot(sizes, width[end]); };
    const auto most = [&](int end) { return dot(n, centre[end]) + dot(sizes, width[end]); };
    return exceeds(lesser(least(2), least(3)) - greater(most(0), most(1)), 2.0f * read(pairs.reach + from), n);
}

// Two axes: one joins the closest points at the start; the other does so after projection along the mean motion, which may be
// long compared with the gap.
Bits in_triangles(const MovingEdgePairs &pairs, int from) {
    const Floats none = {};
    Ends at[3];
    read_ends(pairs, from, at);
    const Floats reach = read(pairs.reach + from);
    Vector motion = at[1][0] - at[0][0];
    for (int end = 1; end < 4; ++end) motion = motion + (at[1][end] - at[0][end]);
    const Floats motion2 = dot(motion, motion);
    const auto reject = [&](const Vector &x) {
        const Floats along = dot(x, motion) / motion2;
        return x - (motion2 > none ? along : none) * motion;
    };
    const Vector at_start = shortest(at[0]);
    const Vector projected = shortest(reject(at[0][1] - at[0][0]), reject(at[0][2] - at[0][0]), reject(at[0][3] - at[0][2]));
    return exceeds(gap(at_start, at, at + 3), reach, at_start) | exceeds(gap(projected, at, at + 3), reach, projected);
}

// The gap of projections of straight motions is never below the lesser of its values at the start and at the end.
Bits in_motion(const MovingEdgePairs &pairs, int from) {
    Ends at[2];
    read_ends(pairs, from, at);
    const Floats reach = read(pairs.reach + from);
    const auto separates = [&](const Vector &n) {
        return exceeds(lesser(gap(n, at, at + 1), gap(n, at + 1, at + 2)), reach, n);
    };
    return separates(shortest(at[0])) | separates(shortest(at[1]));
}

// All pairs, a SIMD width at a time.
template <class Test> unsigned for_all(int room, const Test &test) {
    unsigned which = 0;
    for (int from = 0; from < room; from += width) which |= lanes_of(test(from)) << from;
    return which;
}

} // namespace

unsigned separated_in_boxes(const BoxedEdgePairs &pairs) {
    return for_all(BoxedEdgePairs::room, [&](int from) { return in_boxes(pairs, from); });
}

unsigned separated_in_triangles(const MovingEdgePairs &pairs) {
    return for_all(MovingEdgePairs::room, [&](int from) { return in_triangles(pairs, from); });
}

unsigned separated_in_motion(const MovingEdgePairs &pairs) {
    return for_all(MovingEdgePairs::room, [&](int from) { return in_motion(pairs, from); });
}

} // namespace ringlet::RINGLET_SIMD
