// The part of preconditioned conjugate gradients that belongs to one block.
#pragma once

#include "ringlet/solver/objective.h"

#include <memory>
#include <vector>

namespace ringlet {

// What the iterations of all blocks share: numbers of objects, and p at the coupled points.
struct IterationState {
    std::vector<double> rz, pPp, alpha, beta; // per object: r · z, p · P p, step lengths
    std::vector<Vec3> p;                      // per point of the couplings

    void resize(int objects, int points);
};

// One block's share of an iteration on (P + C) d = b, with P as the preconditioner.
class BlockIteration {
public:
    virtual ~BlockIteration() = default;

    virtual void start() = 0;                  // factors P; r = b, z = P⁻¹ r, r · z
    virtual void first_iterate(double *d) = 0; // d and p: P⁻¹ b where P is exact, else 0
    virtual void search() = 0;                 // p = z + β p, and p · P p
    virtual void advance(double *d) = 0;       // d += α p, r −= α (P + C) p, z = P⁻¹ r, r · z
    virtual void finish(double *d) = 0;

    // The iteration that suits a block: of exact ones, everything but d stays at the coupled points.
    static std::unique_ptr<BlockIteration> make(Objective &objective, int block, IterationState &state);
};

} // namespace ringlet
