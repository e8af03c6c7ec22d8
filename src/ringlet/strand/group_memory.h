// Working memory of one group's step, laid out in one block.
#pragma once

#include "ringlet/dynamics/newton.h"
#include "ringlet/strand/vertex_data.h"

#include <cstddef>

namespace ringlet::RINGLET_SIMD {

template <class Objective> struct GroupMemory {
    using Matrix = typename Objective::Matrix;

    StrandRow<Pack> *rows;
    StrandShape<Pack> *shapes;
    Vec<Pack> *start, *velocity, *target; // positions and velocities at the start of the step; where held vertices end
    Pack *x;                              // the unknowns
    NewtonMemory<Pack> newton;

    static size_t bytes(int vertices) {
        const int unknowns = Objective::dofs * vertices;
        return vertices * (sizeof(StrandRow<Pack>) + sizeof(StrandShape<Pack>) + 3 * sizeof(Vec<Pack>)) +
               (4 * size_t(unknowns) + Matrix::padding + Matrix::entries(unknowns)) * sizeof(Pack);
    }

    GroupMemory(void *memory, int vertices) {
        char *next = static_cast<char *>(memory);
        const auto take = [&next]<class Type>(Type *&place, int count) {
            place = reinterpret_cast<Type *>(next);
            next += count * sizeof(Type);
        };
        const int unknowns = Objective::dofs * vertices;
        take(rows, vertices);
        take(shapes, vertices);
        take(start, vertices);
        take(velocity, vertices);
        take(target, vertices);
        take(x, unknowns);
        take(newton.trial, unknowns);
        take(newton.gradient, unknowns);
        take(newton.direction, unknowns + Matrix::padding);
        take(newton.band, Matrix::entries(unknowns));
    }
};

} // namespace ringlet::RINGLET_SIMD
