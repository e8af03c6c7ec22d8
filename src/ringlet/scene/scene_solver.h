// Solves the linear system of a scene, A d = −gradient. Strands that nothing couples are solved by their own factors; the rest
// by conjugate gradients, or by factoring the whole of their matrix.
#pragma once

#include "ringlet/linear/direct.h"
#include "ringlet/scene/scene_system.h"

#include <stdexcept>

namespace ringlet {

// How the linear system of a step is solved. Automatic: by what strands have for themselves where nothing couples them, else by
// conjugate gradients; to the tolerance of a step these took less time than factoring at any size that was measured.
enum class System { automatic, banded, conjugate_gradient, direct };

// Strands alone were to be solved, but something couples them.
struct CoupledError : std::invalid_argument {
    using std::invalid_argument::invalid_argument;
};

class SceneSolver {
public:
    struct Result {
        int iterations = 0;  // of conjugate gradients
        double residual = 0; // relative: in the norm of the preconditioner, or, solved directly, in that of the unknowns
    };

    // The system's gradient and A are assembled; P is factored here. Throws a CoupledError where `banded` will not do.
    Result solve(SceneSystem &system, System how, double tolerance, AlignedVector &direction);

private:
    void begin(SceneSystem &system, AlignedVector &direction);
    Result conjugate_gradient(SceneSystem &system, double tolerance, AlignedVector &direction);

    bool takes_part(const SceneSystem &system, int unit) const { return all_ || system.is_coupled(unit); }

    bool all_ = false; // what nothing couples takes part as well, since the way to solve was asked for
    AlignedVector residual_, solved_, searched_, image_, product_;
};

} // namespace ringlet
