// Stepping a group of strands, one per lane. Built once per instruction set: plain pointers only (see cmake/Simd.cmake).
#include "ringlet/strand/frame_objective.h"
#include "ringlet/strand/hinge_objective.h"
#include "ringlet/strand/strand_group.h"

#include <new>

namespace ringlet::RINGLET_SIMD {
namespace {

int longest(const StrandArrays &arrays, StrandGroup group) {
    int most = 3;
    for (int k = 0; k < group.count; ++k) {
        const int count = arrays.offsets[group.strands[k] + 1] - arrays.offsets[group.strands[k]];
        most = count > most ? count : most;
    }
    return most;
}

// Calls work.operator()<Objective>() with the model that the step asks for.
template <class Work> auto with_objective(const StrandStep &step, const Work &work) {
    switch (step.continuation) {
    case Continuation::history: return work.template operator()<HingeObjective<Pack, true>>();
    case Continuation::least_energy: return work.template operator()<HingeObjective<Pack, false>>();
    default: return work.template operator()<FrameObjective<Pack>>();
    }
}

// Calls work(group) with the group made for the model that the step asks for.
template <class Work>
void with_group(const StrandArrays &arrays, const StrandStep &step, StrandGroup group, void *workspace, const Work &work) {
    with_objective(step, [&]<class Objective>() {
        Group<Objective> made(arrays, step, group, longest(arrays, group), workspace);
        work(made);
    });
}

// An open group stands at the beginning of its memory, its workspace behind it.
constexpr size_t group_room = 512;

OpenGroup &open_group(void *memory) { return *static_cast<OpenGroup *>(memory); }

} // namespace

int strand_lanes() { return lanes; }

size_t strand_workspace(int vertices) {
    const size_t hinge = Workspace<HingeObjective<Pack, true>>::bytes(vertices),
                 frame = Workspace<FrameObjective<Pack>>::bytes(vertices);
    return hinge > frame ? hinge : frame;
}

void step_strand_group(const StrandArrays &arrays, const StrandStep &step, StrandGroup group, void *workspace,
                       StrandReport *reports) {
    with_group(arrays, step, group, workspace, [&](auto &made) { made.step(reports); });
}

void relax_strand_frames(const StrandArrays &arrays, StrandGroup group, void *workspace, double *energies) {
    StrandStep step;
    step.continuation = Continuation::material_frame;
    with_group(arrays, step, group, workspace, [&](auto &made) { made.relax_frames(energies); });
}

size_t strand_group_bytes(const StrandStep &step, int vertices) {
    return group_room +
           with_objective(step, [&]<class Objective>() { return Workspace<Objective>::bytes(vertices < 3 ? 3 : vertices); });
}

StrandGroupSystem begin_strand_group(const StrandArrays &arrays, const StrandStep &step, StrandGroup group, void *memory) {
    return with_objective(step, [&]<class Objective>() {
        static_assert(sizeof(Group<Objective>) <= group_room);
        char *workspace = static_cast<char *>(memory) + group_room;
        return (new (memory) Group<Objective>(arrays, step, group, longest(arrays, group), workspace))->begin();
    });
}

void strand_group_energies(void *memory, const double *x, double *energies) {
    open_group(memory).energy(reinterpret_cast<const Pack *>(x), energies);
}
void evaluate_strand_group(void *memory, const double *x, double *energies) {
    open_group(memory).evaluate(reinterpret_cast<const Pack *>(x), energies);
}
void assemble_strand_group(void *memory, const double *x) { open_group(memory).assemble(reinterpret_cast<const Pack *>(x)); }
void factor_strand_group(void *memory) { open_group(memory).factor(); }
void solve_strand_group(void *memory, double *b) { open_group(memory).solve(reinterpret_cast<Pack *>(b)); }

void strand_group_worth_going(void *memory, const double *x, const double *direction, double *parts) {
    open_group(memory).worth_going(reinterpret_cast<const Pack *>(x), reinterpret_cast<const Pack *>(direction), parts);
}
void turn_strand_group(void *memory, const double *x, const double *direction, double *to) {
    open_group(memory).turn(reinterpret_cast<const Pack *>(x), reinterpret_cast<const Pack *>(direction),
                            reinterpret_cast<Pack *>(to));
}

void end_strand_group(void *memory, const double *x, const StrandEffort &effort, StrandReport *reports) {
    open_group(memory).end(reinterpret_cast<const Pack *>(x), effort, reports);
    open_group(memory).~OpenGroup();
}

double strand_group_energy(const StrandArrays &arrays, const StrandStep &step, int strand, const double *positions,
                           void *workspace, double *gradient, double *hessian) {
    double energy = 0;
    with_group(arrays, step, {&strand, 1}, workspace, [&](auto &made) { energy = made.energy(positions, gradient, hessian); });
    return energy;
}

} // namespace ringlet::RINGLET_SIMD
