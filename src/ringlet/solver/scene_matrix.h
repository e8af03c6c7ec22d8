// The whole matrix of a scene, for a direct solver: a block row for every vertex of strands and cloths.
#pragma once

#include "ringlet/linear/sparse_matrix.h"
#include "ringlet/solver/scene_system.h"

namespace ringlet {

class SceneMatrix {
public:
    // Takes the numbers of an assembled system whose P is not factored yet.
    explicit SceneMatrix(const SceneSystem &system);

    int size() const { return rows() * block_; }
    std::shared_ptr<const SparsePattern> pattern() const;
    View<double> triplets() const { return values_; }

    std::vector<double> right_hand_side() const; // −gradient
    void set(View<double> solution, AlignedVector &direction) const;

private:
    int rows() const { return system_.vertices.moving_vertices(); }
    void add_strand(int strand);
    void add_cloth(int cloth);
    void add_contact(const Contact &contact, const Mat3 &hessian);
    double *add_block(int row, int column); // of zeros, row by row
    template <class Work> void for_unknowns(const Work &work) const;

    const SceneSystem &system_;
    int block_ = 3;
    std::vector<int> i_, j_;
    std::vector<double> values_;
};

} // namespace ringlet
