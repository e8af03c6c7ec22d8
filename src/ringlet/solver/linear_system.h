// The linear system of a Newton step, (P + C) d = −gradient, P being the blocks and C their couplings: solved by conjugate
// gradients with the blocks' own factors as the preconditioner, or by factoring the whole matrix.
#pragma once

#include "ringlet/linear/direct.h"
#include "ringlet/solver/coupled_system.h"
#include "ringlet/solver/settings.h"

#include <memory>
#include <optional>
#include <stdexcept>

namespace ringlet {

// The whole Hessian of an objective, for a direct solver: a block row for every dynamic vertex.
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

// How the system is solved. Conjugate gradients need no iteration where nothing couples the blocks, and took less time than
// factoring at every size that was measured.
enum class System { conjugate_gradient, direct };

// The whole matrix has no factor in double precision.
struct FactorisationError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct LinearSettings {
    System system = System::conjugate_gradient;
    double tolerance = 0.4;                                      // of the error, relative, in the norm of energy
    int max_iterations = solver_settings::max_linear_iterations; // of conjugate gradients
};

class LinearSystem {
public:
    struct Result {
        int iterations = 0;  // of conjugate gradients
        double residual = 0; // relative; solved directly, in the norm of the unknowns
    };

    explicit LinearSystem(Objective &objective);

    // Assembles gradient and Hessian at x.
    void assemble(const AlignedVector &x, const LinearSettings &settings);
    // Throws a FactorisationError where a direct solver fails.
    Result solve(const LinearSettings &settings, AlignedVector &direction);

private:
    static Result factor(const AssembledMatrix &whole, AlignedVector &direction);
    Result conjugate_gradient(const LinearSettings &settings, AlignedVector &direction);

    Objective &objective_;
    CoupledSystem coupled_;
    std::vector<int> inexact_;             // objects
    std::optional<AssembledMatrix> whole_; // to be factored directly
};

} // namespace ringlet
