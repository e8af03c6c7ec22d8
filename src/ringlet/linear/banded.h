// A symmetric positive definite block-banded matrix of one strand (3×3 blocks, three blocks below the diagonal), its exact
// factor and its solution. With T = Pack a strand per lane is factored at once.
#pragma once

#include "ringlet/math/pack.h"

namespace ringlet::RINGLET_SIMD {

// The lower band, column by column: entry(c)[k] is the element in row c + k of scalar column c, k = 0 … 11.
template <class T> class Banded {
public:
    static constexpr int band = 12;    // entries of a column
    static constexpr int padding = 12; // columns behind the last, so that no loop needs an end test
    static constexpr int entries(int vertices) { return (3 * vertices + padding) * band; }

    Banded(T *memory, int vertices) : columns_(memory), vertices_(vertices) {}

    void set_zero() {
        for (int i = 0; i < entries(vertices_); ++i) columns_[i] = T{};
    }

    T *entry(int column) { return columns_ + column * band; }

    void add_diagonal(int vertex, T value) {
        for (int c = 0; c < 3; ++c) entry(3 * vertex + c)[0] += value;
    }

    // Adds value · I to the block that couples a vertex with the next.
    void add_coupling(int vertex, T value) {
        for (int c = 0; c < 3; ++c) entry(3 * vertex + c)[3] += value;
    }

    // Adds coefficient · u uᵀ, where u has the parts u[0 … count) at the vertices first, first + 1 …
    template <int count> void add_square(int first, T coefficient, const Vec<T> (&u)[count]) {
        for (int b = 0; b < count; ++b)
            for (int c = 0; c < 3; ++c) {
                T *column = entry(3 * (first + b) + c);
                const T weight = coefficient * u[b][c];
                for (int r = c; r < 3; ++r) column[r - c] += weight * u[b][r];
                for (int a = b + 1; a < count; ++a)
                    for (int r = 0; r < 3; ++r) column[3 * (a - b) + r - c] += weight * u[a][r];
            }
    }

    // Factors in place: A = L D Lᵀ; entry(c)[0] becomes 1/D, the rest L.
    void factor() {
        for (int c = 0; c < 3 * vertices_; ++c) {
            T *pivot = entry(c);
            const T inverse = 1.0 / pivot[0];
            T scaled[band];
            for (int k = 1; k < band; ++k) scaled[k] = inverse * pivot[k];
            for (int k = 1; k < band; ++k) {
                T *column = entry(c + k);
                for (int r = k; r < band; ++r) column[r - k] -= scaled[k] * pivot[r];
            }
            pivot[0] = inverse;
            for (int k = 1; k < band; ++k) pivot[k] = scaled[k];
        }
    }

    // Solves A x = b in place, after factor(); b has room for `padding` entries behind its last.
    void solve(T *b) {
        const int size = 3 * vertices_;
        for (int k = 0; k < padding; ++k) b[size + k] = T{};
        for (int c = 0; c < size; ++c) {
            const T *column = entry(c);
            const T value = b[c];
            for (int k = 1; k < band; ++k) b[c + k] -= column[k] * value;
            b[c] = value * column[0];
        }
        for (int k = 0; k < padding; ++k) b[size + k] = T{};
        for (int c = size - 1; c >= 0; --c) {
            const T *column = entry(c);
            T value = b[c];
            for (int k = 1; k < band; ++k) value -= column[k] * b[c + k];
            b[c] = value;
        }
    }

private:
    T *columns_;
    int vertices_;
};

} // namespace ringlet::RINGLET_SIMD
