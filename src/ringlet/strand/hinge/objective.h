// Hinge model of a strand: bend and twist of positions alone (Lifted Curls).
// Bend is the turning angle at a vertex. Twist is a cloth hinge over the two virtual triangles at each edge. A continuation
// determines signs and turns.
#pragma once

#include "ringlet/energy/strand/twist.h"
#include "ringlet/strand/hinge/continuation.h"
#include "ringlet/strand/objective.h"

namespace ringlet::RINGLET_SIMD {

template <class T, bool history> class HingeObjective : public StrandObjective<T, 3, 12, HingeRow<T>, HingeShape<T>> {
    using Base = StrandObjective<T, 3, 12, HingeRow<T>, HingeShape<T>>;
    using Base::rows_, Base::shapes_, Base::vertices_;

public:
    using typename Base::Matrix;

    HingeObjective(int vertices, HingeRow<T> *rows, HingeShape<T> *shapes, Safeguards safeguards = {})
        : Base(vertices, rows, shapes), safeguards_(safeguards) {}

    // Evaluates at the start of the step and keeps its signs, turns and fades.
    T begin(const T *x) {
        const T energy = evaluate(x);
        for (int i = 1; i + 1 < vertices_; ++i) {
            HingeRow<T> &row = rows_[i];
            row.start_sigma = shapes_[i].sigma;
            row.start_turns = shapes_[i].turns;
            if (!this->is_hinge(i) || !history) continue;
            row.fade = constant<T>(1.0);
            if (safeguards_.straight_fade)
                row.fade = straightness_fade(shapes_[i].corner.angle) * straightness_fade(shapes_[i + 1].corner.angle);
        }
        return history ? evaluate(x) : energy; // now with the fades
    }

    T evaluate(const T *x) {
        this->positions_ = x;
        for (int i = 0; i + 1 < vertices_; ++i) this->measure_edge(x, i, shapes_[i]);
        for (int i = 1; i + 1 < vertices_; ++i) shapes_[i].corner = corner(shapes_[i - 1].tangent, shapes_[i].tangent);
        for (int i = 1; i + 2 < vertices_; ++i)
            shapes_[i].phi = dihedral(shapes_[i].corner, shapes_[i + 1].corner, shapes_[i + 1].tangent);
        if constexpr (history)
            continue_history(vertices_, rows_, shapes_, safeguards_);
        else
            continue_least_energy(vertices_, rows_, shapes_);

        T energy{};
        for (int i = 0; i < vertices_; ++i) energy += this->vertex_energy(x, i);
        for (int i = 0; i + 1 < vertices_; ++i) energy += this->edge_energy(i, shapes_[i]);
        for (int i = 1; i + 1 < vertices_; ++i)
            energy += bend_energy(shapes_[i].corner.angle, shapes_[i].sigma, rows_[i].damped_angle, rows_[i].bend_stiffness);
        for (int i = 1; i + 2 < vertices_; ++i)
            energy += twist_energy(shapes_[i].strain - rows_[i].damped_strain, rows_[i].twist_stiffness);
        return energy;
    }

    T energy(const T *x) { return evaluate(x); }

    void assemble(T *gradient, Matrix &hessian, T &) const { assemble(gradient, hessian); }
    void assemble(T *gradient, Matrix &hessian) const {
        this->assemble_terms(
            gradient, hessian,
            [&](int last) {
                if (last > 1) add_bend(last - 1, gradient, hessian);
                if (last > 2) add_twist(last - 2, gradient, hessian);
            },
            [](int) {});
    }

    Strains<T> strains(int i) const {
        const HingeShape<T> &s = shapes_[i];
        return {{s.length, s.sigma * s.corner.angle, T{}, s.strain}};
    }

    // Rest values with damping (time_discretisation.h), b = β/h.
    void damp(int i, T b, const Strains<T> &extrapolated) {
        const T share = 1.0 / (1.0 + b);
        rows_[i].damped_angle = share * (rows_[i].rest_angle + b * extrapolated[1]);
        if (this->is_hinge(i)) rows_[i].damped_strain = share * b * extrapolated.twist();
    }

    // Without damping, with the stiffnesses in the rows.
    T bend_energy_at(int i) const {
        return bend_energy(shapes_[i].corner.angle, shapes_[i].sigma, rows_[i].rest_angle, rows_[i].bend_stiffness);
    }
    T twist_energy_at(int i) const { return twist_energy(shapes_[i].strain, rows_[i].twist_stiffness); }

    // Normal that the next step compares with. A nearly straight corner has none of its own and transports its last one.
    Vec<T> reference_normal(int i) const {
        const HingeShape<T> &s = shapes_[i];
        const Vec<T> transported = transport(rows_[i].reference.normal, rows_[i].reference.tangent, s.tangent);
        return select<T>(s.corner.sine > hinge_settings::normal_sine, s.sigma * s.corner.normal, transported);
    }

    T sign_changes(int i) const { return select(shapes_[i].sigma == rows_[i].start_sigma, T{}, constant<T>(1.0)); }
    T winding_changes(int i) const { return select(shapes_[i].turns == rows_[i].start_turns, T{}, constant<T>(1.0)); }
    T too_straight(int i) const { return select(shapes_[i].by_dihedral == 0.0, constant<T>(1.0), T{}); }
    T clamped_eigenvalues(int i) const {
        T count = this->clamped_stretch(i);
        if (this->is_corner(i))
            count += clamped_bend(shapes_[i].corner, shapes_[i].sigma, rows_[i].damped_angle, rows_[i].bend_stiffness);
        return count;
    }

private:
    void add_bend(int i, T *gradient, Matrix &hessian) const {
        const HingeShape<T> &before = shapes_[i - 1], &s = shapes_[i];
        const Bend<T> e = bend(s.corner, before.tangent, s.tangent, before.length, s.length, s.sigma, rows_[i].damped_angle,
                               rows_[i].bend_stiffness);
        this->add(gradient, i - 1, -e.gradient0);
        this->add(gradient, i, e.gradient0 - e.gradient1);
        this->add(gradient, i + 1, e.gradient1);
        for (const EdgeTerm<T> &term : e.terms) {
            T u[9];
            put(u, -(rows_[i - 1].free * term.first));
            put(u + 3, rows_[i].free * (term.first - term.second));
            put(u + 6, rows_[i + 1].free * term.second);
            hessian.add_square(3 * (i - 1), term.coefficient, u);
        }
    }

    // ½ k r² with the Hessian k ∇r∇rᵀ; r depends on the dihedral and, where it fades, on the two corners' angles.
    void add_twist(int i, T *gradient, Matrix &hessian) const {
        const HingeShape<T> &before = shapes_[i - 1], &s = shapes_[i], &after = shapes_[i + 1];
        const DihedralGradient<T> phi = dihedral_gradient(s.corner, after.corner, before.length, s.length, after.length);
        Vec<T> slope[4];
        for (int k = 0; k < 4; ++k) slope[k] = s.by_dihedral * phi.at[k];
        if constexpr (!history) {
            add_angle_gradient(slope, s.by_angle, s.corner, before, s);
            add_angle_gradient(slope + 1, s.by_next, after.corner, s, after);
        }
        const T moment = rows_[i].twist_stiffness * (s.strain - rows_[i].damped_strain);
        T u[12];
        for (int k = 0; k < 4; ++k) {
            this->add(gradient, i - 1 + k, moment * slope[k]);
            put(u + 3 * k, rows_[i - 1 + k].free * slope[k]);
        }
        hessian.add_square(3 * (i - 1), rows_[i].twist_stiffness, u);
    }

    // Adds weight · ∂θ/∂x of the corner between two edges, at its three vertices.
    static void add_angle_gradient(Vec<T> *slope, T weight, const Corner<T> &corner, const HingeShape<T> &first,
                                   const HingeShape<T> &second) {
        const Vec<T> g0 = (-weight / first.length) * cross(corner.normal, first.tangent);
        const Vec<T> g1 = (weight / second.length) * cross(corner.normal, second.tangent);
        slope[0] = slope[0] - g0;
        slope[1] = slope[1] + (g0 - g1);
        slope[2] = slope[2] + g1;
    }

    Safeguards safeguards_;
};

} // namespace ringlet::RINGLET_SIMD
