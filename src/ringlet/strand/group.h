// Time step of a group of strands, one per SIMD lane: predict, minimise with Newton's method, accept.
#pragma once

#include "ringlet/strand/damping.h"
#include "ringlet/strand/energy_limit.h"
#include "ringlet/strand/inertia.h"
#include "ringlet/strand/predictor.h"
#include "ringlet/strand/state_update.h"

namespace ringlet::RINGLET_SIMD {

template <class Objective> class Group {
public:
    Group(const StrandArrays &arrays, const StrandStep &step, StrandGroup group, void *memory)
        : strands_(arrays, step, group, memory), integrator_(integrator_of_lanes(strands_)) {}

    GatheredGroup<Objective> &strands() { return strands_; }

    void step(StrandReport *reports) {
        begin();
        const NewtonSettings settings{strands_.step.newton, strands_.step.tolerance};
        const NewtonResult<Pack> result = newton(strands_.objective, strands_.memory.x, settings, strands_.memory.newton);
        evaluate_end();
        for (int k = 0; k < strands_.gather.strands(); ++k) {
            const StrandLane &strand = strands_.gather.lane(k);
            reports[k] = accept(strand, {result.iterations[k], result.cuts[k], result.residual[k]});
            if (reports[k].unconverged > 0 && is_isolated(strands_, strand)) limit_energy(strands_, strand, reports[k]);
        }
    }

    // Objective of the step and its initial guess. References follow the rigid motion of the root.
    void begin() {
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

private:
    GatheredGroup<Objective> strands_;
    TimeIntegrator<Pack> integrator_;
};

} // namespace ringlet::RINGLET_SIMD
