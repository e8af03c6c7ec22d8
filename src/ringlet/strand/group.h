// Time step of a group of strands, one per SIMD lane: predict, minimise, accept.
// A group steps alone, or in phases where a solver outside couples it with others.
#pragma once

#include "ringlet/dynamics/time_integrator.h"
#include "ringlet/strand/damping.h"
#include "ringlet/strand/energy_limit.h"
#include "ringlet/strand/predictor.h"

namespace ringlet::RINGLET_SIMD {

// The step of a group in phases, whatever its objective.
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

template <class Objective> class Group final : public PhasedStep {
    using Matrix = typename Objective::Matrix;

public:
    Group(const StrandArrays &arrays, const StrandStep &step, StrandGroup group, void *memory)
        : group_(arrays, step, group, memory), integrator_(integrator_of_lanes()) {}

    void step(StrandReport *reports) {
        prepare();
        const NewtonResult<Pack> result = newton(objective_, memory_.x, {step_.newton, step_.tolerance}, memory_.newton);
        evaluate_elastic();
        for (int k = 0; k < gather_.strands(); ++k) {
            const StrandLane &strand = gather_.lane(k);
            reports[k] = accept(strand, {result.iterations[k], result.cuts[k], result.residual[k]});
            if (reports[k].unconverged > 0 && is_isolated(group_, strand)) limit_energy(group_, strand, reports[k]);
        }
    }

    StrandGroupSystem begin() override {
        prepare();
        const auto plain = [](Pack *values) { return reinterpret_cast<double *>(values); };
        return {plain(memory_.x), plain(memory_.newton.gradient), plain(memory_.newton.band), Matrix::layout, lanes, vertices_,
                Matrix::padding};
    }

    void energy(const Pack *x, double *energies) override { gather_.scatter(objective_.energy(x), energies); }
    void evaluate(const Pack *x, double *energies) override { gather_.scatter(objective_.evaluate(x), energies); }

    void assemble(const Pack *x) override {
        Matrix hessian = group_.matrix();
        objective_.relocate(x);
        objective_.assemble(memory_.newton.gradient, hessian);
    }

    void factor() override { group_.matrix().factor(); }
    void solve(Pack *b) override { group_.matrix().solve(b); }

    void max_step(const Pack *x, const Pack *direction, double *steps) const override {
        gather_.scatter(objective_.max_step(x, direction), steps);
    }
    void curved_end(const Pack *x, const Pack *direction, Pack *to) const override {
        objective_.curved_path(x, constant<Pack>(1.0), direction, to);
    }

    void end(const Pack *x, const StrandEffort &effort, StrandReport *reports) override {
        for (int i = 0; i < objective_.size(); ++i) memory_.x[i] = x[i];
        evaluate_elastic();
        for (int k = 0; k < gather_.strands(); ++k) reports[k] = accept(gather_.lane(k), effort);
    }

private:
    // BDF-2 where the last step was one of BDF-2 with the same dt, else backward Euler.
    TimeIntegrator<Pack> integrator_of_lanes() const {
        Pack lag{};
        for (int k = 0; k < lanes; ++k) {
            const bool has_last = arrays_.last_dt[gather_.lane(k).strand] == step_.dt;
            set_lane(lag, k, step_.integrator == Integrator::bdf2 && has_last ? bdf2_lag : backward_euler_lag);
        }
        return TimeIntegrator<Pack>::of_step(step_.dt, lag);
    }

    // Sets up the objective of the step and its initial guess.
    void prepare() {
        const RootMotion<Pack> root(memory_.start, memory_.target, memory_.rows[2].free == 0.0);
        set_damping();
        for (int i = 0; i < vertices_; ++i) {
            Reference<Pack> &reference = memory_.rows[i].reference;
            reference.normal = root.rotate(reference.normal);
            reference.tangent = root.rotate(reference.tangent);
        }
        set_inertia();
        predict(group_, root);
    }

    void set_damping() {
        for (int i = 0; i + 1 < vertices_; ++i) {
            StrandRow<Pack> &row = memory_.rows[i];
            const Pack b = row.damping / integrator_.h;
            const Strains<Pack> extrapolated = extrapolate_strains(i);
            if (i > 0) objective_.damp(i, b, extrapolated);
            add_damping(row, b, extrapolated.length());
        }
    }

    // Also keeps the present strains for the next step of BDF-2.
    Strains<Pack> extrapolate_strains(int i) {
        Strains<Pack> now = objective_.strains(i);
        if (step_.integrator == Integrator::backward_euler) return now;
        Strains<Pack> last = now;
        for (int k = 0; k < gather_.strands(); ++k) {
            const StrandLane &strand = gather_.lane(k);
            if (!strand.has_edge(i)) continue;
            double *kept = arrays_.last_strains + Strains<Pack>::count * strand.row(i);
            for (int s = 0; s < Strains<Pack>::count; ++s) {
                if (integrator_.lag[k] > 0) set_lane(last[s], k, kept[s]);
                kept[s] = now[s][k];
            }
        }
        for (int s = 0; s < 3; ++s) now[s] = integrator_.extrapolate(now[s], last[s]);
        now[3] = integrator_.extrapolate_angle(now.twist(), last.twist());
        return now;
    }

    void set_inertia() {
        const bool has_last = any(integrator_.lag > 0.0);
        for (int i = 0; i < vertices_; ++i) {
            StrandRow<Pack> &row = memory_.rows[i];
            Vec<Pack> position = memory_.start[i], velocity = memory_.velocity[i];
            if (has_last) {
                position = integrator_.extrapolate(position, gather_.vector(arrays_.last_positions, i));
                velocity = integrator_.extrapolate(velocity, gather_.vector(arrays_.last_velocities, i));
            }
            const Vec<Pack> force = gather_.vector(arrays_.forces, i);
            const Inertia<Pack> inertia = integrator_.inertia(gather_.scalar(arrays_.mass, i, 0.0), arrays_.mass_damping,
                                                              gather_.scalar(arrays_.drag, i, 0.0));
            row.inertia = inertia.stiffness;
            for (int k = 0; k < 3; ++k)
                row.inertia_target[k] = inertia.target(position[k], velocity[k], step_.gravity[k], step_.wind[k], force[k]);
        }
    }

    // Shapes at the end of the step, and stiffnesses without damping.
    void evaluate_elastic() {
        objective_.evaluate(memory_.x);
        for (int i = 0; i + 1 < vertices_; ++i) remove_damping(memory_.rows[i]);
    }

    // Writes one strand's state back. A strand whose positions are not finite keeps its last state, at rest.
    StrandReport accept(const StrandLane &strand, const StrandEffort &effort) {
        StrandReport report = report_of(effort, step_.tolerance);
        if (!is_finite(strand)) {
            report.nan = 1;
            for (int i = 3 * strand.first; i < 3 * (strand.first + strand.vertices); ++i) arrays_.velocities[i] = 0;
            arrays_.last_dt[strand.strand] = 0;
            return report;
        }
        scatter_motion(strand);
        for (int i = 1; strand.has_edge(i); ++i) {
            group_.scatter_normal(strand, i);
            if (!Objective::has_frames && strand.has_hinge(i))
                arrays_.twist[strand.row(i)] = memory_.shapes[i].delta[strand.index];
        }
        add_motion(group_, strand, report);
        add_elastic(group_, strand, report);
        return report;
    }

    double coordinate(const StrandLane &strand, int i, int k) const { return memory_.x[Objective::dofs * i + k][strand.index]; }

    bool is_finite(const StrandLane &strand) const {
        double sum = 0;
        for (int i = 0; i < strand.vertices; ++i)
            for (int k = 0; k < 3; ++k) sum += coordinate(strand, i, k);
        return sum - sum == 0;
    }

    // A coupled step may have ended before its time: dt is read anew.
    void scatter_motion(const StrandLane &strand) {
        const bool bdf2 = step_.integrator == Integrator::bdf2;
        const auto integrator = TimeIntegrator<double>::of_step(step_.dt, integrator_.lag[strand.index]);
        arrays_.last_dt[strand.strand] = bdf2 ? step_.dt : 0.0;
        for (int i = 0; i < strand.vertices; ++i)
            for (int k = 0; k < 3; ++k) {
                const int at = 3 * strand.row(i) + k;
                double &position = arrays_.positions[at], &velocity = arrays_.velocities[at];
                const double end = coordinate(strand, i, k);
                const double rate = integrator.rate(end, integrator.extrapolate(position, arrays_.last_positions[at]));
                if (bdf2) {
                    arrays_.last_positions[at] = position;
                    arrays_.last_velocities[at] = velocity;
                }
                position = end;
                velocity = rate;
            }
    }

    GatheredGroup<Objective> group_;
    const StrandArrays &arrays_ = group_.arrays;
    const StrandStep &step_ = group_.step;
    const LaneGather &gather_ = group_.gather;
    const int vertices_ = group_.vertices;
    GroupMemory<Objective> &memory_ = group_.memory;
    Objective &objective_ = group_.objective;
    TimeIntegrator<Pack> integrator_;
};

} // namespace ringlet::RINGLET_SIMD
