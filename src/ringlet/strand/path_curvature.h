// What Gauss–Newton leaves out of the second derivative of a strand's energy along its curved paths (curved_path.h), on which
// edges and their frames rotate by s ω to second order:
//   at a corner  P · (ω_a × ω_b)        P: the moment of bend and twist on the edge a before it
//   of an edge   l F · (ω × (ω × t))    F: the gradient of inertia, gravity and drag by all vertices behind it
// The first follows from exp(−s ω_b) exp(s ω_a) = exp(s (ω_a − ω_b) − ½ s² ω_b × ω_a + …), the second from that derivative of
// exp(s ω) t. Left out are a moment times the square of a change of strain, which is small whatever the rotation, and the
// forces of contacts, which cancel where neighbours rotate together. (Geometric stiffness of rods: Simo & Vu-Quoc 1986.)
#pragma once

#include "ringlet/energy/strand/frame.h"
#include "ringlet/energy/strand/stretch.h"
#include "ringlet/strand/curved_path.h"
#include "ringlet/strand/vertex_data.h"

namespace ringlet::RINGLET_SIMD {

template <class T, class Matrix> class PathCurvature {
public:
    // Of what was evaluated at x.
    PathCurvature(int vertices, const StrandRow<T> *rows, const StrandShape<T> *shapes, const T *x)
        : vertices_(vertices), rows_(rows), shapes_(shapes), x_(x) {}

    // Adds the terms, times `weight`, of edges whose vertices behind are all free: between held vertices paths are closed
    // otherwise.
    void add_to(Matrix &hessian, T weight) const {
        Vec<T> load{};
        EdgeSpin after{};
        for (int i = vertices_ - 2; i >= 0; --i) {
            const T free = rows_[i + 1].free;
            const auto closed = (free == 0.0) & (rows_[i].stretch_stiffness > 0.0); // behind the tip nothing is
            weight = select(closed, T{}, weight);
            load = free * (load + load_of(i + 1));
            const EdgeSpin spin = spin_of(i);
            add_edge(i, spin, weight, load, hessian);
            if (i + 2 < vertices_) add_corner(i + 1, spin, after, weight, hessian);
            after = spin;
        }
    }

private:
    // ω by the edge (its columns) and by γ l̄; `about` and `about_by_frame` are those of its component along the edge.
    struct EdgeSpin {
        Vec<T> by_edge[3], by_frame, about;
        T about_by_frame;
    };

    EdgeSpin spin_of(int i) const {
        const StrandShape<T> &s = shapes_[i];
        EdgeSpin r;
        const T share = rows_[i].frame_free * rotation_share(rows_, i);
        r.about = share * spin(rows_[i].reference.tangent, s.tangent, s.length);
        r.about_by_frame = share / rows_[i].rest_length;
        r.by_frame = r.about_by_frame * s.tangent;
        const Vec<T> t = (1.0 / s.length) * s.tangent;
        r.by_edge[0] = r.about.x * s.tangent + Vec<T>{T{}, t.z, -t.y}; // t × the x axis
        r.by_edge[1] = r.about.y * s.tangent + Vec<T>{-t.z, T{}, t.x};
        r.by_edge[2] = r.about.z * s.tangent + Vec<T>{t.y, -t.x, T{}};
        return r;
    }

    Vec<T> load_of(int i) const {
        const Vec<T> at{x_[4 * i], x_[4 * i + 1], x_[4 * i + 2]};
        return rows_[i].inertia * (at - rows_[i].inertia_target);
    }

    // Across the edge the tension of its load takes the place of that of its stretch where it is larger. An edge that the
    // limiter has left stretched so keeps that stiffness, without which the next iteration stretches it further.
    void add_edge(int i, const EdgeSpin &spin, T weight, Vec<T> load, Matrix &hessian) const {
        const StrandShape<T> &s = shapes_[i];
        const T stretch = stretch_across(s.length, rows_[i].damped_length, rows_[i].stretch_stiffness);
        const T across = weight * max(-dot(load, s.tangent) / s.length - stretch, T{});
        const Vec<T> twisting = (0.5 * weight) * cross(load, s.tangent), t = s.tangent;
        const T a = rows_[i].free, b = rows_[i + 1].free;
        for (int c = 0; c < 3; ++c) {
            T *before = hessian.entry(4 * i + c), *after = hessian.entry(4 * i + 4 + c);
            for (int r = 0; r < 3; ++r) {
                T value = spin.about[r] * twisting[c] + twisting[r] * spin.about[c] - across * t[r] * t[c];
                if (r == c) value += across;
                if (r >= c) before[r - c] += a * value, after[r - c] += b * value;
                before[4 + r - c] -= a * b * value;
            }
            before[3 - c] -= a * spin.about_by_frame * twisting[c];
            hessian.entry(4 * i + 3)[1 + c] += b * spin.about_by_frame * twisting[c];
        }
    }

    // Moment of bend at corner i, and of twist across it, on the edge before [N m].
    Vec<T> moment(int i) const {
        const StrandShape<T> &before = shapes_[i - 1], &s = shapes_[i];
        const StrandRow<T> &row = rows_[i];
        const Vec<T> bending = (row.bend_stiffness * (s.curvature1 - row.damped_curvature1)) * s.director +
                               (row.bend_stiffness * (s.curvature2 - row.damped_curvature2)) * cross(s.tangent, s.director);
        Vec<T> by_edge = turning_gradient(s.corner, before.tangent, s.tangent, before.length, s.length, bending).first;
        T twisting{};
        if (i > 1) {
            twisting = rows_[i - 1].twist_stiffness * (before.strain - rows_[i - 1].damped_strain);
            const auto g = frame_twist_gradient(s.corner, before.tangent, s.tangent, before.length, s.length);
            by_edge = by_edge + twisting * g.first;
        }
        return before.length * cross(before.tangent, by_edge) - twisting * before.tangent;
    }

    void add_corner(int i, const EdgeSpin &first, const EdgeSpin &second, T weight, Matrix &hessian) const {
        const Vec<T> half = (0.5 * weight) * moment(i), by_frame = cross(half, first.by_frame);
        T by_edges[3][3]; // rows: the first
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) by_edges[r][c] = dot(cross(half, first.by_edge[r]), second.by_edge[c]);
        const T a = rows_[i - 1].free, b = rows_[i].free, d = rows_[i + 1].free;
        T *frame = hessian.entry(4 * (i - 1) + 3);
        for (int c = 0; c < 3; ++c) {
            T *column0 = hessian.entry(4 * (i - 1) + c), *column1 = hessian.entry(4 * i + c);
            for (int r = 0; r < 3; ++r) {
                column0[4 + r - c] += a * b * by_edges[c][r];
                column0[8 + r - c] -= a * d * by_edges[c][r];
                if (r >= c) column1[r - c] -= b * (by_edges[r][c] + by_edges[c][r]);
                column1[4 + r - c] += b * d * by_edges[c][r];
            }
            const T of_first = dot(cross(half, first.by_edge[c]), second.by_frame),
                    of_second = dot(by_frame, second.by_edge[c]);
            column0[7 - c] -= a * of_first;
            column1[3 - c] += b * of_first;
            frame[1 + c] -= b * of_second;
            frame[5 + c] += d * of_second;
        }
        frame[4] += dot(by_frame, second.by_frame);
    }

    int vertices_;
    const StrandRow<T> *rows_;
    const StrandShape<T> *shapes_;
    const T *x_;
};

} // namespace ringlet::RINGLET_SIMD
