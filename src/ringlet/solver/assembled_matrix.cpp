#include "ringlet/solver/assembled_matrix.h"

#include <algorithm>

namespace ringlet {

AssembledMatrix::AssembledMatrix(const Objective &objective) : objective_(objective) {
    const BlockSet &blocks = objective.blocks;
    for (int b = 0; b < blocks.count(); ++b) block_ = std::max(block_, blocks[b].dofs());
    const std::vector<unsigned char> active = blocks.blocks_with(blocks.active_objects());
    for (int b = 0; b < blocks.count(); ++b) {
        if (active[b]) {
            blocks[b].add_to(*this);
            continue;
        }
        for (const BlockObject &object : blocks[b].objects())
            for (int v = object.first; v < object.end; ++v) {
                double *const unit = add_block(v, v);
                for (int k = 0; k < block_; ++k) unit[k * block_ + k] = 1.0;
            }
    }
    for (const Couplings::Coupling &coupling : objective.couplings.all())
        add_couplings(objective.contacts.stencil_of(coupling.pair), objective.pair_values()[coupling.pair].hessian);
}

double *AssembledMatrix::add_block(int row, int column) {
    i_.push_back(row);
    j_.push_back(column);
    values_.resize(values_.size() + size_t(block_) * block_, 0.0);
    return values_.data() + values_.size() - size_t(block_) * block_;
}

// What a pair force does from side to side; the rest is in the blocks.
void AssembledMatrix::add_couplings(const Stencil &pair, const Mat3 &hessian) {
    const auto &moves = objective_.table.mesh.moves;
    for (int i = 0; i < pair.first; ++i)
        for (int j = pair.first; j < 4; ++j) {
            if (!moves[pair.vertex[i]] || !moves[pair.vertex[j]] || pair.weight[i] * pair.weight[j] == 0.0) continue;
            double *block = add_block(pair.vertex[i], pair.vertex[j]);
            for (int r = 0; r < 3; ++r)
                for (int k = 0; k < 3; ++k) block[r * block_ + k] = pair.weight[i] * pair.weight[j] * hessian(r, k);
        }
}

std::shared_ptr<const SparsePattern> AssembledMatrix::pattern() const {
    return std::make_shared<const SparsePattern>(vertices(), block_, i_, j_);
}

// work(row of the matrix, entry of the blocks' vectors, block).
template <class Work> void AssembledMatrix::for_unknowns(const Work &work) const {
    const BlockSet &blocks = objective_.blocks;
    for (int v = 0; v < vertices(); ++v) {
        const auto [first, stride] = blocks.slot(v);
        const int block = blocks.block_of(objective_.table.object_of(v));
        for (int k = 0; k < blocks.dofs(v); ++k) work(v * block_ + k, size_t(first) + size_t(k) * stride, block);
    }
}

std::vector<double> AssembledMatrix::right_hand_side() const {
    const BlockSet &blocks = objective_.blocks;
    std::vector<double> b(size(), 0.0);
    const std::vector<unsigned char> active = blocks.blocks_with(blocks.active_objects());
    for_unknowns([&](int row, size_t i, int block) {
        if (active[block]) b[row] = -blocks[block].gradient()[i - blocks.begin(block)];
    });
    return b;
}

void AssembledMatrix::set(View<double> solution, AlignedVector &direction) const {
    for_unknowns([&](int row, size_t i, int) { direction[i] = solution[row]; });
}

} // namespace ringlet
