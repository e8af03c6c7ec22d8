// The coarse space of the two-level preconditioner: the joint motions of neighbouring strands.
//
// P answers for each side of a contact as if the other stood still, so P⁻¹ is wrong by most in joint motions. The
// coarse space has what each strand would do if those that it touches moved: with Ψ a smooth motion of an object and D what
// contacts do within its side, its columns are Z = P⁻¹ D Ψ. E = Zᵀ (P + C) Z is sparse: it couples objects that touch.
#pragma once

#include "ringlet/linear/block_cholesky.h"
#include "ringlet/math/lists.h"
#include "ringlet/solver/objective.h"

#include <vector>

namespace ringlet {

class CoarseSpace {
public:
    static constexpr int shapes = 2; // of motion along an object: t and t², t being 0 at its first vertex and 1 at its last
    static constexpr int columns = 3 * shapes; // each in three directions
    using Columns = Eigen::Matrix<double, 3, columns>;
    using Coefficients = Eigen::Matrix<double, columns, 1>;
    using Factor = BlockCholesky<columns>;

    explicit CoarseSpace(const Objective &objective) : objective_(objective) {}

    void clear();

    // Begins anew with the contacts' Hessians: forces D Ψ at the points of exact blocks.
    void find_forces();
    // Z of a block that is factored.
    void find_responses(int block);
    // Factors E, cluster by cluster.
    void factor();

    bool has(int object) const { return aggregate_[object] >= 0; }
    bool covers(int cluster) const { return !in_cluster_.empty() && in_cluster_[cluster]; }
    bool empty() const { return aggregates_ == 0; }

    // E⁻¹ Zᵀ r; r is given at the points by a function.
    template <class AtPoint> void find_coefficients(const AtPoint &r, LoopSite site = LoopSite::here()) {
        coefficients_.resize(aggregates_);
        parallel_for(
            aggregates_,
            [&](int a) {
                Coefficients sum = Coefficients::Zero();
                for (const int point : points_.of(a)) sum.noalias() += responses_[point].transpose() * r(point);
                coefficients_[a] = sum;
            },
            site);
        solve();
    }
    // z += Z E⁻¹ Zᵀ r at the points of a block, and P z likewise.
    void add_correction(int block, std::vector<Vec3> &z, std::vector<Vec3> &Pz) const {
        const Couplings &couplings = objective_.couplings;
        for (int point = couplings.begin(block); point < couplings.end(block); ++point) {
            const int a = aggregate_[couplings.object(point)];
            if (a < 0) continue;
            z[point] += responses_[point] * coefficients_[a];
            Pz[point] += forces_[point] * coefficients_[a];
        }
    }

private:
    struct Cluster {
        int first, end;   // its aggregates
        bool is_definite; // otherwise rounding has made its part of E indefinite, and it goes without
        Factor factor;
    };
    struct Row { // of E
        Factor::Block diagonal;
        std::vector<Factor::Entry> below; // left of the diagonal
    };
    void aggregate();
    Row row(int aggregate) const;
    void solve();
    Columns response_of_side(const Couplings::Coupling &coupling, int side) const;

    const Objective &objective_;
    int aggregates_ = 0;
    std::vector<int> aggregate_;            // per object; −1: it has no part
    std::vector<unsigned char> in_cluster_; // per cluster, by its first object: whether some of it has
    std::vector<Cluster> clusters_;
    Lists<int> points_;                                              // of each aggregate
    Lists<int> couplings_;                                           // of the aggregate with the larger number
    std::vector<std::array<std::array<double, shapes>, 2>> amounts_; // per coupling: of the shapes at the ends of its sides
    std::vector<Columns> forces_, responses_;                        // per point
    std::vector<Coefficients> coefficients_;                         // per aggregate
};

} // namespace ringlet
