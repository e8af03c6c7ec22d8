#include "ringlet/solver/scene_matrix.h"

namespace ringlet {
namespace {

int freedoms(const SceneSystem &system) { return system.group_count() > 0 ? system.strands.system(0).dofs() : 3; }

} // namespace

SceneMatrix::SceneMatrix(const SceneSystem &system) : system_(system), block_(freedoms(system)) {
    for (int s = 0; s < system.vertices.strands; ++s) add_strand(s);
    for (int c = 0; c < int(system.cloths.size()); ++c) add_cloth(c);
    const std::vector<Contact> &contacts = system.contacts.contacts();
    for (int c = 0; c < int(contacts.size()); ++c) add_contact(contacts[c], system.values()[c].hessian);
}

double *SceneMatrix::add_block(int row, int column) {
    i_.push_back(row);
    j_.push_back(column);
    values_.resize(values_.size() + size_t(block_) * block_, 0.0);
    return values_.data() + values_.size() - size_t(block_) * block_;
}

void SceneMatrix::add_strand(int strand) {
    const int first = system_.model.offsets[strand], count = system_.model.offsets[strand + 1] - first;
    const StrandGroupSystem &system = system_.strands.system(system_.strands.group_of(strand));
    const int lane = system_.strands.lane_of(strand), reach = (system.layout.band - 1) / block_;
    for (int b = 0; b < count; ++b)
        for (int a = b; a < std::min(count, b + reach + 1); ++a) {
            double *block = add_block(first + a, first + b);
            for (int r = 0; r < block_; ++r)
                for (int c = 0; c < block_; ++c) { // of the diagonal block only one half is stored
                    const int column = b * block_ + (a == b ? std::min(r, c) : c);
                    const int below = a * block_ + (a == b ? std::max(r, c) : r) - column;
                    if (below < system.layout.rows(column))
                        block[r * block_ + c] = system.matrix[(system.layout.begin(column) + below) * system.lanes + lane];
                }
        }
}

// What a vertex has no use for is the unit matrix.
void SceneMatrix::add_cloth(int cloth) {
    const BlockMatrix &matrix = system_.cloths[cloth].matrix;
    const int first = system_.vertices.cloths[cloth];
    for (int row = 0; row < matrix.rows(); ++row)
        for (int slot = matrix.diagonal(row); slot < matrix.row_end(row); ++slot) {
            double *block = add_block(first + row, first + matrix.column(slot));
            for (int r = 0; r < 3; ++r)
                for (int c = 0; c < 3; ++c) block[r * block_ + c] = matrix.block(slot)(r, c);
            for (int k = 3; k < block_ && matrix.column(slot) == row; ++k) block[k * block_ + k] = 1.0;
        }
}

// What it does from side to side; the rest is in the matrices of strands and cloths.
void SceneMatrix::add_contact(const Contact &c, const Mat3 &hessian) {
    const auto &moves = system_.vertices.mesh.moves;
    for (int i = 0; i < c.first; ++i)
        for (int j = c.first; j < 4; ++j) {
            if (!moves[c.vertex[i]] || !moves[c.vertex[j]] || c.weight[i] * c.weight[j] == 0.0) continue;
            double *block = add_block(c.vertex[i], c.vertex[j]);
            for (int r = 0; r < 3; ++r)
                for (int k = 0; k < 3; ++k) block[r * block_ + k] = c.weight[i] * c.weight[j] * hessian(r, k);
        }
}

std::shared_ptr<const SparsePattern> SceneMatrix::pattern() const {
    return std::make_shared<const SparsePattern>(rows(), block_, i_, j_);
}

// work(its number in the matrix, its number in the scene, unit).
template <class Work> void SceneMatrix::for_unknowns(const Work &work) const {
    for (int v = 0; v < system_.vertices.moving_vertices(); ++v) {
        const int unit = system_.unit_of(system_.vertices.part_of(v));
        const int count = v < system_.vertices.strand_vertices() ? block_ : 3;
        for (int k = 0; k < count; ++k) work(v * block_ + k, system_.slot(v) + k * system_.stride(v), unit);
    }
}

std::vector<double> SceneMatrix::right_hand_side() const {
    std::vector<double> b(size(), 0.0);
    for_unknowns([&](int row, size_t i, int unit) { b[row] = -system_.gradient(i, unit); });
    return b;
}

void SceneMatrix::set(View<double> solution, AlignedVector &direction) const {
    for_unknowns([&](int row, size_t i, int) { direction[i] = solution[row]; });
}

} // namespace ringlet
