// Step of a group in phases, for a solver outside that couples the group with others.
#pragma once

#include "ringlet/strand/group.h"

namespace ringlet::RINGLET_SIMD {

// The phases, whatever the objective (kernel.h documents each).
struct PhasedStep {
    virtual ~PhasedStep() = default;
    virtual StrandGroupSystem begin() = 0;
    virtual void energy(const Pack *x, double *energies) = 0;
    virtual void evaluate(const Pack *x, double *energies) = 0;
    virtual void assemble(const Pack *x) = 0;
    virtual void factor() = 0;
    virtual void solve(Pack *b) = 0;
    virtual void max_step(const Pack *x, const Pack *direction, double *steps) const = 0;
    virtual void curved_end(const Pack *x, const Pack *direction, Pack *to) const = 0;
    virtual void end(const Pack *x, const StrandEffort &effort, StrandReport *reports) = 0;
};

template <class Objective> class PhasedGroup final : public PhasedStep {
public:
    PhasedGroup(const StrandArrays &arrays, const StrandStep &step, StrandGroup group, void *memory)
        : group_(arrays, step, group, memory) {}

    StrandGroupSystem begin() override {
        using Matrix = typename Objective::Matrix;
        group_.begin();
        const GroupMemory<Objective> &memory = strands_.memory;
        const auto plain = [](Pack *values) { return reinterpret_cast<double *>(values); };
        return {
            plain(memory.x), plain(memory.newton.gradient), plain(memory.newton.band), Matrix::layout, lanes, strands_.vertices,
            Matrix::padding};
    }

    void energy(const Pack *x, double *energies) override { scatter(strands_.objective.energy(x), energies); }
    void evaluate(const Pack *x, double *energies) override { scatter(strands_.objective.evaluate(x), energies); }

    void assemble(const Pack *x) override {
        auto hessian = strands_.matrix();
        strands_.objective.relocate(x);
        strands_.objective.assemble(strands_.memory.newton.gradient, hessian);
    }

    void factor() override { strands_.matrix().factor(); }
    void solve(Pack *b) override { strands_.matrix().solve(b); }

    void max_step(const Pack *x, const Pack *direction, double *steps) const override {
        scatter(strands_.objective.max_step(x, direction), steps);
    }
    void curved_end(const Pack *x, const Pack *direction, Pack *to) const override {
        strands_.objective.curved_path(x, constant<Pack>(1.0), direction, to);
    }

    void end(const Pack *x, const StrandEffort &effort, StrandReport *reports) override {
        for (int i = 0; i < strands_.objective.size(); ++i) strands_.memory.x[i] = x[i];
        group_.evaluate_end();
        for (int k = 0; k < strands_.gather.strands(); ++k) reports[k] = group_.accept(strands_.gather.lane(k), effort);
    }

private:
    void scatter(Pack value, double *values) const { strands_.gather.scatter(value, values); }

    Group<Objective> group_;
    GatheredGroup<Objective> &strands_ = group_.strands();
};

} // namespace ringlet::RINGLET_SIMD
