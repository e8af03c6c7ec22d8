// A group of strands in SIMD lanes with the objective that is evaluated on them, at the start of a step.
#pragma once

#include "ringlet/dynamics/newton.h"
#include "ringlet/strand/hinge/vertex_data.h"
#include "ringlet/strand/lane_gather.h"
#include "ringlet/strand/root_motion.h"
#include "ringlet/strand/vertex_data.h"

#include <cstddef>

namespace ringlet::RINGLET_SIMD {

// Working memory of one group's step: what it keeps, and scratch memory that only one phase of it uses at a time.
template <class Objective> struct GroupMemory {
    using Matrix = typename Objective::Matrix;

    using Row = typename Objective::Row;
    using Shape = typename Objective::Shape;

    Row *rows;
    Shape *shapes;
    Vec<Pack> *start, *velocity, *target; // positions and velocities at the start of the step; where held vertices end
    Pack *x;                              // the unknowns
    NewtonMemory<Pack> newton;

    static size_t kept_bytes(int vertices) {
        const int unknowns = Objective::dofs * vertices;
        return vertices * (sizeof(Row) + 3 * sizeof(Vec<Pack>)) +
               (3 * size_t(unknowns) + Matrix::padding + Matrix::entries(unknowns)) * sizeof(Pack);
    }
    static size_t scratch_bytes(int vertices) { return vertices * (sizeof(Shape) + Objective::dofs * sizeof(Pack)); }
    static size_t bytes(int vertices) { return kept_bytes(vertices) + scratch_bytes(vertices); }

    // Without `scratch`, that stands behind what is kept.
    GroupMemory(void *kept, void *scratch, int vertices) {
        char *next = static_cast<char *>(kept);
        const auto take = [&next]<class Type>(Type *&place, int count) {
            place = reinterpret_cast<Type *>(next);
            next += count * sizeof(Type);
        };
        const int unknowns = Objective::dofs * vertices;
        take(rows, vertices);
        take(start, vertices);
        take(velocity, vertices);
        take(target, vertices);
        take(x, unknowns);
        take(newton.gradient, unknowns);
        take(newton.direction, unknowns + Matrix::padding);
        take(newton.band, Matrix::entries(unknowns));
        use(scratch != nullptr ? scratch : next, vertices);
    }

    void use(void *scratch, int vertices) {
        shapes = static_cast<Shape *>(scratch);
        newton.trial = reinterpret_cast<Pack *>(shapes + vertices);
    }
};

inline bool is_held(const StrandLane &strand, const StrandArrays &arrays, int i) { // also behind the tip
    return !strand.has_vertex(i) || arrays.held[strand.row(i)];
}

// What a row of vertex i has for its model of bend and twist alone.
inline void gather_model(const LaneGather &gather, const StrandArrays &arrays, int i, RodRow<Pack> &row) {
    for (int k = 0; k < lanes; ++k) {
        const StrandLane &strand = gather.lane(k);
        const bool free = strand.has_corner(i) && !(is_held(strand, arrays, i) && is_held(strand, arrays, i + 1));
        set_lane(row.frame_free, k, free ? 1.0 : 0.0);
    }
}
inline void gather_model(const LaneGather &gather, const StrandArrays &arrays, int i, PlaneRow<Pack> &row) {
    gather_model(gather, arrays, i, static_cast<RodRow<Pack> &>(row));
    row.plane.normal = gather.vector(arrays.planes.normal, i);
    row.plane.offset = gather.scalar(arrays.planes.offset, i, 0.0);
    row.plane.stiffness = gather.scalar(arrays.planes.stiffness, i, 0.0);
}
inline void gather_model(const LaneGather &gather, const StrandArrays &arrays, int i, HingeRow<Pack> &row) {
    row.damped_angle = row.rest_angle;
    row.reference_delta = gather.scalar(arrays.twist, i, 0.0);
}

// Writes the row of vertex i without damping and inertia. In place: a row is large.
template <class Row>
void gather_row(const LaneGather &gather, const StrandArrays &arrays, const double *normals, int i, Row &row) {
    row = Row{};
    for (int k = 0; k < lanes; ++k) set_lane(row.free, k, is_held(gather.lane(k), arrays, i) ? 0.0 : 1.0);
    for (int c = 0; c < Row::column_count; ++c) row.*Row::columns[c] = gather.scalar(arrays.*StrandArrays::columns[c], i, 0.0);
    for (int k = 0; k < lanes; ++k) // no edge begins at the tip
        if (!gather.lane(k).has_edge(i)) set_lane(row.rest_length, k, 1.0);
    row.damped_length = row.rest_length;
    row.elastic_share = constant<Pack>(1.0);
    row.reference.normal = gather.vector(normals, i);
    gather_model(gather, arrays, i, row);
}

template <class Objective> struct GatheredGroup {
    using Matrix = typename Objective::Matrix;

    GatheredGroup(const StrandArrays &all, const StrandStep &of_step, StrandGroup group, void *kept, void *scratch = nullptr)
        : arrays(all), step(of_step), gather(all.offsets, group), vertices(gather.vertices()), memory(kept, scratch, vertices),
          objective(vertices, memory.rows, memory.shapes, step.safeguards) {
        for (int i = 0; i < vertices; ++i) {
            memory.shapes[i] = typename Objective::Shape{};
            gather_row(gather, arrays, normals(), i, memory.rows[i]);
            memory.start[i] = gather.position(arrays.positions, i);
            memory.velocity[i] = gather.vector(arrays.velocities, i);
            memory.target[i] = gather.position(arrays.targets, i);
            Objective::set_position(memory.x, i, memory.start[i]);
        }
        for (int i = 0; i + 1 < vertices; ++i) memory.rows[i].reference.tangent = unit(memory.start[i + 1] - memory.start[i]);
        start_energy = objective.begin(memory.x);
    }

    // Directors of the material frames, or normals.
    double *normals() const { return Objective::has_frames ? arrays.directors : arrays.normals; }
    void scatter_normal(const StrandLane &strand, int i) const {
        LaneGather::scatter(objective.reference_normal(i), strand, i, normals());
    }

    // Other scratch memory; what the objective kept in the former is gone.
    void use(void *scratch) {
        memory.use(scratch, vertices);
        objective.use(memory.shapes);
    }

    Matrix matrix() const { return {memory.newton.band, objective.size()}; }

    const StrandArrays &arrays;
    const StrandStep &step;
    LaneGather gather;
    int vertices; // of the longest strand
    GroupMemory<Objective> memory;
    Objective objective;
    Pack start_energy{}; // elastic [J]
};

} // namespace ringlet::RINGLET_SIMD
