#include "ringlet/strand/state.h"

#include "ringlet/geometry/frames.h"
#include "ringlet/rest/rest_shape.h"
#include "ringlet/rest/stability.h"
#include "ringlet/strand/lane_groups.h"
#include "ringlet/strand/settings.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace ringlet {
namespace {

// Directors whose twist is the groom's alone: the first is the root's normal, the others follow by parallel transport.
void set_untwisted_directors(const StrandModel &model, View<Vec3> positions, const RestShape &now, StrandState &state) {
    for (int s = 0; s < model.strand_count(); ++s) {
        const int first = model.offsets[s], end = model.offsets[s + 1];
        const auto tangent = [&](int i) -> Vec3 { return (positions[i + 1] - positions[i]).normalized(); };
        const bool bent =
            model.rest_angle[first + 1] > strand_settings::bent_angle && now.angle[first + 1] > strand_settings::bent_angle;
        state.directors[first + 1] =
            bent ? now.normal[first + 1]
                 : transport(model.rest_normal[first + 1], model.rest_tangent[first + 1], tangent(first + 1));
        for (int i = first + 1; i + 2 < end; ++i) {
            const Vec3 twisted = Eigen::AngleAxisd(model.rest_dihedral[i], tangent(i)) * state.directors[i];
            state.directors[i + 1] = transport(twisted, tangent(i), tangent(i + 1));
        }
    }
}

// Relaxes the material frames from their directors; returns the elastic energy of each strand [J].
std::vector<double> relax_frames(const StrandModel &model, View<Vec3> positions, StrandState &state) {
    std::vector<double> energies(model.strand_count());
    const StrandArrays arrays = arrays_of(model, state, positions, positions);
    for_each_group(model, [&](StrandGroup group, void *workspace) {
        double group_energies[max_lanes];
        RINGLET_DISPATCH(relax_strand_frames, arrays, group, workspace, group_energies);
        for (int k = 0; k < group.count; ++k) energies[group.strands[k]] = group_energies[k];
    });
    return energies;
}

} // namespace

StrandState make_strand_state(const StrandModel &model, View<Vec3> positions, View<Vec3> directors) {
    if (int(positions.size()) != model.vertex_count()) throw std::invalid_argument("strands: positions do not fit the model");
    StrandState state;
    const size_t n = positions.size();
    state.positions.assign(positions.begin(), positions.end());
    state.velocities.assign(n, Vec3::Zero());
    state.normals.assign(n, Vec3::Zero());
    state.twist.assign(n, 0.0);
    state.directors.assign(n, Vec3::Zero());
    state.last_positions.assign(n, Vec3::Zero());
    state.last_velocities.assign(n, Vec3::Zero());
    state.last_strains.assign(n, {});
    state.last_dt.assign(model.strand_count(), 0.0);
    const RestShape now = measure_rest_shape(View<int>(model.offsets), positions);
    state.normals = now.normal;
    for (int s = 0; s < model.strand_count(); ++s)
        for (int i = model.offsets[s] + 1; i + 2 < model.offsets[s + 1]; ++i)
            state.twist[i] = std::remainder(now.dihedral[i] - model.rest_dihedral[i], 2 * std::numbers::pi);
    if (!directors.empty()) {
        if (directors.size() != n) throw std::invalid_argument("strands: directors do not fit the model");
        state.directors.assign(directors.begin(), directors.end());
        return state;
    }
    set_untwisted_directors(model, positions, now, state);

    // The relaxed frames depend on the initial ones: directors along the corners' normals are tried too, and each strand keeps
    // those with less energy.
    StrandState by_normals = state;
    for (int s = 0; s < model.strand_count(); ++s)
        for (int i = model.offsets[s] + 2; i + 1 < model.offsets[s + 1]; ++i)
            if (!(model.held[i] && model.held[i + 1])) by_normals.directors[i] = now.normal[i];
    const std::vector<double> untwisted = relax_frames(model, positions, state),
                              normal = relax_frames(model, positions, by_normals);
    for (int s = 0; s < model.strand_count(); ++s)
        if (normal[s] < untwisted[s])
            std::copy(by_normals.directors.begin() + model.offsets[s], by_normals.directors.begin() + model.offsets[s + 1],
                      state.directors.begin() + model.offsets[s]);
    return state;
}

StrandArrays arrays_of(const StrandModel &model, StrandState &state, View<Vec3> targets, View<Vec3> forces) {
    StrandArrays arrays;
    for (int c = 0; c < StrandModel::column_count; ++c)
        arrays.*StrandArrays::columns[c] = (model.*StrandModel::columns[c]).data();
    arrays.offsets = model.offsets.data();
    arrays.held = model.held.data();
    arrays.mass_damping = model.mass_damping;
    arrays.targets = targets.data()->data();
    arrays.forces = forces.data()->data();
    arrays.positions = state.positions.data()->data();
    arrays.velocities = state.velocities.data()->data();
    arrays.normals = state.normals.data()->data();
    arrays.twist = state.twist.data();
    arrays.directors = state.directors.data()->data();
    arrays.last_positions = state.last_positions.data()->data();
    arrays.last_velocities = state.last_velocities.data()->data();
    arrays.last_strains = state.last_strains.data()->data();
    arrays.last_dt = state.last_dt.data();
    return arrays;
}

std::vector<double> stabilising_stiffness(const StrandModel &model, const StrandState &state, View<double> left, double most) {
    if (int(left.size()) != model.strand_count()) throw std::invalid_argument("strands: left does not fit the strands");
    const StaticStrands strands{.offsets = model.offsets.data(),
                                .held = model.held.data(),
                                .positions = state.positions.data()->data(),
                                .directors = state.directors.data()->data(),
                                .rest_length = model.rest_length.data(),
                                .rest_angle = model.rest_angle.data(),
                                .rest_dihedral = model.rest_dihedral.data(),
                                .stretch_stiffness = model.stretch_stiffness.data(),
                                .bend_stiffness = model.bend_stiffness.data(),
                                .twist_stiffness = model.twist_stiffness.data()};
    std::vector<double> factors(model.strand_count());
    stabilising_stiffness(model.strand_count(), strands, left.data(), most, factors.data());
    return factors;
}

void step_strands(const StrandModel &model, StrandState &state, View<Vec3> targets, View<Vec3> forces, const StrandStep &step,
                  std::vector<StrandReport> &reports, const StrandPlanes &planes, const StrandSprings &springs) {
    if (int(targets.size()) != model.vertex_count() || int(forces.size()) != model.vertex_count())
        throw std::invalid_argument("strands: targets and forces do not fit the model");
    reports.assign(model.strand_count(), StrandReport{});
    StrandArrays arrays = arrays_of(model, state, targets, forces);
    if (!planes.normal.empty()) {
        const size_t n = planes.normal.size();
        if (int(n) != model.vertex_count() || planes.offset.size() != n || planes.stiffness.size() != n)
            throw std::invalid_argument("strands: planes do not fit the model");
        if (step.continuation != Continuation::material_frame)
            throw std::invalid_argument("strands: only material frames have planes");
        arrays.planes = {planes.normal.data()->data(), planes.offset.data(), planes.stiffness.data()};
    }
    if (!springs.target.empty()) {
        if (int(springs.target.size()) != model.vertex_count() || springs.stiffness.size() != springs.target.size())
            throw std::invalid_argument("strands: springs do not fit the model");
        arrays.springs = {springs.target.data()->data(), springs.stiffness.data()};
    }
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
