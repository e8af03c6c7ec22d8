// Symmetric positive definite banded matrix of one strand, with its LDLᵀ factorisation and solve. With T = Pack it holds and
// factors one strand per lane.
#pragma once

#include "ringlet/linear/band_layout.h"
#include "ringlet/math/pack.h"
#include "ringlet/math/unroll.h"

namespace ringlet::RINGLET_SIMD {

// entry(c)[k] is the element in row c + k of column c, k = 0 … rows(c) − 1 (band_layout.h).
template <class T, int block, int band> class Banded {
public:
    static constexpr BandLayout layout{block, band};
    static constexpr int padding = (band + block - 1) / block * block; // extra columns, so that loops need no end test
    static constexpr int entries(int columns) { return int(layout.begin(columns + padding)); }
    static constexpr int rows(int column) { return layout.rows(column); }

    // `columns`: a multiple of `block`.
    Banded(T *memory, int columns) : entries_(memory), columns_(columns) {}

    void set_zero() { set_zero(0, columns_ + padding); }
    void set_zero(int from, int to) { // columns; multiples of `block`
        for (T *i = entry(from); i < entry(to); ++i) *i = T{};
    }

    T *entry(int column) { return entries_ + layout.begin(column); }

    // Adds coefficient · u uᵀ, with u in the rows from `first` on, the first row of a block.
    template <int count> void add_square(int first, T coefficient, const T (&u)[count]) {
        add_squares(first, coefficient, reinterpret_cast<const T(&)[1][count]>(u));
    }
    // Adds coefficient · Σ u uᵀ over several u, each an array of values.
    template <int terms, class Array> void add_squares(int first, T coefficient, const Array (&u)[terms]) {
        constexpr int count = sizeof(Array) / sizeof(T);
        static_assert(count <= band);
        T *from = entry(first);
        unroll<0, count>([&](auto c) {
            T *column = from + layout.begin(c), weight[terms];
            for (int k = 0; k < terms; ++k) weight[k] = coefficient * u[k][c];
            unroll<c, count>([&](auto r) {
                T sum = column[r - c];
                for (int k = 0; k < terms; ++k) sum += weight[k] * u[k][r];
                column[r - c] = sum;
            });
        });
    }

    // Factors in place: A = L D Lᵀ; entry(c)[0] becomes 1/D, the rest L. The columns below a block are updated once for all
    // columns of the block.
    void factor() {
        for (int first = 0; first < columns_; first += block) eliminate<true>(entry(first));
    }

    // Solves A x = b in place, after factor(); b has `padding` extra entries behind its last. The `band` values in use stay in
    // registers: right-hand sides in the forward substitution, solved values in the backward one.
    void solve(T *b) const {
        for (int k = 0; k < padding; ++k) b[columns_ + k] = T{};
        T near[band];
        for (int k = 0; k < band; ++k) near[k] = b[k];
        for (int first = 0; first < columns_; first += block) {
            const T *from = entries_ + layout.begin(first);
            unroll<0, block>([&](auto c) {
                const T *column = from + layout.begin(c);
                const T value = near[0];
                for (int k = 1; k < band; ++k) near[k - 1] = k < rows(c) ? near[k] - column[k] * value : near[k];
                near[band - 1] = b[first + c + band];
                b[first + c] = value * column[0];
            });
        }
        for (int k = 0; k < band; ++k) near[k] = T{};
        for (int first = columns_ - block; first >= 0; first -= block) {
            const T *from = entries_ + layout.begin(first);
            unroll<0, block>([&](auto before) {
                constexpr int c = block - 1 - before;
                const T *column = from + layout.begin(c);
                T value = b[first + c];
                for (int k = rows(c) - 1; k > 0; --k) value -= column[k] * near[k - 1]; // the value solved last comes last
                for (int k = band - 1; k > 0; --k) near[k] = near[k - 1];
                near[0] = b[first + c] = value;
            });
        }
    }

    // Eliminates the columns of the block that begins at `from`: subtracts what they add to the columns behind, and with
    // `factors` leaves their part of the factorisation.
    template <bool factors> static void eliminate(T *from) {
        T scaled[block][band];
        unroll<0, block>([&](auto c) {
            constexpr int count = rows(c);
            T *pivot = from + layout.begin(c);
            const T inverse = 1.0 / pivot[0];
            scaled[c][0] = inverse;
            for (int k = 1; k < count; ++k) scaled[c][k] = inverse * pivot[k];
            for (int k = 1; k < block - c; ++k) {
                T *column = from + layout.begin(c + k);
                for (int r = k; r < count; ++r) column[r - k] -= scaled[c][k] * pivot[r];
            }
        });
        unroll<block, band>([&](auto k) {
            T *column = from + layout.begin(k);
            unroll<k, band>([&](auto r) {
                T sum = column[r - k];
                unroll<0, block>([&](auto c) { sum -= scaled[c][k - c] * from[layout.begin(c) + r - c]; });
                column[r - k] = sum;
            });
        });
        if constexpr (factors)
            unroll<0, block>([&](auto c) {
                for (int k = 0; k < rows(c); ++k) from[layout.begin(c) + k] = scaled[c][k];
            });
    }

private:
    T *entries_;
    int columns_;
};

// Tells where a banded matrix is positive definite while it is assembled, block after block: each is eliminated as soon as it
// is complete, in a window of the columns that this affects.
template <class Matrix, class T> class DefinitenessTest {
    static constexpr auto layout = Matrix::layout;
    static constexpr int block = layout.block, live = Matrix::padding / block, blocks = 8;
    static constexpr int entries = int(layout.begin(block)); // of a block's columns
    static_assert(live < blocks);

public:
    // What is added here is tested, and is no part of the matrix. Columns: of the `live` blocks that are completed next.
    T *entry(int column) { return window_ + (layout.begin(column) - first_); }

    // The next block of the matrix is complete.
    void complete(const T *of_matrix) {
        T *from = window_ + position_ * entries;
        for (int k = 0; k < entries; ++k) from[k] += of_matrix[k];
        Matrix::template eliminate<false>(from);
        for (int c = 0; c < block; ++c) definite_ = select(from[layout.begin(c)] > 0.0, definite_, T{});
        if (++position_ + live > blocks) move_to_front();
    }

    T definite() const { return definite_; } // 1 in lanes where each complete block is, else 0

private:
    void move_to_front() {
        const int kept = (live - 1) * entries, from = position_ * entries;
        for (int k = 0; k < kept; ++k) window_[k] = window_[from + k];
        for (int k = kept; k < blocks * entries; ++k) window_[k] = T{};
        first_ += size_t(from);
        position_ = 0;
    }

    T window_[blocks * entries] = {};
    size_t first_ = 0; // entry of the matrix at which the window begins
    int position_ = 0; // block of the window that is completed next
    T definite_ = constant<T>(1.0);
};

} // namespace ringlet::RINGLET_SIMD
