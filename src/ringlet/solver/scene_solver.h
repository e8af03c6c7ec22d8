// Solves the linear system of a scene, A d = −gradient: by conjugate gradients on top of the parts' own factors, which solve at
// once what nothing couples; or by factoring the whole matrix.
#pragma once

#include "ringlet/linear/direct.h"
#include "ringlet/solver/scene_matrix.h"

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
    struct OfCloth { // of its unknowns
        std::vector<double> r, z, p, Ap;
    };

    void begin(SceneSystem &system, int unit);
    static bool solve_whole(const SceneMatrix &whole, AlignedVector &direction, Result &result);
    Result conjugate_gradient(SceneSystem &system, double tolerance, AlignedVector &direction);
    void set_out(SceneSystem &system, AlignedVector &direction);
    void search(const SceneSystem &system, int unit);
    void advance(const SceneSystem &system, int unit, AlignedVector &direction);
    void arrive(const SceneSystem &system, int unit, AlignedVector &direction) const;
    static AlignedVector response(const SceneSystem &system, int group, const std::vector<Vec3> &at_points);

    std::optional<SceneMatrix> whole_;         // where it is factored: before its parts are in place
    AlignedVector alone_;                      // of strands: P⁻¹ b
    std::vector<Vec3> r_, z_, p_, Pp_, borne_; // at the points that are coupled; of cloths, p alone
    std::vector<OfCloth> cloths_;
    std::vector<double> products_, curvatures_, alpha_, beta_; // per part: r · z, p · P p
};

} // namespace ringlet
