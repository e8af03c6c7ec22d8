// A group of strands, one per SIMD lane, as a block of a scene's system.
#pragma once

#include "ringlet/math/aligned.h"
#include "ringlet/solver/block.h"
#include "ringlet/strand/state.h"

#include <memory>
#include <vector>

namespace ringlet {

class StrandBlock final : public Block {
public:
    // Of some strands of the model, the longest first. Their numbers and vertices are those of the scene.
    StrandBlock(const StrandModel &model, StrandState &state, std::vector<int> strands);

    // Continuation, integrator and safeguards of the steps to come; the rest of `step` is not read.
    void configure(const StrandStep &step) { step_ = step; }

    void begin_step(const BlockStep &step) override;
    void initial_guess(double *x) const override;
    void energies(const double *x, double *of_lanes) override;
    void assemble(const double *x, double *of_lanes) override;
    const double *gradient() const override { return system_.gradient; }
    void add_gradient(int vertex, const Vec3 &gradient) override;
    void add_block(int row, int column, const Mat3 &block) override;
    void add_to(MatrixAssembly &matrix) const override;
    void factor() override;
    void solve(double *b) const override;
    void max_step(const double *x, const double *direction, double *of_lanes) const override;
    void bend(const double *x, const double *straight, double *bend) const override;
    void contact_stiffness(double dt, std::vector<double> &of_vertices) const override;
    bool is_stretched(int lane, View<Vec3> positions) const override;
    double settled_distance(int lane) const override;
    bool commit(const double *x, double dt, const SolverEffort &effort) override;

    const std::vector<StrandReport> &reports() const { return reports_; } // of the last step, by lane

private:
    PhasedStep &phases() const; // for a phase that needs scratch memory
    int strand_of(int vertex) const;
    size_t slot(int vertex) const;

    const StrandModel &model_;
    StrandState &state_;
    std::vector<int> strands_;
    std::vector<double> mean_edge_; // per lane, at rest [m]
    StrandStep step_;
    StrandArrays arrays_;
    AlignedMemory memory_{0};
    size_t memory_bytes_ = 0, scratch_bytes_ = 0;
    PhasedStep *phases_ = nullptr; // in memory_
    StrandGroupSystem system_{};
    std::vector<StrandReport> reports_;
};

// All strands of a model in blocks: of like length together, and among these what stands close together, so that what touches
// shares blocks.
std::vector<std::unique_ptr<StrandBlock>> make_strand_blocks(const StrandModel &model, StrandState &state);

} // namespace ringlet
