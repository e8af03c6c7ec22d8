// Curved path of a strand along a search direction: edges rotate where straight paths of their ends would stretch them.
// On straight paths an edge that rotates by φ gets longer by ½ φ². As stretch is stiff, a line search would leave next to
// nothing of a direction that rotates edges.
#pragma once

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
template <int dofs, class T>
void close_path(const StrandRow<T> *rows, int held_at, const MaskOf<T> &held, T length, Vec<T> miss, T *to) {
    if (held_at == 0) return;
    T open = select(held & (rows[held_at - 1].stretch_stiffness > 0.0), length, T{}); // behind the tip nothing is missed
    const Vec<T> correction = (1.0 / select(open > 0.0, open, constant<T>(1.0))) * miss;
    for (int i = held_at - 1; i >= 0 && any(open > 0.0); --i) {
        open = select(rows[i].free > 0.0, max(open - rows[i].rest_length, T{}), T{});
        put(to + dofs * i, position<dofs>(to, i) - open * correction);
    }
}

// The point `to` of the path from x at the fraction `step` of a direction; x + step · direction to first order.
// An edge points where its ends lead it on straight paths. Its length changes by the direction's first-order change alone,
// and the vertices behind shift with its end.
template <int dofs, class T>
void curved_path(int vertices, const StrandRow<T> *rows, const T *x, T step, const T *direction, T *to) {
    Vec<T> last{}, shift{}; // the vertex before on its straight path; of the vertices behind, from theirs
    T length{};             // at rest, since the last held vertex
    for (int i = 0; i < vertices; ++i) {
        const Vec<T> straight = position<dofs>(x, i) + step * position<dofs>(direction, i);
        if (i > 0) {
            const Vec<T> edge = position<dofs>(x, i) - position<dofs>(x, i - 1), rotated = straight - last;
            const T now = norm(edge), then = norm(rotated);
            const auto point = (now < strand_settings::zero_length) | (then < strand_settings::zero_length);
            const T wanted = max(now + dot(edge, rotated - edge) / select(point, constant<T>(1.0), now),
                                 strand_settings::min_edge_ratio * now);
            shift = shift + (select(point, constant<T>(1.0), wanted / select(point, constant<T>(1.0), then)) - 1.0) * rotated;
            length += rows[i - 1].rest_length;
        }
        last = straight;
        put(to + dofs * i, straight + shift);
        for (int k = 3; k < dofs; ++k) to[dofs * i + k] = x[dofs * i + k] + step * direction[dofs * i + k];
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
