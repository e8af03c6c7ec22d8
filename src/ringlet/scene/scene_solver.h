// Solves the linear system of a scene, A d = −gradient: by conjugate gradients on top of the parts' own factors, which solve at
// once what nothing couples; or by factoring the whole matrix.
#pragma once

#include "ringlet/linear/direct.h"
#include "ringlet/scene/scene_matrix.h"

#include <optional>
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

    // Assembles the system at x and factors what parts have for themselves. Throws a CoupledError where `banded` will not do.
    void prepare(SceneSystem &system, const AlignedVector &x, System how);
    Result solve(SceneSystem &system, double tolerance, AlignedVector &direction);

private:
    bool is_alone(const SceneSystem &system, int part) const { return !all_ && system.is_alone(part); } // P solves it
    void begin(SceneSystem &system, int unit);
    static bool solve_whole(const SceneMatrix &whole, AlignedVector &direction, Result &result);
    Result conjugate_gradient(SceneSystem &system, double tolerance, AlignedVector &direction);
    void take_solved(const SceneSystem &system, int unit, AlignedVector &direction) const;
    void search(const SceneSystem &system, int unit);
    void advance(SceneSystem &system, int unit, AlignedVector &direction);
    void precondition(const SceneSystem &system, int unit);

    bool all_ = false;                 // what is alone takes part as well, since the way to solve was asked for
    std::optional<SceneMatrix> whole_; // where it is factored: before its parts are in place
    AlignedVector residual_, solved_, searched_, image_;       // r, z, p, P p
    std::vector<double> products_, curvatures_, alpha_, beta_; // per part: r · z, p · P p
};

} // namespace ringlet
