// A cloth in the middle of a step, for a solver that couples it with what it touches. Its part of a vector of unknowns is three
// coordinates a vertex.
#pragma once

#include "ringlet/cloth/cloth_step.h"
#include "ringlet/linear/incomplete_cholesky.h"

namespace ringlet {

class CoupledCloth {
public:
    CoupledCloth(const ClothModel &model, ClothState &state);

    size_t size() const { return 3 * size_t(model_->vertex_count()); } // of its part of a vector, in doubles
    const ClothModel &model() const { return *model_; }
    ClothState &state() const { return *state_; }

    // How hard its vertices resist being pushed in a step [N/m].
    double stiffness(int vertex, double dt) const { return model_->mass[vertex] / (dt * dt) + elastic_[vertex]; }

    // Opens a step. What is given must live until end().
    void begin(const ClothForces &forces);
    // Where Newton's method begins: at x, or where the cloth would fly, whichever has less energy.
    void guess(double *x) const;
    void end(const double *x, ClothReport &report);

    double energy(const double *x) const;

    // The gradient and the matrix at x, to which others may add; factored before it preconditions.
    void assemble(const double *x);
    std::vector<Vec3> gradient;
    BlockMatrix matrix;
    void factor() { factor_.factor(matrix); }
    void precondition(double *b) const;                  // b becomes about A⁻¹ b
    void multiply_add(const double *p, double *q) const; // q += A p

private:
    View<Vec3> vectors(const double *x) const { return {reinterpret_cast<const Vec3 *>(x), size_t(model_->vertex_count())}; }

    const ClothModel *model_;
    ClothState *state_;
    ClothObjective objective_;
    ClothForces forces_;
    std::vector<double> elastic_; // [N/m]
    IncompleteCholesky factor_;
};

} // namespace ringlet
