// A cloth as a block of a scene's system.
#pragma once

#include "ringlet/cloth/objective.h"
#include "ringlet/linear/incomplete_cholesky.h"
#include "ringlet/math/row.h"
#include "ringlet/solver/block.h"

namespace ringlet {

// What happened to a cloth in a step.
RINGLET_ROW(ClothReport,
            newton,                          // iterations used
            linear,                          // iterations of conjugate gradients, of all systems together
            cuts,                            // step lengths cut by the line search
            residual,                        // largest coordinate of the last search direction [m]
            linear_residual,                 // relative residual of the last linear system
            unconverged,                     // 1 where iterations ran out
            stretch, bend, gravity, kinetic, // energies at the end [J]
            max_stretch,                     // largest strain along warp or weft
            nan);                            // 1 where a position is not finite (the cloth then keeps its last state)

class ClothBlock final : public Block {
public:
    // `object` is its number in the scene, and `first` its first vertex.
    ClothBlock(const ClothModel &model, ClothState &state, int object, int first);

    const ClothModel &model() const { return model_; }
    ClothState &state() const { return state_; }
    ClothReport report{}; // of the last step

    void begin_step(const BlockStep &step) override;
    void initial_guess(double *x) const override; // advected or flying on, whichever has less energy
    void energies(const double *x, double *of_lanes) override;
    void assemble(const double *x, double *of_lanes) override;
    const double *gradient() const override { return gradient_.data()->data(); }
    void add_gradient(int vertex, const Vec3 &gradient) override { gradient_[vertex - first_] += gradient; }
    void add_block(int row, int column, const Mat3 &block) override;
    void add_to(MatrixAssembly &matrix) const override;
    void factor() override { factor_.factor(matrix_); }
    void solve(double *b) const override;
    bool is_exact() const override { return false; }
    void multiply_add(const double *p, double *q) const override;
    void contact_stiffness(double dt, std::vector<double> &of_vertices) const override;
    bool is_parallel() const override { return true; }
    bool commit(const double *x, double dt, const SolverEffort &effort) override;

private:
    View<Vec3> vectors(const double *x) const { return {reinterpret_cast<const Vec3 *>(x), size_t(model_.vertex_count())}; }

    const ClothModel &model_;
    ClothState &state_;
    int first_;
    ClothObjective objective_;
    double dt_ = 0.0;
    Vec3 gravity_ = Vec3::Zero();
    std::vector<double> elastic_; // stiffness of each vertex against contacts, besides inertia [N/m]
    std::vector<Vec3> gradient_;
    BlockMatrix matrix_;
    IncompleteCholesky factor_;
};

} // namespace ringlet
