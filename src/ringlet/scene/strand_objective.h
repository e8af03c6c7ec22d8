// What a time step of a strand minimises: Σ ½ aᵢ ‖xᵢ − yᵢ‖² (inertia, gravity, mass damping, drag) + stretch + bend + twist, with the
// vertices that are held left out. Damping of strains needs no term of its own: with b = β/dt,
// ½ k (θ − θ̄)² + ½ b k (θ − θₙ)² = ½ k (1 + b) (θ − (θ̄ + b θₙ)/(1 + b))² + constant.
#pragma once

#include "ringlet/energy/strand/bend.h"
#include "ringlet/energy/strand/stretch.h"
#include "ringlet/energy/strand/twist.h"
#include "ringlet/linear/banded.h"
#include "ringlet/scene/strand_continuation.h"

namespace ringlet::RINGLET_SIMD {

// Fixed during a step: one row per vertex; an edge's values stand in the row of the vertex where it begins.
template <class T> struct StrandRow {
    T free;           // 1, or 0 where the vertex is held
    T inertia;        // a [kg/s²]
    Vec<T> inertial;  // y [m]
    T stretch, rest_length;
    T bend, rest_angle;
    T twist, rest_twist, rest_dihedral;
    T fade;           // of the twist, 0 … 1
    Reference<T> reference;
    T start_sigma, start_turns; // as the step begins, for the report
};

// At the positions evaluated last.
template <class T> struct StrandShape {
    Vec<T> tangent; // of the edge that begins here
    T length;
    Corner<T> corner;
    T sigma; // sign of the corner's bend
    T delta; // Δφ of the edge, with its turns
    T turns; // how many of them
};

template <class T> class StrandObjective {
  public:
    StrandObjective(int vertices, StrandRow<T> *rows, StrandShape<T> *shapes)
        : vertices_(vertices), rows_(rows), shapes_(shapes) {}

    StrandRow<T> &row(int vertex) { return rows_[vertex]; }
    const StrandShape<T> &shape(int vertex) const { return shapes_[vertex]; }
    int vertices() const { return vertices_; }

    T evaluate(const Vec<T> *x) {
        positions_ = x;
        T energy{};
        for (int i = 0; i < vertices_; ++i) {
            const Vec<T> away = x[i] - rows_[i].inertial;
            energy += 0.5 * rows_[i].free * rows_[i].inertia * dot(away, away);
        }
        for (int i = 0; i + 1 < vertices_; ++i) {
            const Vec<T> edge = x[i + 1] - x[i];
            shapes_[i].length = max(norm(edge), constant<T>(1e-30));
            shapes_[i].tangent = (1.0 / shapes_[i].length) * edge;
            energy += stretch_energy(shapes_[i].length, rows_[i].rest_length, rows_[i].stretch);
        }
        for (int i = 1; i + 1 < vertices_; ++i) {
            StrandShape<T> &s = shapes_[i];
            s.corner = corner(shapes_[i - 1].tangent, s.tangent);
            s.sigma = carried_sign(rows_[i].reference, s.tangent, s.corner.normal);
            energy += bend_energy(s.corner.angle, s.sigma, rows_[i].rest_angle, rows_[i].bend);
        }
        for (int i = 1; i + 2 < vertices_; ++i) {
            StrandShape<T> &s = shapes_[i];
            const T phi = dihedral(s.corner, shapes_[i + 1].corner, shapes_[i + 1].tangent);
            const T unsigned_delta = phi - rows_[i].rest_dihedral;
            s.delta = carried_turns(rows_[i].reference, unsigned_delta, s.sigma * shapes_[i + 1].sigma);
            s.turns = round((s.delta - unsigned_delta) * (0.5 / pi));
            energy += twist_energy(rows_[i].fade * (s.delta - rows_[i].rest_twist), rows_[i].twist);
        }
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
    void add_stretch(int i, Vec<T> *gradient, Banded<T> &hessian) {
        const StrandShape<T> &s = shapes_[i];
        const Stretch<T> e = stretch(s.tangent, s.length, rows_[i].rest_length, rows_[i].stretch);
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
        const Bend<T> e = bend(s.corner, before.tangent, s.tangent, before.length, s.length, s.sigma, rows_[i].rest_angle, rows_[i].bend);
        gradient[i - 1] = gradient[i - 1] - e.gradient0;
        gradient[i] = gradient[i] + (e.gradient0 - e.gradient1);
        gradient[i + 1] = gradient[i + 1] + e.gradient1;
        for (const EdgeTerm<T> &term : e.terms) {
            const Vec<T> u[3] = {-(rows_[i - 1].free * term.first), rows_[i].free * (term.first - term.second),
                                 rows_[i + 1].free * term.second};
            hessian.add_square(i - 1, term.coefficient, u);
        }
    }

    void add_twist(int i, Vec<T> *gradient, Banded<T> &hessian) {
        const StrandShape<T> &before = shapes_[i - 1], &s = shapes_[i], &after = shapes_[i + 1];
        const DihedralGradient<T> g = dihedral_gradient(s.corner, after.corner, before.length, s.length, after.length);
        const T stiffness = rows_[i].twist * rows_[i].fade * rows_[i].fade;
        const T moment = stiffness * (s.delta - rows_[i].rest_twist);
        Vec<T> u[4];
        for (int k = 0; k < 4; ++k) {
            gradient[i - 1 + k] = gradient[i - 1 + k] + moment * g.at[k];
            u[k] = rows_[i - 1 + k].free * g.at[k];
        }
        hessian.add_square(i - 1, stiffness, u);
    }

    int vertices_;
    StrandRow<T> *rows_;
    StrandShape<T> *shapes_;
    const Vec<T> *positions_ = nullptr;
};

} // namespace ringlet::RINGLET_SIMD
