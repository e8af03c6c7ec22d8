#include "ringlet/strand/step.h"

#include "ringlet/strand/lane_groups.h"

#include <stdexcept>

namespace ringlet {

void step_strands(const StrandModel &model, StrandState &state, View<Vec3> targets, View<Vec3> forces, const StrandStep &step,
                  std::vector<StrandReport> &reports) {
    if (int(targets.size()) != model.vertex_count() || int(forces.size()) != model.vertex_count())
        throw std::invalid_argument("strands: targets and forces do not fit the model");
    reports.assign(model.strand_count(), StrandReport{});
    const StrandArrays arrays = arrays_of(model, state, targets, forces);
    for_each_group(model, [&](StrandGroup group, void *workspace) {
        StrandReport group_reports[max_lanes];
        RINGLET_DISPATCH(step_strand_group, arrays, step, group, workspace, group_reports);
        for (int k = 0; k < group.count; ++k) reports[group.strands[k]] = group_reports[k];
    });
}

double strand_energy(const StrandModel &model, const StrandState &state, Continuation continuation, View<Vec3> positions,
                     std::vector<Vec3> &gradient, std::vector<double> *hessian) {
    if (int(positions.size()) != model.vertex_count()) throw std::invalid_argument("strands: positions do not fit the model");
    StrandState copy = state;
    const StrandArrays arrays = arrays_of(model, copy, positions, positions); // no force is read
    const AlignedMemory workspace(RINGLET_DISPATCH(strand_workspace_bytes, longest_strand(model)));
    gradient.assign(positions.size(), Vec3::Zero());
    if (hessian) {
        if (model.strand_count() != 1) throw std::invalid_argument("strands: the Hessian is given for one strand at a time");
        const size_t unknowns = (continuation == Continuation::material_frame ? 4 : 3) * positions.size();
        hessian->assign(unknowns * unknowns, 0.0);
    }
    StrandStep step;
    step.continuation = continuation;
    double energy = 0;
    for (int s = 0; s < model.strand_count(); ++s)
        energy += RINGLET_DISPATCH(strand_elastic_energy, arrays, step, s, positions.data()->data(), workspace.get(),
                                   gradient[model.offsets[s]].data(), hessian ? hessian->data() : nullptr);
    return energy;
}

} // namespace ringlet
