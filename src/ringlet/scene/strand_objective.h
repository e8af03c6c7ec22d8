// What a time step of a strand minimises: Σ ½ aᵢ ‖xᵢ − yᵢ‖² (inertia, gravity, mass damping, drag) + stretch + bend + twist,
// with the vertices that are held left out. Damping of strains needs no term of its own: with b = β/dt, ½ k (θ − θ̄)² + ½ b k (θ
// − θₙ)² = ½ k (1 + b) (θ − (θ̄ + b θₙ)/(1 + b))² + constant.
#pragma once

#include "ringlet/energy/strand/bend.h"
#include "ringlet/energy/strand/stretch.h"
#include "ringlet/energy/strand/twist.h"
#include "ringlet/linear/banded.h"
#include "ringlet/scene/continuation_history.h"
#include "ringlet/scene/continuation_least_energy.h"
#include "ringlet/scene/strand_arrays.h"

namespace ringlet::RINGLET_SIMD {

template <class T> class StrandObjective {
public:
    StrandObjective(Continuation continuation, int vertices, StrandRow<T> *rows, StrandShape<T> *shapes)
        : continuation_(continuation), vertices_(vertices), rows_(rows), shapes_(shapes) {}

    T evaluate(const Vec<T> *x) {
        positions_ = x;
        measure(x);
        if (continuation_ == Continuation::history)
            continue_history(vertices_, rows_, shapes_);
        else
            continue_least_energy(vertices_, rows_, shapes_);

        T energy{};
        for (int i = 0; i < vertices_; ++i) {
            const Vec<T> away = x[i] - rows_[i].inertial;
            energy += 0.5 * rows_[i].free * rows_[i].inertia * dot(away, away);
        }
        for (int i = 0; i + 1 < vertices_; ++i)
            energy += stretch_energy(shapes_[i].length, rows_[i].damped_length, rows_[i].stretch);
        for (int i = 1; i + 1 < vertices_; ++i)
            energy += bend_energy(shapes_[i].corner.angle, shapes_[i].sigma, rows_[i].damped_angle, rows_[i].bend);
        for (int i = 1; i + 2 < vertices_; ++i)
            energy += twist_energy(shapes_[i].strain - rows_[i].damped_strain, rows_[i].twist);
        return energy;
    }

    void assemble(Vec<T> *gradient, Banded<T> &hessian) {
        hessian.set_zero();
        for (int i = 0; i < vertices_; ++i) {
            const StrandRow<T> &r = rows_[i];
            gradient[i] = r.inertia * (positions_[i] - r.inertial);
            hessian.add_diagonal(i, r.free * r.inertia + (1.0 - r.free));
        }
        for (int i = 0; i + 1 < vertices_; ++i) add_stretch(i, gradient, hessian);
        for (int i = 1; i + 1 < vertices_; ++i) add_bend(i, gradient, hessian);
        for (int i = 1; i + 2 < vertices_; ++i) add_twist(i, gradient, hessian);
        for (int i = 0; i < vertices_; ++i) gradient[i] = rows_[i].free * gradient[i];
    }

private:
    void measure(const Vec<T> *x) {
        for (int i = 0; i + 1 < vertices_; ++i) {
            // An edge that has shrunk to a point is given some direction and a length that can be divided by.
            const Vec<T> edge = x[i + 1] - x[i], some{constant<T>(1.0), T{}, T{}};
            const T length = norm(edge), least = 1e-6 * rows_[i].rest_length;
            const auto point = length < least;
            shapes_[i].length = select(point, least, length);
            shapes_[i].tangent = select<T>(point, some, (1.0 / shapes_[i].length) * edge);
        }
        for (int i = 1; i + 1 < vertices_; ++i) shapes_[i].corner = corner(shapes_[i - 1].tangent, shapes_[i].tangent);
        for (int i = 1; i + 2 < vertices_; ++i)
            shapes_[i].phi = dihedral(shapes_[i].corner, shapes_[i + 1].corner, shapes_[i + 1].tangent);
    }

    void add_stretch(int i, Vec<T> *gradient, Banded<T> &hessian) {
        const StrandShape<T> &s = shapes_[i];
        const Stretch<T> e = stretch(s.tangent, s.length, rows_[i].damped_length, rows_[i].stretch);
        gradient[i] = gradient[i] - e.gradient;
        gradient[i + 1] = gradient[i + 1] + e.gradient;
        const T free0 = rows_[i].free, free1 = rows_[i + 1].free;
        const Vec<T> along[2] = {-(free0 * s.tangent), free1 * s.tangent};
        hessian.add_square(i, e.along - e.across, along);
        hessian.add_diagonal(i, e.across * free0);
        hessian.add_diagonal(i + 1, e.across * free1);
        hessian.add_coupling(i, -e.across * free0 * free1);
    }

    void add_bend(int i, Vec<T> *gradient, Banded<T> &hessian) {
        const StrandShape<T> &before = shapes_[i - 1], &s = shapes_[i];
        const Bend<T> e =
            bend(s.corner, before.tangent, s.tangent, before.length, s.length, s.sigma, rows_[i].damped_angle, rows_[i].bend);
        gradient[i - 1] = gradient[i - 1] - e.gradient0;
        gradient[i] = gradient[i] + (e.gradient0 - e.gradient1);
        gradient[i + 1] = gradient[i + 1] + e.gradient1;
        for (const EdgeTerm<T> &term : e.terms) {
            const Vec<T> u[3] = {-(rows_[i - 1].free * term.first), rows_[i].free * (term.first - term.second),
                                 rows_[i + 1].free * term.second};
            hessian.add_square(i - 1, term.coefficient, u);
        }
    }

    // ½ k r² with the Hessian k ∇r∇rᵀ; r depends on the dihedral and, where it fades, on the two corners' angles.
    void add_twist(int i, Vec<T> *gradient, Banded<T> &hessian) {
        const StrandShape<T> &before = shapes_[i - 1], &s = shapes_[i], &after = shapes_[i + 1];
        const DihedralGradient<T> phi = dihedral_gradient(s.corner, after.corner, before.length, s.length, after.length);
        Vec<T> slope[4];
        for (int k = 0; k < 4; ++k) slope[k] = s.by_dihedral * phi.at[k];
        add_angle_gradient(slope, s.by_angle, s.corner, before, s);
        add_angle_gradient(slope + 1, s.by_next, after.corner, s, after);
        const T moment = rows_[i].twist * (s.strain - rows_[i].damped_strain);
        Vec<T> u[4];
        for (int k = 0; k < 4; ++k) {
            gradient[i - 1 + k] = gradient[i - 1 + k] + moment * slope[k];
            u[k] = rows_[i - 1 + k].free * slope[k];
        }
        hessian.add_square(i - 1, rows_[i].twist, u);
    }

    // Adds weight · ∂θ/∂x of the corner between two edges, at its three vertices.
    static void add_angle_gradient(Vec<T> *slope, T weight, const Corner<T> &corner, const StrandShape<T> &first,
                                   const StrandShape<T> &second) {
        const Vec<T> g0 = (-weight / first.length) * cross(corner.normal, first.tangent);
        const Vec<T> g1 = (weight / second.length) * cross(corner.normal, second.tangent);
        slope[0] = slope[0] - g0;
        slope[1] = slope[1] + (g0 - g1);
        slope[2] = slope[2] + g1;
    }

    Continuation continuation_;
    int vertices_;
    StrandRow<T> *rows_;
    StrandShape<T> *shapes_;
    const Vec<T> *positions_ = nullptr;
};

} // namespace ringlet::RINGLET_SIMD
