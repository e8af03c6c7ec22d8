// Curved path of a strand along a search direction: edges rotate where straight paths of their ends would stretch them.
// On straight paths an edge that rotates by φ gets longer by ½ φ². As stretch is stiff, a line search would leave next to
// nothing of a direction that rotates edges.
#pragma once

#include "ringlet/energy/strand/frame.h"
#include "ringlet/energy/strand/stretch.h"
#include "ringlet/math/unroll.h"
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

// What Gauss–Newton leaves out of the second derivative of a strand's energy along its curved paths (curved_path.h), on which
// edges and their frames rotate by s ω to second order:
//   at a corner  P · (ω_a × ω_b)        P: the moment of bend and twist on the edge a before it
//   of an edge   l F · (ω × (ω × t))    F: the gradient of inertia, gravity and drag by all vertices behind it
// The first follows from exp(−s ω_b) exp(s ω_a) = exp(s (ω_a − ω_b) − ½ s² ω_b × ω_a + …), the second from that derivative of
// exp(s ω) t. Left out are a moment times the square of a change of strain, which is small whatever the rotation, and the
// forces of contacts, which cancel where neighbours rotate together. (Geometric stiffness of rods: Simo & Vu-Quoc 1986.)

// What vertices behind an edge add up to: F, and how many of them are held.
template <class T> struct LoadBehind {
    Vec<T> force{};
    T held{};

    template <class Row> void add(const Row *rows, const T *x, int i, double sign) {
        const Vec<T> at = position<4>(x, i);
        force = force + (sign * rows[i].free * rows[i].inertia) * (at - rows[i].inertia_target);
        if constexpr (has_plane<Row>) force = force + (sign * rows[i].free) * plane_gradient(rows[i].plane, at);
        if (i == 0) return;
        const auto is_held = (rows[i].free == 0.0) & (rows[i - 1].stretch_stiffness > 0.0); // behind the tip nothing is
        held += select(is_held, constant<T>(sign), T{});
    }
};

// Takes edges and corners in order, from the root to the tip.
template <class T, class Row> class PathCurvature {
public:
    // Of what was evaluated at x; `load`: of all vertices.
    PathCurvature(const Row *rows, const RodShape<T> *shapes, const T *x, const LoadBehind<T> &load)
        : rows_(rows), shapes_(shapes), x_(x), load_(load) {}

    // Calls add(column, rows below, value) for edge i, whose director has that spin, and for the corner before it, which has
    // that moment. Only where all vertices behind are free: between held vertices paths are closed otherwise.
    template <class Add> void add(int i, Vec<T> director_spin, Vec<T> moment, T weight, const Add &add) {
        load_.add(rows_, x_, i, -1.0);
        weight = select(load_.held > 0.5, T{}, weight);
        const EdgeSpin spin = spin_of(i, director_spin);
        add_edge(i, spin, weight, add);
        if (i > 0) add_corner(i, before_, spin, weight_before_ * moment, add);
        before_ = spin;
        weight_before_ = weight;
    }

private:
    // ω by the edge (its columns) and by γ l̄; `about` and `about_by_frame` are those of its component along the edge.
    struct EdgeSpin {
        Vec<T> by_edge[3], by_frame, about;
        T about_by_frame;
    };

    EdgeSpin spin_of(int i, Vec<T> director_spin) const {
        const RodShape<T> &s = shapes_[i];
        EdgeSpin r;
        const T share = rows_[i].frame_free * rotation_share(rows_, i);
        r.about = share * director_spin;
        r.about_by_frame = share / rows_[i].rest_length;
        r.by_frame = r.about_by_frame * s.tangent;
        const Vec<T> t = (1.0 / s.length) * s.tangent;
        r.by_edge[0] = r.about.x * s.tangent + Vec<T>{T{}, t.z, -t.y}; // t × the x axis
        r.by_edge[1] = r.about.y * s.tangent + Vec<T>{-t.z, T{}, t.x};
        r.by_edge[2] = r.about.z * s.tangent + Vec<T>{t.y, -t.x, T{}};
        return r;
    }

    // Across the edge the tension of its load takes the place of that of its stretch where it is larger. An edge that the
    // limiter has left stretched so keeps that stiffness, without which the next iteration stretches it further.
    template <class Add> void add_edge(int i, const EdgeSpin &spin, T weight, const Add &add) const {
        const RodShape<T> &s = shapes_[i];
        const Vec<T> load = load_.force;
        const T stretch = stretch_across(s.length, rows_[i].damped_length, rows_[i].stretch_stiffness);
        const T across = weight * max(-dot(load, s.tangent) / s.length - stretch, T{});
        const Vec<T> twisting = (0.5 * weight) * cross(load, s.tangent), t = s.tangent;
        const T a = rows_[i].free, b = rows_[i + 1].free;
        unroll<0, 3>([&](auto c) {
            const int before = 4 * i + c, after = before + 4;
            unroll<0, 3>([&](auto r) {
                T value = spin.about[r] * twisting[c] + twisting[r] * spin.about[c] - across * t[r] * t[c];
                if (r == c) value += across;
                if (r >= c) {
                    add(before, r - c, a * value);
                    add(after, r - c, b * value);
                }
                add(before, 4 + r - c, -(a * b * value));
            });
            add(before, 3 - c, -(a * spin.about_by_frame * twisting[c]));
            add(4 * i + 3, 1 + c, b * spin.about_by_frame * twisting[c]);
        });
    }

    template <class Add>
    void add_corner(int i, const EdgeSpin &first, const EdgeSpin &second, Vec<T> moment, const Add &add) const {
        const Vec<T> half = constant<T>(0.5) * moment, by_frame = cross(half, first.by_frame);
        T by_edges[3][3]; // rows: the first
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) by_edges[r][c] = dot(cross(half, first.by_edge[r]), second.by_edge[c]);
        const T a = rows_[i - 1].free, b = rows_[i].free, d = rows_[i + 1].free;
        const int frame = 4 * i - 1;
        unroll<0, 3>([&](auto c) {
            const int column0 = 4 * (i - 1) + c, column1 = 4 * i + c;
            unroll<0, 3>([&](auto r) {
                add(column0, 4 + r - c, a * b * by_edges[c][r]);
                add(column0, 8 + r - c, -(a * d * by_edges[c][r]));
                if (r >= c) add(column1, r - c, -(b * (by_edges[r][c] + by_edges[c][r])));
                add(column1, 4 + r - c, b * d * by_edges[c][r]);
            });
            const T of_first = dot(cross(half, first.by_edge[c]), second.by_frame),
                    of_second = dot(by_frame, second.by_edge[c]);
            add(column0, 7 - c, -(a * of_first));
            add(column1, 3 - c, b * of_first);
            add(frame, 1 + c, -(b * of_second));
            add(frame, 5 + c, d * of_second);
        });
        add(frame, 4, dot(by_frame, second.by_frame));
    }

    const Row *rows_;
    const RodShape<T> *shapes_;
    const T *x_;
    LoadBehind<T> load_; // of the present edge
    EdgeSpin before_{};  // of the edge before
    T weight_before_{};
};

} // namespace ringlet::RINGLET_SIMD
