// Cholesky factor L Lᵀ of a sparse symmetric positive definite matrix of M × M blocks, ordered by minimum degree. It is for
// matrices that are analysed anew each time: DirectSolver, which works on scalars, takes a tenth of a frame of dense hair
// longer.
#pragma once

#include "ringlet/math/types.h"

#include <Eigen/Cholesky>
#include <Eigen/OrderingMethods>
#include <algorithm>
#include <array>
#include <vector>

namespace ringlet {

template <int M> class BlockCholesky {
public:
    using Block = Eigen::Matrix<double, M, M>;
    using Segment = Eigen::Matrix<double, M, 1>;

    struct Entry {
        std::array<int, 2> at; // row above column; each pair once
        Block block;
    };

    // False: the matrix is not positive definite.
    bool factor(const std::vector<Block> &diagonal, const std::vector<Entry> &below) {
        order(int(diagonal.size()), below);
        for (int k = 0; k < rows(); ++k) inverse_[k] = diagonal[original_[k]];
        for (const Entry &entry : below) {
            const int a = place_[entry.at[0]], b = place_[entry.at[1]];
            lower_[entry_of(std::max(a, b), std::min(a, b))] = a > b ? entry.block : Block(entry.block.transpose());
        }
        for (int k = 0; k < rows(); ++k) {
            const Eigen::LLT<Block> pivot(inverse_[k]);
            if (pivot.info() != Eigen::Success) return false;
            inverse_[k] = pivot.matrixL().solve(Block::Identity());
            eliminate(k);
        }
        return true;
    }

    // x becomes A⁻¹ x, row by row of the matrix.
    void solve(Segment *x) const {
        std::vector<Segment> y(rows());
        for (int k = 0; k < rows(); ++k) y[k] = x[original_[k]];
        for (int k = 0; k < rows(); ++k) {
            y[k] = (inverse_[k] * y[k]).eval();
            for (int e = starts_[k]; e < starts_[k + 1]; ++e) y[row_[e]].noalias() -= lower_[e] * y[k];
        }
        for (int k = rows() - 1; k >= 0; --k) {
            for (int e = starts_[k]; e < starts_[k + 1]; ++e) y[k].noalias() -= lower_[e].transpose() * y[row_[e]];
            x[original_[k]].noalias() = inverse_[k].transpose() * y[k];
            y[k] = x[original_[k]];
        }
    }

    int rows() const { return int(original_.size()); }
    size_t entries() const { return lower_.size(); } // blocks of L below its diagonal

private:
    // Sets the order of elimination, and the pattern of L.
    void order(int count, const std::vector<Entry> &below) {
        std::vector<Eigen::Triplet<double>> graph;
        for (const Entry &entry : below)
            for (const int side : {0, 1}) graph.emplace_back(entry.at[side], entry.at[1 - side], 1.0);
        for (int k = 0; k < count; ++k) graph.emplace_back(k, k, 1.0);
        Eigen::SparseMatrix<double> pattern(count, count);
        pattern.setFromTriplets(graph.begin(), graph.end());
        Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation;
        Eigen::AMDOrdering<int>()(pattern, permutation);
        original_.assign(permutation.indices().data(), permutation.indices().data() + count);
        place_.resize(count);
        for (int k = 0; k < count; ++k) place_[original_[k]] = k;

        std::vector<std::vector<int>> rows_of(count); // by column; those of a column pass to the first of them
        for (const Entry &entry : below) {
            const auto [column, row] = std::minmax(place_[entry.at[0]], place_[entry.at[1]]);
            rows_of[column].push_back(row);
        }
        starts_.assign(1, 0), row_.clear();
        for (std::vector<int> &rows : rows_of) {
            std::sort(rows.begin(), rows.end());
            rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
            if (!rows.empty()) {
                std::vector<int> &parent = rows_of[rows.front()];
                parent.insert(parent.end(), rows.begin() + 1, rows.end());
            }
            row_.insert(row_.end(), rows.begin(), rows.end());
            starts_.push_back(int(row_.size()));
        }
        lower_.assign(row_.size(), Block::Zero());
        inverse_.resize(count);
    }

    int entry_of(int row, int column) const {
        return int(std::lower_bound(row_.begin() + starts_[column], row_.begin() + starts_[column + 1], row) - row_.begin());
    }

    // Scales column k of L by its pivot and subtracts what it contributes to the columns behind.
    void eliminate(int k) {
        const int end = starts_[k + 1];
        for (int e = starts_[k]; e < end; ++e) lower_[e] = lower_[e].lazyProduct(inverse_[k].transpose()).eval();
        for (int e = starts_[k]; e < end; ++e) {
            inverse_[row_[e]].noalias() -= lower_[e].lazyProduct(lower_[e].transpose());
            int to = starts_[row_[e]];
            for (int other = e + 1; other < end; ++other) {
                while (row_[to] != row_[other]) ++to;
                lower_[to].noalias() -= lower_[other].lazyProduct(lower_[e].transpose());
            }
        }
    }

    std::vector<int> original_, place_; // row of the matrix that is eliminated k-th; the inverse
    std::vector<int> starts_, row_;     // blocks of L below its diagonal, by column
    std::vector<Block> lower_;
    std::vector<Block> inverse_; // of the diagonal blocks of L
};

} // namespace ringlet
