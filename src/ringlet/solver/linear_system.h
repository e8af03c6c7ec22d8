// The linear system of a Newton step, (P + C) d = −gradient, P being the blocks and C their couplings: solved by conjugate
// gradients with the blocks' own factors as the preconditioner, or by factoring the whole matrix.
#pragma once

#include "ringlet/linear/direct.h"
#include "ringlet/solver/assembled_matrix.h"
#include "ringlet/solver/convergence_test.h"
#include "ringlet/solver/coupled_system.h"

#include <optional>
#include <stdexcept>

namespace ringlet {

// How the system is solved. Automatic: by the blocks' own factors where nothing couples them, else by conjugate gradients,
// which took less time than factoring at every size that was measured.
enum class System { automatic, banded, conjugate_gradient, direct };

// `banded` solves each strand alone, but something couples them.
struct CoupledError : std::invalid_argument {
    using std::invalid_argument::invalid_argument;
};

struct LinearSettings {
    System system = System::automatic;
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

    // Assembles gradient and Hessian at x and factors the blocks. Throws a CoupledError where `banded` will not do.
    void assemble(const AlignedVector &x, const LinearSettings &settings);
    Result solve(const LinearSettings &settings, AlignedVector &direction);

private:
    System method(System wanted) const;
    static bool solve_whole(const AssembledMatrix &whole, AlignedVector &direction, Result &result);
    Result conjugate_gradient(const LinearSettings &settings, AlignedVector &direction);

    Objective &objective_;
    CoupledSystem coupled_;
    std::vector<int> inexact_;             // objects
    std::optional<AssembledMatrix> whole_; // to be factored directly
};

} // namespace ringlet
