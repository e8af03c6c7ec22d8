// The system (P + C) d = b at its points, for conjugate gradients (linear/conjugate_gradient.h). P, the blocks, is the
// preconditioner, with the coarse space.
#pragma once

#include "ringlet/solver/coarse_space.h"
#include "ringlet/solver/objective.h"

#include <vector>

namespace ringlet {

// Where P is exact, the first iterate P⁻¹ b leaves the residual −C d, which is zero but at the coupled vertices, and so it
// stays. What follows needs to be known there alone, with its forces: P z = r, and what is a sum of z has the same sum of r. At
// the end a solve turns forces into d. Where P has only an incomplete factor, all vertices are points, and P p is formed.
class CoupledSystem {
public:
    using Numbers = std::vector<double>;     // of objects; those of a cluster stand at its first object
    using Mask = std::vector<unsigned char>; // objects
    struct Unknowns {
        std::vector<Vec3> at, force; // at the points: d, and P d
    };
    using Residual = std::vector<Vec3>; // at the points

    explicit CoupledSystem(Objective &objective);

    // Begins anew with the contacts' Hessians; then begin_block() for each block that is assembled, factor_coarse() in the end.
    void begin();
    void begin_block(int block);
    void factor_coarse() { coarse_.factor(); }

    // The first iterate: P⁻¹ b of exact blocks, corrected by the coarse space. Sets the residual that it leaves, and what is to
    // be added to P⁻¹ b.
    void first_iterate(Residual &r, Unknowns &x);
    void solution(const Unknowns &x, AlignedVector &d);

    size_t clusters() const { return size_t(objective_.table.objects); }
    Numbers extend(const Unknowns &z, const Numbers &beta, Unknowns &p, Residual &Ap, const Mask &busy);
    Numbers advance(const Numbers &alpha, const Unknowns &p, const Residual &Ap, Unknowns &x, Residual &r, Unknowns &z,
                    const Mask &busy);

    // Of objects: b · P⁻¹ b, and r · z of the last preconditioning.
    const Numbers &alone() const { return alone_products_; }
    const Numbers &products() const { return rz_; }
    Numbers work() const { return of_clusters(bd_); } // b · d of clusters, as x was last

    // Sums of those objects that their own factor does not solve.
    Numbers of_clusters(const Numbers &of_objects) const;
    const CoarseSpace &coarse() const { return coarse_; }

private:
    // The blocks with busy objects; for_blocks() calls work(block) for them.
    Mask blocks_with(const Mask &busy) const { return objective_.blocks.blocks_with(busy); }
    template <class Work>
    void for_blocks(const Mask &blocks, const Work &work, bool backwards = false, LoopSite site = LoopSite::here()) const;
    // Calls work(object, first point, their end) for the objects of a block that have points.
    template <class Work> void for_objects(int block, const Work &work) const;
    bool is_exact(int block) const { return objective_.blocks[block].is_exact(); }
    int cluster(int object) const { return objective_.couplings.clusters()[object]; }
    Vec3 at(int point, int block, const double *of_block) const;
    AlignedVector solve(int block, const std::vector<Vec3> &at_points) const;
    void precondition_block(int block, const Residual &r, Unknowns &z) const;
    double work_of(int block, int object, const Unknowns &x) const;

    Objective &objective_;
    CoarseSpace coarse_;
    AlignedVector alone_;                    // P⁻¹ b
    Numbers alone_products_, rz_, pAp_, bd_; // of objects
    std::vector<int> joint_;                 // objects that their own factor does not solve
    bool backwards_ = false;
};

} // namespace ringlet
