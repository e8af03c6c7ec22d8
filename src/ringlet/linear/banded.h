// Symmetric positive definite banded matrix of one strand, with its LDLᵀ factorisation and solve. With T = Pack it holds and
// factors one strand per lane.
#pragma once

#include "ringlet/linear/band_layout.h"
#include "ringlet/math/pack.h"

#include <algorithm>
#include <utility>

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
    // Adds coefficient · Σ u uᵀ over several u.
    template <int terms, int count> void add_squares(int first, T coefficient, const T (&u)[terms][count]) {
        static_assert(count <= band);
        T *from = entry(first);
        for (int c = 0; c < count; ++c) {
            T *column = from + layout.begin(c);
            T weight[terms];
            for (int k = 0; k < terms; ++k) weight[k] = coefficient * u[k][c];
            for (int r = c; r < count; ++r) {
                T sum = column[r - c];
                for (int k = 0; k < terms; ++k) sum += weight[k] * u[k][r];
                column[r - c] = sum;
            }
        }
    }

    // Factors in place: A = L D Lᵀ; entry(c)[0] becomes 1/D, the rest L. The columns below a block are updated once for all
    // columns of the block.
    void factor() {
        for (int first = 0; first < columns_; first += block) eliminate(entry(first));
    }

    // 1 in lanes where A is positive definite, else 0. Before factor().
    T is_definite() const {
        constexpr int count = entries(block), step = int(layout.begin(block)); // of the columns that one block's affect
        T window[count], definite{};
        definite += 1.0;
        std::copy_n(entries_, count, window);
        for (int first = 0;; first += block) {
            eliminate(window);
            each([&](auto c) { definite = select(window[layout.begin(c)] > 0.0, definite, T{}); });
            if (first + block >= columns_) return definite;
            std::copy(window + step, window + count, window);
            std::copy_n(entries_ + layout.begin(first + block) + (count - step), step, window + (count - step));
        }
    }

    // Solves A x = b in place, after factor(); b has `padding` extra entries behind its last. The `band` values in use stay in
    // registers: right-hand sides in the forward substitution, solved values in the backward one.
    void solve(T *b) const {
        for (int k = 0; k < padding; ++k) b[columns_ + k] = T{};
        T near[band];
        for (int k = 0; k < band; ++k) near[k] = b[k];
        for (int first = 0; first < columns_; first += block) {
            const T *from = entries_ + layout.begin(first);
            each([&](auto c) {
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
            each([&](auto before) {
                constexpr int c = block - 1 - before;
                const T *column = from + layout.begin(c);
                T value = b[first + c];
                for (int k = rows(c) - 1; k > 0; --k) value -= column[k] * near[k - 1]; // the value solved last comes last
                for (int k = band - 1; k > 0; --k) near[k] = near[k - 1];
                near[0] = b[first + c] = value;
            });
        }
    }

private:
    // Eliminates the columns of the block that begins at `from`.
    static void eliminate(T *from) {
        T scaled[block][band];
        each([&](auto c) {
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
        for (int k = block; k < band; ++k) {
            T *column = from + layout.begin(k);
            for (int r = k; r < band; ++r) {
                T sum = column[r - k];
                each([&](auto c) { sum -= scaled[c][k - c] * from[layout.begin(c) + r - c]; });
                column[r - k] = sum;
            }
        }
        each([&](auto c) {
            for (int k = 0; k < rows(c); ++k) from[layout.begin(c) + k] = scaled[c][k];
        });
    }

    // Calls work(0), work(1) … for the columns of a block, as constants.
    template <class Work> static void each(const Work &work) {
        [&]<int... c>(std::integer_sequence<int, c...>) {
            (work(std::integral_constant<int, c>{}), ...);
        }(std::make_integer_sequence<int, block>{});
    }

    T *entries_;
    int columns_;
};

} // namespace ringlet::RINGLET_SIMD
