// Kernels of strand groups. Built once per instruction set: plain pointers only (see cmake/Simd.cmake).
#include "ringlet/strand/kernel.h"

#include "ringlet/strand/elastic_energy.h"
#include "ringlet/strand/group.h"
#include "ringlet/strand/hinge/objective.h"
#include "ringlet/strand/rod_objective.h"

#include <new>
#include <type_traits>

namespace ringlet::RINGLET_SIMD {
namespace {

using RodAtPlanes = RodObjective<Pack, PlaneRow<Pack>>;

// Calls work.operator()<Objective>() with the model of bend and twist that the step names.
template <class Work> auto with_objective(const StrandStep &step, const Work &work) {
    switch (step.continuation) {
    case Continuation::history: return work.template operator()<HingeObjective<Pack, true>>();
    case Continuation::least_energy: return work.template operator()<HingeObjective<Pack, false>>();
    default: return work.template operator()<RodObjective<Pack>>();
    }
}

// Calls work(group) with the gathered group.
template <class Work>
void with_gathered(const StrandArrays &arrays, const StrandStep &step, StrandGroup group, void *workspace, const Work &work) {
    with_objective(step, [&]<class Objective>() {
        GatheredGroup<Objective> gathered(arrays, step, group, workspace);
        work(gathered);
    });
}

// The group of a phased step stands at the beginning of its memory, in as many bytes; its arrays follow, aligned.
constexpr size_t group_bytes = 1024;

} // namespace

int strand_lanes() { return lanes; }

size_t strand_workspace_bytes(int vertices) {
    return max(GroupMemory<HingeObjective<Pack, true>>::bytes(vertices), GroupMemory<RodAtPlanes>::bytes(vertices));
}

void step_strand_group(const StrandArrays &arrays, const StrandStep &step, StrandGroup group, void *workspace,
                       StrandReport *reports) {
    if (arrays.planes.stiffness) return Group<RodAtPlanes>(arrays, step, group, workspace).step(reports);
    with_objective(step, [&]<class Objective>() { Group<Objective>(arrays, step, group, workspace).step(reports); });
}

void relax_strand_frames(const StrandArrays &arrays, StrandGroup group, void *workspace, double *energies) {
    StrandStep step;
    step.continuation = Continuation::material_frame;
    with_gathered(arrays, step, group, workspace, [&](auto &gathered) { keep_relaxed_frames(gathered, energies); });
}

double strand_elastic_energy(const StrandArrays &arrays, const StrandStep &step, int strand, const double *positions,
                             void *workspace, double *gradient, double *hessian) {
    double energy = 0;
    with_gathered(arrays, step, {&strand, 1}, workspace,
                  [&](auto &gathered) { energy = elastic_energy(gathered, positions, gradient, hessian); });
    return energy;
}

size_t phased_step_bytes(const StrandStep &step, int vertices) {
    return group_bytes +
           with_objective(step, [&]<class Objective>() { return GroupMemory<Objective>::kept_bytes(max(vertices, 3)); });
}

size_t phased_scratch_bytes(const StrandStep &step, int vertices) {
    return with_objective(step, [&]<class Objective>() { return GroupMemory<Objective>::scratch_bytes(max(vertices, 3)); });
}

PhasedStep *make_phased_step(const StrandArrays &arrays, const StrandStep &step, StrandGroup group, void *memory,
                             void *scratch) {
    return with_objective(step, [&]<class Objective>() -> PhasedStep * {
        static_assert(sizeof(Group<Objective>) <= group_bytes && std::is_trivially_destructible_v<Group<Objective>>);
        return new (memory) Group<Objective>(arrays, step, group, static_cast<char *>(memory) + group_bytes, scratch);
    });
}

} // namespace ringlet::RINGLET_SIMD
