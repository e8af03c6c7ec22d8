#include "ringlet/collision/edges_apart.h"

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

// 0 where it is not a number.
Floats fraction(Floats a, Floats b) {
    const Floats none = {};
    return lesser(greater(a / b, none), none + 1.0f);
}

// Between the closest points of two edges, from the first, that begins where places are told from, to the second.
Vector shortest(const Vector &u, const Vector &w, const Vector &v) {
    const Floats uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), uw = dot(u, w), vw = dot(v, w);
    const Floats t = fraction(fraction(uw * vv - uv * vw, uu * vv - uv * uv) * uv - vw, vv), s = fraction(uw + t * uv, uu);
    return w + t * v - s * u;
}

// Where the ends are, told from the first at the start.
struct Ends {
    Vector of[4];

    Vector &operator[](int end) { return of[end]; }
    const Vector &operator[](int end) const { return of[end]; }
};

template <int places> void read_ends(const EdgeWays &pairs, int from, Ends (&at)[places]) {
    for (int axis = 0; axis < 3; ++axis) {
        const Floats first = read(pairs.at[0][0][axis] + from);
        for (int place = 0; place < places; ++place)
            for (int end = 0; end < 4; ++end) at[place][end][axis] = read(pairs.at[place][end][axis] + from) - first;
    }
}

Vector shortest(const Ends &at) { return shortest(at[1] - at[0], at[2] - at[0], at[3] - at[2]); }

// What is between the shadows of the two edges on n, at least of those places together.
Floats gap(const Vector &n, const Ends *first, const Ends *last) {
    Floats most = dot(n, (*first)[0]), least = dot(n, (*first)[2]);
    for (const Ends *at = first; at != last; ++at) {
        most = greater(most, greater(dot(n, (*at)[0]), dot(n, (*at)[1])));
        least = lesser(least, lesser(dot(n, (*at)[2]), dot(n, (*at)[3])));
    }
    return least - most;
}

Bits is_more(Floats gap, Floats reach, const Vector &n) {
    const Floats none = {};
    return (gap > none) & (gap * gap > reach * reach * dot(n, n));
}

// Seen along the line between the closest points of the edges between the middles of their boxes.
Bits apart_along_shortest(const EdgePairs &pairs, int from) {
    const Floats none = {};
    Vector middle[4], width[4]; // both doubled, and middles told from the first
    for (int end = 0; end < 4; ++end)
        for (int axis = 0; axis < 3; ++axis) {
            const Floats low = read(pairs.low[end][axis] + from), high = read(pairs.high[end][axis] + from);
            middle[end][axis] = low + high;
            width[end][axis] = high - low;
        }
    for (int axis = 0; axis < 3; ++axis) {
        for (int end = 1; end < 4; ++end) middle[end][axis] -= middle[0][axis];
        middle[0][axis] = none;
    }
    const Vector n = shortest(middle[1], middle[2], middle[3] - middle[2]);
    Vector sizes;
    for (int axis = 0; axis < 3; ++axis) sizes[axis] = n[axis] < none ? -n[axis] : n[axis];
    const auto least = [&](int end) { return dot(n, middle[end]) - dot(sizes, width[end]); };
    const auto most = [&](int end) { return dot(n, middle[end]) + dot(sizes, width[end]); };
    return is_more(lesser(least(2), least(3)) - greater(most(0), most(1)), 2.0f * read(pairs.reach + from), n);
}

// Seen along the line between their closest points at the start, or from where their way together, which may be long beside
// what is between them, is but a point.
Bits apart_on_ways(const EdgeWays &pairs, int from) {
    const Floats none = {};
    Ends at[3];
    read_ends(pairs, from, at);
    const Floats reach = read(pairs.reach + from);
    Vector way = at[1][0] - at[0][0];
    for (int end = 1; end < 4; ++end) way = way + (at[1][end] - at[0][end]);
    const Floats way2 = dot(way, way);
    const auto across = [&](const Vector &x) {
        const Floats part = dot(x, way) / way2;
        return x - (way2 > none ? part : none) * way;
    };
    const Vector straight = shortest(at[0]);
    const Vector aside = shortest(across(at[0][1] - at[0][0]), across(at[0][2] - at[0][0]), across(at[0][3] - at[0][2]));
    return is_more(gap(straight, at, at + 3), reach, straight) | is_more(gap(aside, at, at + 3), reach, aside);
}

// What is between shadows is never less than at the start or at the end.
Bits apart_on_way_together(const EdgeWays &pairs, int from) {
    Ends at[2];
    read_ends(pairs, from, at);
    const Floats reach = read(pairs.reach + from);
    const auto along = [&](const Vector &n) { return is_more(lesser(gap(n, at, at + 1), gap(n, at + 1, at + 2)), reach, n); };
    return along(shortest(at[0])) | along(shortest(at[1]));
}

// Of all pairs, as many at a time as there are lanes.
template <class Of> unsigned of_all(int room, const Of &of) {
    unsigned which = 0;
    for (int from = 0; from < room; from += width) which |= lanes_of(of(from)) << from;
    return which;
}

} // namespace

unsigned apart(const EdgePairs &pairs) {
    return of_all(EdgePairs::room, [&](int from) { return apart_along_shortest(pairs, from); });
}

unsigned apart_anywhere(const EdgeWays &pairs) {
    return of_all(EdgeWays::room, [&](int from) { return apart_on_ways(pairs, from); });
}

unsigned apart_together(const EdgeWays &pairs) {
    return of_all(EdgeWays::room, [&](int from) { return apart_on_way_together(pairs, from); });
}

} // namespace ringlet::RINGLET_SIMD
