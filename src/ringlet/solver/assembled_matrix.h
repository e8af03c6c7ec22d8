// The whole Hessian of an objective, for a direct solver: a block row for every dynamic vertex.
#pragma once

#include "ringlet/linear/sparse_matrix.h"
#include "ringlet/solver/objective.h"

#include <memory>

namespace ringlet {

class AssembledMatrix final : public MatrixAssembly {
public:
    // Of an assembled objective whose blocks are not factored yet. Blocks that are not active stay where they are.
    explicit AssembledMatrix(const Objective &objective);

    int size() const { return vertices() * block_; }
    std::shared_ptr<const SparsePattern> pattern() const;
    View<double> triplets() const { return values_; }

    std::vector<double> right_hand_side() const; // −gradient
    void set(View<double> solution, AlignedVector &direction) const;

    int block() const override { return block_; }
    double *add_block(int row, int column) override;

private:
    int vertices() const { return objective_.table.dynamic_vertices; }
    void add_couplings(const Stencil &pair, const Mat3 &hessian);
    template <class Work> void for_unknowns(const Work &work) const;

    const Objective &objective_;
    int block_ = 3;
    std::vector<int> i_, j_;
    std::vector<double> values_;
};

} // namespace ringlet
