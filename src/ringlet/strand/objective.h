// Objective of a strand's time step: Σ ½ aᵢ ‖xᵢ − yᵢ‖² (inertia, gravity, mass damping, drag) + stretch + bend + twist.
// Held vertices are left out. Damping is part of the elastic energies (time_discretisation.h), the time integrator of a and y
// (dynamics/time_integrator.h). This base class has all but bend and twist; see rod_objective.h and hinge/objective.h.
#pragma once

#include "ringlet/energy/strand/bend.h"
#include "ringlet/energy/strand/stretch.h"
#include "ringlet/linear/banded.h"
#include "ringlet/strand/curved_path.h"
#include "ringlet/strand/vertex_data.h"

namespace ringlet::RINGLET_SIMD {

// `dofs_` unknowns per vertex, the first three its position.
template <class T, int dofs_, int band, class RowOfModel, class ShapeOfModel> class StrandObjective {
public:
    static constexpr int dofs = dofs_;
    static constexpr bool has_frames = dofs == 4;
    using Matrix = Banded<T, dofs, band>;
    using Row = RowOfModel;
    using Shape = ShapeOfModel;

    StrandObjective(int vertices, Row *rows, Shape *shapes) : vertices_(vertices), rows_(rows), shapes_(shapes) {}

    int size() const { return dofs * vertices_; }

    // Other memory for shapes. Evaluation sets all of them but for what the ends of a strand lack, which is 0.
    void use(Shape *shapes) {
        shapes_ = shapes;
        for (const int i : {0, vertices_ - 2, vertices_ - 1}) shapes_[i] = Shape{};
    }

    // Largest step along a direction, at most 1, that changes no edge vector by more than twice its length. Beyond that, as
    // where an edge reverses, the linear model does not hold.
    T max_step(const T *x, const T *direction) const {
        T step = constant<T>(1.0);
        for (int i = 0; i + 1 < vertices_; ++i) {
            const T change = norm(position(direction, i + 1) - position(direction, i));
            const T most =
                strand_settings::max_edge_change * max(rows_[i].rest_length, norm(position(x, i + 1) - position(x, i)));
            const auto too_far = step * change > most;
            step = select(too_far, most / select(too_far, change, constant<T>(1.0)), step);
        }
        return step;
    }

    void curved_path(const T *x, T step, const T *direction, T *to) const {
        RINGLET_SIMD::curved_path<dofs>(vertices_, rows_, x, step, direction, to);
    }

    static Vec<T> position(const T *x, int i) { return RINGLET_SIMD::position<dofs>(x, i); }
    static void set_position(T *x, int i, Vec<T> to) { // with γ = 0
        put(x + dofs * i, to);
        for (int k = 3; k < dofs; ++k) x[dofs * i + k] = T{};
    }

protected:
    // An edge that has shrunk to a point gets the direction of the x axis and a length to divide by.
    void measure_edge(const T *x, int i, StrandShape<T> &shape) const {
        const Vec<T> edge = position(x, i + 1) - position(x, i), x_axis{constant<T>(1.0), T{}, T{}};
        const T length = norm(edge), least = strand_settings::shortest_edge * rows_[i].rest_length;
        const auto point = length < least;
        shape.length = select(point, least, length);
        shape.tangent = select<T>(point, x_axis, (1.0 / shape.length) * edge);
    }

    // Of terms of positions alone whose last vertex is i: inertia, and planes.
    T vertex_energy(const T *x, int i) const {
        const Vec<T> offset = position(x, i) - rows_[i].inertia_target;
        T energy = 0.5 * rows_[i].free * rows_[i].inertia * dot(offset, offset);
        if constexpr (has_plane<Row>) energy += rows_[i].free * plane_energy(rows_[i].plane, position(x, i));
        return energy;
    }

    T edge_energy(int i, const StrandShape<T> &shape) const {
        return stretch_energy(shape.length, rows_[i].damped_length, rows_[i].stretch_stiffness);
    }

    // Gradient and Hessian of inertia and stretch. Calls add_others(last) for the other terms whose last vertex that is, while
    // its rows of the matrix are in cache, and complete(i) once all terms of vertex i are there.
    template <class AddOthers, class Complete>
    void assemble_terms(T *gradient, Matrix &hessian, const AddOthers &add_others, const Complete &complete) const {
        constexpr int reach = Matrix::padding / dofs - 1; // of a term, in vertices behind its first
        const auto finish = [&](int i) {
            for (int k = 0; k < 3; ++k) gradient[dofs * i + k] *= rows_[i].free;
            complete(i);
        };
        for (int last = 0; last < vertices_; ++last) {
            begin_vertex(last, gradient, hessian);
            if (last > 0) add_stretch(last - 1, gradient, hessian);
            add_others(last);
            if (last >= reach) finish(last - reach);
        }
        for (int i = vertices_ < reach ? 0 : vertices_ - reach; i < vertices_; ++i) finish(i);
        hessian.set_zero(size(), size() + Matrix::padding);
    }

    void begin_vertex(int i, T *gradient, Matrix &hessian) const {
        hessian.set_zero(dofs * i, dofs * (i + 1));
        for (int k = 0; k < dofs; ++k) gradient[dofs * i + k] = T{};
        const Row &r = rows_[i];
        add(gradient, i, r.inertia * (position(positions_, i) - r.inertia_target));
        add_diagonal(hessian, i, r.free * r.inertia + (1.0 - r.free));
        if constexpr (has_plane<Row>) {
            const Vec<T> at = position(positions_, i);
            const T normal[3] = {r.plane.normal.x, r.plane.normal.y, r.plane.normal.z};
            add(gradient, i, plane_gradient(r.plane, at));
            hessian.add_square(dofs * i, r.free * plane_hessian(r.plane, at), normal);
        }
    }

    void add_stretch(int i, T *gradient, Matrix &hessian) const {
        const Shape &s = shapes_[i];
        const Stretch<T> e = stretch(s.tangent, s.length, rows_[i].damped_length, rows_[i].stretch_stiffness);
        add(gradient, i, -e.gradient);
        add(gradient, i + 1, e.gradient);
        const T free0 = rows_[i].free, free1 = rows_[i + 1].free;
        T along[dofs + 3] = {};
        put(along, -(free0 * s.tangent));
        put(along + dofs, free1 * s.tangent);
        hessian.add_square(dofs * i, e.along - e.across, along);
        add_diagonal(hessian, i, e.across * free0);
        add_diagonal(hessian, i + 1, e.across * free1);
        for (int k = 0; k < 3; ++k) hessian.entry(dofs * i + k)[dofs] -= e.across * free0 * free1;
    }

    // Number of the edge's negative eigenvalues, which its Hessian leaves out: two across a compressed edge.
    T clamped_stretch(int i) const {
        return select(shapes_[i].length < (1.0 - clamped_from) * rows_[i].damped_length, constant<T>(2.0), T{});
    }

    static void add(T *gradient, int vertex, Vec<T> value) {
        for (int k = 0; k < 3; ++k) gradient[dofs * vertex + k] += value[k];
    }

    static void add_diagonal(Matrix &hessian, int vertex, T value) {
        for (int k = 0; k < 3; ++k) hessian.entry(dofs * vertex + k)[0] += value;
    }

    bool is_corner(int i) const { return i > 0 && i + 1 < vertices_; }
    bool is_hinge(int i) const { return i > 0 && i + 2 < vertices_; }

    int vertices_;
    Row *rows_;
    Shape *shapes_;
    const T *positions_ = nullptr;
};

} // namespace ringlet::RINGLET_SIMD
