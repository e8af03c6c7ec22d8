// The part of preconditioned conjugate gradients that belongs to one block.
#pragma once

#include "ringlet/solver/coarse_space.h"
#include "ringlet/solver/objective.h"

#include <memory>
#include <vector>

namespace ringlet {

// What the iterations of all blocks share: numbers of objects, and vectors at the coupled points.
struct IterationState {
    std::vector<double> rz, pPp, alpha, beta; // per object: r · z, p · P p, step lengths
    std::vector<double> bd;                   // per object: b · d
    std::vector<Vec3> p, z;                   // per point of the couplings

    void resize(int objects, int points);
};

// One block's share of an iteration on (P + C) d = b. P is the preconditioner, with the coarse space where that has a part of
// the block.
class BlockIteration {
public:
    virtual ~BlockIteration() = default;

    virtual void start() = 0; // factors P; r = b, z = P⁻¹ r, r · z

    virtual void first_iterate(double *d) = 0; // d and p: P⁻¹ b where P is exact, else 0
    virtual void search() = 0;                 // p = z + β p, and p · P p
    virtual void advance(double *d) = 0;       // d += α p, r −= α (P + C) p
    virtual void precondition() = 0;           // z = P⁻¹ r, r · z
    virtual void measure(const double *d) = 0; // b · d
    virtual void finish(double *d) = 0;

    // The coarse space's part, after the coarse space has computed its coefficients.
    virtual Vec3 residual(int point) const = 0; // r there
    virtual void correct() = 0;                 // p becomes the motion of the coarse space
    virtual void deflate() = 0;                 // z += that motion, r · z

    // The iteration that suits a block: of exact ones, everything but d stays at the coupled points.
    static std::unique_ptr<BlockIteration> make(Objective &objective, int block, IterationState &state,
                                                const CoarseSpace &coarse);
};

} // namespace ringlet
