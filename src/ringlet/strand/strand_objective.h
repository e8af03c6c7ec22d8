// What a time step of a strand minimises: Σ ½ aᵢ ‖xᵢ − yᵢ‖² (inertia, gravity, mass damping, drag) + stretch + bend + twist,
// with the vertices that are held left out. Rates are (x − x̂)/h, of positions, velocities and strains alike: backward Euler has
// x̂ = xₙ, h = dt; BDF-2 x̂ = xₙ + ⅓ (xₙ − xₙ₋₁), h = ⅔ dt. Damping of strains needs no term of its own: with b = β/h,
// ½ k (θ − θ̄)² + ½ b k (θ − θ̂)² = ½ k (1 + b) (θ − (θ̄ + b θ̂)/(1 + b))² + constant.
// Here is what the models of bend and twist share; they are hinge_objective.h and frame_objective.h.
#pragma once

#include "ringlet/energy/strand/bend.h"
#include "ringlet/energy/strand/stretch.h"
#include "ringlet/linear/banded.h"
#include "ringlet/strand/strand_arrays.h"
#include "ringlet/strand/strand_shape.h"

namespace ringlet::RINGLET_SIMD {

template <class T> inline void put(T *u, Vec<T> v) {
    u[0] = v.x;
    u[1] = v.y;
    u[2] = v.z;
}

// `freedoms` unknowns a vertex, the first three its position.
template <class T, int freedoms_, int band> class StrandObjective {
public:
    static constexpr int freedoms = freedoms_;
    using Matrix = Banded<T, freedoms, band>;

    StrandObjective(int vertices, StrandRow<T> *rows, StrandShape<T> *shapes, Safeguards safeguards = {})
        : vertices_(vertices), rows_(rows), shapes_(shapes), safeguards_(safeguards) {}

    int size() const { return freedoms * vertices_; }

    // What was evaluated last stands there now: the same numbers in other memory.
    void find_at(const T *x) { positions_ = x; }

    // How much of a direction from x is worth going: of what changes an edge by more than twice its length, as it does when it
    // turns round, what is linear says nothing.
    T worth_going(const T *x, const T *direction) const {
        constexpr double most_change = 2.0; // of its length
        T part = constant<T>(1.0);
        for (int i = 0; i + 1 < vertices_; ++i) {
            const T way = norm(position(direction, i + 1) - position(direction, i));
            const T most = most_change * max(rows_[i].rest_length, norm(position(x, i + 1) - position(x, i)));
            const auto too_far = part * way > most;
            part = select(too_far, most / select(too_far, way, constant<T>(1.0)), part);
        }
        return part;
    }

    // Where a part `step` of a direction leads from x. Were their ends to go straight, edges that turn by an angle φ would get
    // longer by ½ φ², and stretch is stiff: next to nothing would be left of a direction on which strands turn. So an edge
    // turns to where its ends lead it, but gets longer by what the direction says to first order alone, and what follows along
    // the strand comes along. Where the strand is held again, what is missing there is shared out among the edges before.
    void move(const T *x, T step, const T *direction, T *to) const {
        constexpr double least = 0.1; // of its length is left to an edge
        Vec<T> last{}, along{};       // where the vertex before would go straight; what has come along
        T length{};                   // at rest, since the last held vertex
        for (int i = 0; i < vertices_; ++i) {
            const Vec<T> straight = position(x, i) + step * position(direction, i);
            if (i > 0) {
                const Vec<T> edge = position(x, i) - position(x, i - 1), turned = straight - last;
                const T now = norm(edge), then = norm(turned);
                const auto point = (now < 1e-300) | (then < 1e-300);
                const T wanted = max(now + dot(edge, turned - edge) / select(point, constant<T>(1.0), now), least * now);
                along =
                    along + (select(point, constant<T>(1.0), wanted / select(point, constant<T>(1.0), then)) - 1.0) * turned;
                length += rows_[i - 1].rest_length;
            }
            last = straight;
            put(to + freedoms * i, straight + along);
            for (int k = 3; k < freedoms; ++k) to[freedoms * i + k] = x[freedoms * i + k] + step * direction[freedoms * i + k];
            const auto held = rows_[i].free == 0.0;
            if (any(held)) {
                close(i, held, length, along, to);
                put(to + freedoms * i, select<T>(held, straight, straight + along));
                along = select<T>(held, Vec<T>{}, along);
                length = select(held, T{}, length);
            }
        }
    }

    static Vec<T> position(const T *x, int i) { return {x[freedoms * i], x[freedoms * i + 1], x[freedoms * i + 2]}; }

protected:
    // At a vertex that is held and no tip the edges since the last one that was, `length` of them, have missed it by `by`.
    void close(int held_at, const MaskOf<T> &held, T length, Vec<T> by, T *to) const {
        if (held_at == 0) return;
        T open = select(held & (rows_[held_at - 1].stretch > 0.0), length, T{}); // behind the tip there is nothing to miss
        const Vec<T> missed = (1.0 / select(open > 0.0, open, constant<T>(1.0))) * by;
        for (int i = held_at - 1; i >= 0 && any(open > 0.0); --i) {
            open = select(rows_[i].free > 0.0, max(open - rows_[i].rest_length, T{}), T{});
            put(to + freedoms * i, position(to, i) - open * missed);
        }
    }

    // An edge that has shrunk to a point is given some direction and a length that can be divided by.
    void measure_edge(const T *x, int i, StrandShape<T> &shape) const {
        const Vec<T> edge = position(x, i + 1) - position(x, i), some{constant<T>(1.0), T{}, T{}};
        const T length = norm(edge), least = 1e-6 * rows_[i].rest_length;
        const auto point = length < least;
        shape.length = select(point, least, length);
        shape.tangent = select<T>(point, some, (1.0 / shape.length) * edge);
    }

    T inertia_of(const T *x, int i) const {
        const Vec<T> away = position(x, i) - rows_[i].inertial;
        return 0.5 * rows_[i].free * rows_[i].inertia * dot(away, away);
    }

    T stretch_of(int i, const StrandShape<T> &shape) const {
        return stretch_energy(shape.length, rows_[i].damped_length, rows_[i].stretch);
    }

    // Inertia and stretch, and calls add_bend(i) and add_twist(i) of corners and hinges: each term as soon as the last of its
    // vertices is there, while what it adds to is near.
    template <class AddBend, class AddTwist>
    void assemble_along(T *gradient, Matrix &hessian, const AddBend &add_bend, const AddTwist &add_twist) const {
        for (int last = 0; last < vertices_; ++last) {
            begin_vertex(last, gradient, hessian);
            if (last > 0) add_stretch(last - 1, gradient, hessian);
            if (last > 1) add_bend(last - 1);
            if (last > 2) add_twist(last - 2);
        }
        hessian.set_zero(size(), size() + Matrix::padding);
    }

    void begin_vertex(int i, T *gradient, Matrix &hessian) const {
        hessian.set_zero(freedoms * i, freedoms * (i + 1));
        for (int k = 0; k < freedoms; ++k) gradient[freedoms * i + k] = T{};
        const StrandRow<T> &r = rows_[i];
        add(gradient, i, r.inertia * (position(positions_, i) - r.inertial));
        add_diagonal(hessian, i, r.free * r.inertia + (1.0 - r.free));
    }

    void add_stretch(int i, T *gradient, Matrix &hessian) const {
        const StrandShape<T> &s = shapes_[i];
        const Stretch<T> e = stretch(s.tangent, s.length, rows_[i].damped_length, rows_[i].stretch);
        add(gradient, i, -e.gradient);
        add(gradient, i + 1, e.gradient);
        const T free0 = rows_[i].free, free1 = rows_[i + 1].free;
        T along[freedoms + 3] = {};
        put(along, -(free0 * s.tangent));
        put(along + freedoms, free1 * s.tangent);
        hessian.add_square(freedoms * i, e.along - e.across, along);
        add_diagonal(hessian, i, e.across * free0);
        add_diagonal(hessian, i + 1, e.across * free1);
        for (int k = 0; k < 3; ++k) hessian.entry(freedoms * i + k)[freedoms] -= e.across * free0 * free1;
    }

    // Eigenvalues of the edge's Hessian that are left out: the two across an edge that is compressed.
    T clamped_stretch(int i) const {
        return select(shapes_[i].length < (1.0 - clamped_from) * rows_[i].damped_length, constant<T>(2.0), T{});
    }

    void hold(T *gradient) const {
        for (int i = 0; i < vertices_; ++i)
            for (int k = 0; k < 3; ++k) gradient[freedoms * i + k] *= rows_[i].free;
    }

    static void add(T *gradient, int vertex, Vec<T> value) {
        for (int k = 0; k < 3; ++k) gradient[freedoms * vertex + k] += value[k];
    }

    static void add_diagonal(Matrix &hessian, int vertex, T value) {
        for (int k = 0; k < 3; ++k) hessian.entry(freedoms * vertex + k)[0] += value;
    }

    bool is_corner(int i) const { return i > 0 && i + 1 < vertices_; }
    bool is_hinge(int i) const { return i > 0 && i + 2 < vertices_; }

    int vertices_;
    StrandRow<T> *rows_;
    StrandShape<T> *shapes_;
    Safeguards safeguards_;
    const T *positions_ = nullptr;
};

} // namespace ringlet::RINGLET_SIMD
