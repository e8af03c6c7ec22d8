// Time step of a group of strands, one per SIMD lane: predict, minimise with Newton's method, accept.
#pragma once

#include "ringlet/strand/step_end.h"
#include "ringlet/strand/time_discretisation.h"

namespace ringlet::RINGLET_SIMD {

// Initial guess of Newton's method: of rest, the root's rigid motion and free flight the one with the least energy, in every
// lane. Held vertices are at their targets. Written to memory.x.
template <class Objective> void predict(GatheredGroup<Objective> &group, const RootMotion<Pack> &root) {
    GroupMemory<Objective> &memory = group.memory;
    Pack *best = memory.x, *trial = memory.newton.trial;
    const auto place = [&](Pack *x, const auto &predicted) {
        for (int i = 0; i < group.vertices; ++i)
            Objective::set_position(x, i, select<Pack>(memory.rows[i].free > 0.0, predicted(i), memory.target[i]));
        return group.objective.energy(x);
    };
    Pack least = place(best, [&](int i) { return memory.start[i]; });
    const auto improve = [&](const auto &predicted) {
        const Pack energy = place(trial, predicted);
        const auto better = energy < least;
        for (int i = 0; i < group.objective.size(); ++i) best[i] = select(better, trial[i], best[i]);
        least = select(better, energy, least);
    };
    improve([&](int i) { return root.apply(memory.start[i]); });
    improve([&](int i) { return memory.start[i] + constant<Pack>(group.step.dt) * memory.velocity[i]; });
}

template <class Objective> class Group final : public PhasedStep {
public:
    Group(const StrandArrays &arrays, const StrandStep &step, StrandGroup group, void *memory, void *scratch = nullptr)
        : strands_(arrays, step, group, memory, scratch), integrator_(integrator_of_lanes(strands_)) {}

    void step(StrandReport *reports) {
        prepare();
        const NewtonSettings settings{strands_.step.newton, strands_.step.tolerance};
        const NewtonResult<Pack> result = newton(strands_.objective, strands_.memory.x, settings, strands_.memory.newton);
        evaluate_end();
        for (int k = 0; k < strands_.gather.strands(); ++k) {
            const StrandLane &strand = strands_.gather.lane(k);
            reports[k] = accept(strand, {result.iterations[k], result.cuts[k], result.residual[k]});
            reports[k].stalled = result.stalled[k];
            if (reports[k].unconverged > 0 && is_isolated(strands_, strand)) limit_energy(strands_, strand, reports[k]);
        }
    }

    // Objective of the step and its initial guess. References follow the rigid motion of the root.
    void prepare() {
        GroupMemory<Objective> &memory = strands_.memory;
        const RootMotion<Pack> root(memory.start, memory.target, memory.rows[2].free == 0.0);
        add_damping(strands_, integrator_);
        for (int i = 0; i < strands_.vertices; ++i) {
            Reference<Pack> &reference = memory.rows[i].reference;
            reference.normal = root.rotate(reference.normal);
            reference.tangent = root.rotate(reference.tangent);
        }
        set_inertia(strands_, integrator_);
        predict(strands_, root);
    }

    // Shapes at memory.x, with stiffnesses for the report.
    void evaluate_end() {
        strands_.objective.evaluate(strands_.memory.x);
        remove_damping(strands_);
    }

    StrandReport accept(const StrandLane &strand, const StrandEffort &effort) {
        StrandReport report = report_of(effort, strands_.step.tolerance);
        if (!is_finite(strands_, strand)) {
            report.nan = 1;
            reject_step(strands_, strand);
            return report;
        }
        scatter_motion(strands_, strand, integrator_.lag[strand.index]);
        scatter_references(strands_, strand);
        add_motion(strands_, strand, report);
        add_elastic(strands_, strand, report);
        return report;
    }

    // Phases
    void use(void *scratch) override { strands_.use(scratch); }
    StrandGroupSystem begin() override {
        prepare();
        const auto plain = [](Pack *values) { return reinterpret_cast<double *>(values); };
        const GroupMemory<Objective> &memory = strands_.memory;
        return {.x = plain(memory.x),
                .gradient = plain(memory.newton.gradient),
                .matrix = plain(memory.newton.band),
                .layout = Matrix::layout,
                .lanes = lanes,
                .vertices = strands_.vertices,
                .padding = Matrix::padding};
    }
    void energy(const double *x, double *energies) override { scatter(strands_.objective.energy(packs(x)), energies); }
    void assemble(const double *x, double *energies) override {
        Matrix hessian = strands_.matrix();
        scatter(strands_.objective.evaluate(packs(x)), energies);
        strands_.objective.assemble(strands_.memory.newton.gradient, hessian, curved_);
    }
    void factor() override { strands_.matrix().factor(); }
    void solve(double *b) override { strands_.matrix().solve(packs(b)); }
    void max_step(const double *x, const double *direction, double *steps) const override {
        scatter(strands_.objective.max_step(packs(x), packs(direction)), steps);
    }
    void curved_end(const double *x, const double *direction, double *to) const override {
        strands_.objective.curved_path(packs(x), constant<Pack>(1.0), packs(direction), packs(to));
    }
    void end(const double *x, const StrandEffort &effort, StrandReport *reports) override {
        for (int i = 0; i < strands_.objective.size(); ++i) strands_.memory.x[i] = packs(x)[i];
        evaluate_end();
        for (int k = 0; k < strands_.gather.strands(); ++k) reports[k] = accept(strands_.gather.lane(k), effort);
    }

private:
    using Matrix = typename Objective::Matrix;

    static const Pack *packs(const double *values) { return reinterpret_cast<const Pack *>(values); }
    static Pack *packs(double *values) { return reinterpret_cast<Pack *>(values); }
    void scatter(Pack value, double *values) const { strands_.gather.scatter(value, values); }

    GatheredGroup<Objective> strands_;
    TimeIntegrator<Pack> integrator_;
    Pack curved_ = constant<Pack>(1.0); // 1 in lanes whose Hessian is that along curved paths
};

} // namespace ringlet::RINGLET_SIMD
