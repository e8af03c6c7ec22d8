// Discrete elastic rod with material frames (Bergou et al. 2008, 2010): bend and twist of a strand.
// The director of every edge may rotate about the edge by an angle γ without inertia. At rest a director is the corner's
// normal; locked to the normals, this is the hinge model. Free, it is Kirchhoff's rod, without signs, turns or corners that are
// too straight.
#pragma once

#include "ringlet/energy/strand/frame.h"
#include "ringlet/strand/curved_path.h"
#include "ringlet/strand/objective.h"

namespace ringlet::RINGLET_SIMD {

// Degrees of freedom of a vertex: its position and γ l̄ of the edge that begins there [m]. γ is 0 as a step begins.
// In front of planes its rows are of the type PlaneRow.
template <class T, class RowOfRod = RodRow<T>> class RodObjective : public StrandObjective<T, 4, 11, RowOfRod, RodShape<T>> {
    using Base = StrandObjective<T, 4, 11, RowOfRod, RodShape<T>>;
    using Base::rows_, Base::shapes_, Base::vertices_;

public:
    using typename Base::Matrix;

    RodObjective(int vertices, RowOfRod *rows, RodShape<T> *shapes, Safeguards = {}) : Base(vertices, rows, shapes) {}

    static constexpr double curvature_reserve = 0.1;

    // Evaluates at the start of the step.
    T begin(const T *x) { return evaluate(x); }

    T evaluate(const T *x) {
        this->positions_ = x;
        return energy_at<true>(x);
    }

    // Leaves the shapes evaluated last as they are.
    T energy(const T *x) { return energy_at<false>(x); }

    void assemble(T *gradient, Matrix &hessian) const {
        AddedTerms terms;
        this->assemble_terms(
            gradient, hessian, [&](int last) { add_terms(last, gradient, hessian, terms); },
            [&](int i) { finish_frame(i, gradient, hessian); });
    }

    // The same, along curved paths in those lanes where that is 1. It becomes 0 where less than `curvature_reserve` of the
    // matrix without their curvature would be left in some direction: nearly singular matrices give directions that are long
    // and lead nowhere.
    void assemble(T *gradient, Matrix &hessian, T &curved) const {
        if (!any(curved > 0.0)) return assemble(gradient, hessian);
        DefinitenessTest<Matrix, T> test;
        assemble_along_paths(
            gradient, hessian, curved,
            [&](int column, int below, T value) {
                test.entry(column)[below] += curvature_reserve / (1.0 - curvature_reserve) * value;
            },
            [&](int i) { test.complete(hessian.entry(4 * i)); });
        const T kept = curved * test.definite();
        if (!any(kept != curved)) return;
        curved = kept; // a lane that passed needs no second test
        if (any(curved > 0.0))
            assemble_along_paths(gradient, hessian, curved, [](int, int, T) {}, [](int) {});
        else
            assemble(gradient, hessian);
    }

    // The same without that test: the matrix may be indefinite. Calls also(column, rows below, value) for what is added for
    // curved paths, and complete(i) once all of vertex i's columns are there.
    template <class Also, class Complete>
    void assemble_along_paths(T *gradient, Matrix &hessian, T curved, const Also &also, const Complete &complete) const {
        AddedTerms terms;
        PathCurvature<T, RowOfRod> curvature(rows_, shapes_, this->positions_, load_);
        const auto add = [&](int column, int below, T value) {
            hessian.entry(column)[below] += value;
            also(column, below, value);
        };
        this->assemble_terms(
            gradient, hessian,
            [&](int last) {
                add_terms(last, gradient, hessian, terms);
                if (last > 0)
                    curvature.add(last - 1, terms.spin, last > 1 ? terms.moment(shapes_[last - 2]) : Vec<T>{}, curved, add);
            },
            [&](int i) {
                finish_frame(i, gradient, hessian);
                complete(i);
            });
    }

    Strains<T> strains(int i) const {
        const RodShape<T> &s = shapes_[i];
        return {{s.length, s.curvature1, s.curvature2, s.strain}};
    }

    // Rest values with damping (time_discretisation.h), b = β/h.
    void damp(int i, T b, const Strains<T> &extrapolated) {
        const T share = b / (1.0 + b);
        rows_[i].damped_curvature1 = share * extrapolated[1];
        rows_[i].damped_curvature2 = share * extrapolated[2];
        if (this->is_hinge(i)) rows_[i].damped_strain = share * extrapolated.twist();
    }

    // Without damping, with the stiffnesses in the rows.
    T bend_energy_at(int i) const {
        return 0.5 * rows_[i].bend_stiffness *
               (shapes_[i].curvature1 * shapes_[i].curvature1 + shapes_[i].curvature2 * shapes_[i].curvature2);
    }
    T twist_energy_at(int i) const { return 0.5 * rows_[i].twist_stiffness * shapes_[i].strain * shapes_[i].strain; }

    Vec<T> reference_normal(int i) const { return shapes_[i].director; }
    T sign_changes(int) const { return T{}; }
    T winding_changes(int) const { return T{}; }
    T too_straight(int) const { return T{}; }
    T clamped_eigenvalues(int i) const { return this->clamped_stretch(i); } // bend and twist are sums of squares

private:
    // One pass, which reads each row once and writes shapes only where they are kept.
    template <bool keeps> T energy_at(const T *x) {
        T energy{};
        LoadBehind<T> load;
        RodShape<T> before{}, s{}; // of the edge before; of the edge that begins at i
        for (int i = 0; i < vertices_; ++i, before = s) {
            energy += this->vertex_energy(x, i);
            if (keeps) load.add(rows_, x, i, 1.0);
            if (i + 1 == vertices_) break;
            this->measure_edge(x, i, s);
            energy += this->edge_energy(i, s);
            if (i > 0) energy += corner_energy(x, i, before, s);
            if (i > 1) {
                before.strain =
                    wrap(frame_twist(before.director, before.tangent, s.director, s.tangent) - rows_[i - 1].rest_dihedral);
                const T w = before.strain - rows_[i - 1].damped_strain;
                energy += 0.5 * rows_[i - 1].twist_stiffness * w * w;
                if (keeps) shapes_[i - 1].strain = before.strain;
            }
            if (keeps) keep(s, shapes_[i]);
        }
        if (keeps) load_ = load;
        return energy;
    }

    // Always inlined, so that the same products are fused with sums (FMA) wherever it is called from.
    [[gnu::always_inline]] T corner_energy(const T *x, int i, const RodShape<T> &before, RodShape<T> &s) const {
        s.corner = corner(before.tangent, s.tangent);
        const Vec<T> director = transport(rows_[i].reference.normal, rows_[i].reference.tangent, s.tangent);
        const SineCosine<T> turn = sine_cosine(x[4 * i + 3] / rows_[i].rest_length);
        s.director = turn.cosine * director + turn.sine * cross(s.tangent, director);
        const Vec<T> K = turning(s.corner, before.tangent, s.tangent);
        s.curvature1 = dot(K, s.director) - rows_[i].rest_angle;
        s.curvature2 = dot(K, cross(s.tangent, s.director));
        const T strain1 = s.curvature1 - rows_[i].damped_curvature1, strain2 = s.curvature2 - rows_[i].damped_curvature2;
        return 0.5 * rows_[i].bend_stiffness * (strain1 * strain1 + strain2 * strain2);
    }

    static void keep(const RodShape<T> &s, RodShape<T> &kept) {
        kept.tangent = s.tangent, kept.length = s.length, kept.corner = s.corner;
        kept.director = s.director, kept.curvature1 = s.curvature1, kept.curvature2 = s.curvature2;
    }

    // What the terms of one corner leave for those of the next, and for the curvature of paths.
    struct AddedTerms {
        Vec<T> spin{}, spin_before{}; // of the directors of the edges at the corner (energy/strand/frame.h)
        Vec<T> bending{}, twisting{}; // gradient of bend, and of the twist across the corner, by the edge before it
        T moment_of_twist{};

        // Moment on the edge before the corner, of bend there and of twist across it [N m].
        Vec<T> moment(const RodShape<T> &before) const {
            return before.length * cross(before.tangent, bending + twisting) - moment_of_twist * before.tangent;
        }
    };

    // Of all terms of corners whose last vertex that is.
    void add_terms(int last, T *gradient, Matrix &hessian, AddedTerms &terms) const {
        if (last == 0) return;
        terms.spin_before = terms.spin;
        terms.spin = spin(rows_[last - 1].reference.tangent, shapes_[last - 1].tangent, shapes_[last - 1].length);
        if (last > 1) add_bend(last - 1, gradient, hessian, terms);
        if (last > 2) add_twist(last - 2, gradient, hessian, terms);
    }

    // Regularises a frame without stiffness, and holds those that are not free.
    void finish_frame(int i, T *gradient, Matrix &hessian) const {
        const T free = rows_[i].frame_free, bend = rows_[i].bend_stiffness / (rows_[i].rest_length * rows_[i].rest_length);
        const T least = max(strand_settings::frame_stiffness * bend, constant<T>(strand_settings::frame_stiffness_min));
        hessian.entry(4 * i + 3)[0] += free * least + (1.0 - free);
        gradient[4 * i + 3] *= free;
    }

    void add_bend(int i, T *gradient, Matrix &hessian, AddedTerms &terms) const {
        const RodShape<T> &before = shapes_[i - 1], &s = shapes_[i];
        const Vec<T> other = cross(s.tangent, s.director);
        const Vec<T> K = turning(s.corner, before.tangent, s.tangent);
        const T residual[2] = {s.curvature1 - rows_[i].damped_curvature1, s.curvature2 - rows_[i].damped_curvature2};
        const T by_frame[2] = {dot(K, other), -dot(K, s.director)};
        std::array<T, joint_dofs> by_dofs[2];
        terms.bending = Vec<T>{};
        for (int k = 0; k < 2; ++k) {
            const EdgeGradient<T> g =
                turning_gradient(s.corner, before.tangent, s.tangent, before.length, s.length, k == 0 ? s.director : other);
            terms.bending = terms.bending + (rows_[i].bend_stiffness * residual[k]) * g.first;
            by_dofs[k] =
                joint_gradient<T>({g.first, g.second + by_frame[k] * terms.spin}, T{}, by_frame[k] / rows_[i].rest_length);
        }
        add_squares(i - 1, rows_[i].bend_stiffness, residual, by_dofs, gradient, hessian);
    }

    void add_twist(int i, T *gradient, Matrix &hessian, AddedTerms &terms) const {
        const RodShape<T> &s = shapes_[i], &after = shapes_[i + 1];
        const EdgeGradient<T> g = frame_twist_gradient(after.corner, s.tangent, after.tangent, s.length, after.length);
        const T residual[1] = {s.strain - rows_[i].damped_strain};
        terms.moment_of_twist = rows_[i].twist_stiffness * residual[0];
        terms.twisting = terms.moment_of_twist * g.first;
        std::array<T, joint_dofs> by_dofs[1] = {joint_gradient<T>({g.first - terms.spin_before, g.second + terms.spin},
                                                                  -1.0 / rows_[i].rest_length, 1.0 / rows_[i + 1].rest_length)};
        add_squares(i, rows_[i].twist_stiffness, residual, by_dofs, gradient, hessian);
    }

    // Of Σ ½ stiffness · residual² of the joint whose first vertex is i. Leaves in by_dofs what is free.
    template <int count>
    void add_squares(int i, T stiffness, const T (&residual)[count], std::array<T, joint_dofs> (&by_dofs)[count], T *gradient,
                     Matrix &hessian) const {
        for (int k = 0; k < count; ++k) {
            const T force = stiffness * residual[k];
            for (int d = 0; d < joint_dofs; ++d) {
                gradient[4 * i + d] += force * by_dofs[k][d];
                by_dofs[k][d] *= d % 4 < 3 ? rows_[i + d / 4].free : rows_[i + d / 4].frame_free;
            }
        }
        hessian.add_squares(4 * i, stiffness, by_dofs);
    }

    LoadBehind<T> load_; // of all vertices, at the positions evaluated last
};

} // namespace ringlet::RINGLET_SIMD
