// A symmetric positive definite banded matrix of one strand, its exact factor and its solution. With T = Pack a strand per lane
// is factored at once.
#pragma once

#include "ringlet/math/pack.h"

namespace ringlet::RINGLET_SIMD {

// The lower band, column by column: entry(c)[k] is the element in row c + k of column c, k = 0 … band − 1.
template <class T, int band_> class Banded {
public:
    static constexpr int band = band_;
    static constexpr int padding = band_; // columns behind the last, so that no loop needs an end test
    static constexpr int entries(int columns) { return (columns + padding) * band; }

    Banded(T *memory, int columns) : entries_(memory), columns_(columns) {}

    void set_zero() {
        for (int i = 0; i < entries(columns_); ++i) entries_[i] = T{};
    }

    T *entry(int column) { return entries_ + column * band; }

    // Adds coefficient · u uᵀ, where u stands in the rows first, first + 1 …
    template <int count> void add_square(int first, T coefficient, const T (&u)[count]) {
        static_assert(count <= band);
        for (int c = 0; c < count; ++c) {
            T *column = entry(first + c);
            const T weight = coefficient * u[c];
            for (int r = c; r < count; ++r) column[r - c] += weight * u[r];
        }
    }

    // Factors in place: A = L D Lᵀ; entry(c)[0] becomes 1/D, the rest L.
    void factor() {
        for (int c = 0; c < columns_; ++c) {
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

    // Solves A x = b in place, after factor(); b has room for `padding` entries behind its last. What later rows wait for, and
    // on the way back what was solved last, stays in registers.
    void solve(T *b) const {
        for (int k = 0; k < padding; ++k) b[columns_ + k] = T{};
        T near[band];
        for (int k = 0; k < band; ++k) near[k] = b[k];
        for (int c = 0; c < columns_; ++c) {
            const T *column = entries_ + c * band;
            const T value = near[0];
            for (int k = 1; k < band; ++k) near[k - 1] = near[k] - column[k] * value;
            near[band - 1] = b[c + band];
            b[c] = value * column[0];
        }
        for (int k = 0; k < band; ++k) near[k] = T{};
        for (int c = columns_ - 1; c >= 0; --c) {
            const T *column = entries_ + c * band;
            T value = b[c];
            for (int k = band - 1; k > 0; --k) value -= column[k] * near[k - 1]; // what was solved last, last
            for (int k = band - 1; k > 0; --k) near[k] = near[k - 1];
            near[0] = b[c] = value;
        }
    }

private:
    T *entries_;
    int columns_;
};

} // namespace ringlet::RINGLET_SIMD
