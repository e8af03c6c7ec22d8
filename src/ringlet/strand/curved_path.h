// Curved path of a strand along a search direction: edges rotate where straight paths of their ends would stretch them.
// On straight paths an edge that rotates by φ gets longer by ½ φ². As stretch is stiff, a line search would leave next to
// nothing of a direction that rotates edges.
#pragma once

#include "ringlet/energy/strand/frame.h"
#include "ringlet/strand/settings.h"
#include "ringlet/strand/vertex_data.h"

namespace ringlet::RINGLET_SIMD {

template <class T> inline void put(T *u, Vec<T> v) {
    u[0] = v.x;
    u[1] = v.y;
    u[2] = v.z;
}

template <int dofs, class T> inline Vec<T> position(const T *x, int i) {
    return {x[dofs * i], x[dofs * i + 1], x[dofs * i + 2]};
}

// At a held vertex that is no tip the path has missed by `miss`. The edges since the last held vertex, of total rest length
// `length`, share the correction.
template <int dofs, class Row, class T>
void close_path(const Row *rows, int held_at, const MaskOf<T> &held, T length, Vec<T> miss, T *to) {
    if (held_at == 0) return;
    T open = select(held & (rows[held_at - 1].stretch_stiffness > 0.0), length, T{}); // behind the tip nothing is missed
    const Vec<T> correction = (1.0 / select(open > 0.0, open, constant<T>(1.0))) * miss;
    for (int i = held_at - 1; i >= 0 && any(open > 0.0); --i) {
        open = select(rows[i].free > 0.0, max(open - rows[i].rest_length, T{}), T{});
        put(to + dofs * i, position<dofs>(to, i) - open * correction);
    }
}

// How much of the spin of edge i about itself rotates it: all where its corners are curved at rest, and none where they are
// straight. There nothing determines the spin, and edges that rotated with it would be led aside by chance.
template <class Row> auto rotation_share(const Row *rows, int i) {
    using T = decltype(rows->free);
    const T angle = (1.0 / strand_settings::curved_angle) * max(abs(rows[i].rest_angle), abs(rows[i + 1].rest_angle));
    return min(angle * angle, constant<T>(1.0));
}

// An edge and the angle of its frame, as a value of γ l̄ [m], at the end of a path.
template <class T> struct RotatedEdge {
    Vec<T> edge;
    T frame;
};

// A change of the edge and of its frame, as the rotation that it is to first order, applied to both: what rotates rigidly to
// first order does so exactly. The angle is atan ‖ω‖, as that of a straight path, since directions of radians overshoot. The
// edge keeps its length; where nothing changes the result is the same to the bit.
template <int dofs, class Row, class T>
RotatedEdge<T> rotate_edge(const Row &row, T share, Vec<T> edge, T length, Vec<T> change, T frame, T frame_change) {
    const Vec<T> t = (1.0 / length) * edge, sideways = (1.0 / length) * (change - dot(t, change) * t); // ω × t
    T about{};                                                                                         // ω · t
    if constexpr (dofs == 4)
        about = row.frame_free * (frame_change / row.rest_length + dot(spin(row.reference.tangent, t, length), change));
    const Vec<T> omega = cross(t, sideways) + share * about * t;
    const T cosine = 1.0 / sqrt(1.0 + dot(omega, omega)), twice = cosine * cosine / (1.0 + cosine);
    const auto rotate = [&](Vec<T> v) { return v + cosine * cross(omega, v) + twice * cross(omega, cross(omega, v)); };
    RotatedEdge<T> to{rotate(edge), frame + frame_change};
    if constexpr (dofs == 4) {
        const auto reference = [&](Vec<T> tangent) { return transport(row.reference.normal, row.reference.tangent, tangent); };
        const Vec<T> before = reference(t), tangent = rotate(t), after = reference(tangent);
        const SineCosine<T> turn = sine_cosine(frame / row.rest_length);
        const Vec<T> director = rotate(turn.cosine * before + turn.sine * cross(t, before));
        const T rotated = atan2(dot(cross(tangent, after), director), dot(after, director));
        const T correction = row.rest_length * wrap(rotated + (1.0 - share) * about - to.frame / row.rest_length);
        to.frame += select((cosine == 1.0) | (row.frame_free == 0.0), T{}, correction);
    }
    return to;
}

// The point `to` of the path from x at the fraction `step` of a direction; x + step · direction to first order.
// Edges rotate. Their lengths change by the direction's first-order change alone, and the vertices behind shift with their
// ends.
template <int dofs, class Row, class T>
void curved_path(int vertices, const Row *rows, const T *x, T step, const T *direction, T *to) {
    Vec<T> last{}, shift{}; // the vertex before on its straight path; of the vertices behind, from theirs
    T length{};             // at rest, since the last held vertex
    for (int i = 0; i < vertices; ++i) {
        const Vec<T> straight = position<dofs>(x, i) + step * position<dofs>(direction, i);
        for (int k = 3; k < dofs; ++k) to[dofs * i + k] = x[dofs * i + k] + step * direction[dofs * i + k];
        if (i > 0) {
            const int frame = dofs * i - 1; // γ l̄ of the edge, where there is one
            const Vec<T> edge = position<dofs>(x, i) - position<dofs>(x, i - 1), change = (straight - last) - edge;
            const T now = norm(edge);
            const auto point = now < strand_settings::zero_length;
            const T divisor = select(point, constant<T>(1.0), now);
            const T ratio = max((now + dot(edge, change) / divisor) / divisor, constant<T>(strand_settings::min_edge_ratio));
            const RotatedEdge<T> rotated = rotate_edge<dofs>(rows[i - 1], rotation_share(rows, i - 1), edge, divisor, change,
                                                             x[frame], to[frame] - x[frame]);
            shift = shift + select<T>(point, Vec<T>{}, ratio * rotated.edge - (edge + change));
            if constexpr (dofs == 4) to[frame] = select(point, to[frame], rotated.frame);
            length += rows[i - 1].rest_length;
        }
        last = straight;
        put(to + dofs * i, straight + shift);
        const auto held = rows[i].free == 0.0;
        if (any(held)) {
            close_path<dofs>(rows, i, held, length, shift, to);
            put(to + dofs * i, select<T>(held, straight, straight + shift));
            shift = select<T>(held, Vec<T>{}, shift);
            length = select(held, T{}, length);
        }
    }
}

} // namespace ringlet::RINGLET_SIMD
