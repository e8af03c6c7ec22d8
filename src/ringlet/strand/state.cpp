#include "ringlet/strand/state.h"

#include "ringlet/rest/rest_shape.h"
#include "ringlet/strand/for_each_group.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace ringlet {

StrandArrays arrays_of(const StrandModel &model, StrandState &state, View<Vec3> targets, View<Vec3> forces) {
    return {model.offsets.data(),
            model.held.data(),
            model.rest_length.data(),
            model.rest_angle.data(),
            model.rest_dihedral.data(),
            model.stretch_stiffness.data(),
            model.bend_stiffness.data(),
            model.twist_stiffness.data(),
            model.mass.data(),
            model.drag.data(),
            model.damping.data(),
            model.mass_damping,
            targets.data()->data(),
            forces.data()->data(),
            state.positions.data()->data(),
            state.velocities.data()->data(),
            state.normals.data()->data(),
            state.twist.data(),
            state.directors.data()->data(),
            state.last_positions.data()->data(),
            state.last_velocities.data()->data(),
            state.last_strains.data()->data(),
            state.last_dt.data()};
}

StrandState make_strand_state(const StrandModel &model, View<Vec3> positions) {
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
    for (int s = 0; s < model.strand_count(); ++s) {
        const int first = model.offsets[s], end = model.offsets[s + 1];
        // The frame begins as that of the root and follows without any twist but the groom's; then it is let go.
        const auto tangent = [&](int i) -> Vec3 { return (positions[i + 1] - positions[i]).normalized(); };
        const bool bent = model.rest_angle[first + 1] > 1e-6 && now.angle[first + 1] > 1e-6;
        state.directors[first + 1] =
            bent ? now.normal[first + 1]
                 : Eigen::Quaterniond::FromTwoVectors(model.rest_tangent[first + 1], tangent(first + 1)) *
                       model.rest_normal[first + 1];
        for (int i = first + 1; i + 2 < end; ++i) {
            state.twist[i] = std::remainder(now.dihedral[i] - model.rest_dihedral[i], 2 * std::numbers::pi);
            const Vec3 turned = Eigen::AngleAxisd(model.rest_dihedral[i], tangent(i)) * state.directors[i];
            state.directors[i + 1] = Eigen::Quaterniond::FromTwoVectors(tangent(i), tangent(i + 1)) * turned;
        }
    }

    // Where it ends depends on where it begins: frames that follow the corners' normals are tried too, the cheaper are kept.
    const auto relax = [&](StrandState &of) {
        std::vector<double> energies(model.strand_count());
        const StrandArrays arrays = arrays_of(model, of, positions, positions);
        for_each_group(model, [&](StrandGroup group, void *workspace) {
            double group_energies[most_lanes];
            RINGLET_DISPATCH(relax_strand_frames, arrays, group, workspace, group_energies);
            for (int k = 0; k < group.count; ++k) energies[group.strands[k]] = group_energies[k];
        });
        return energies;
    };
    StrandState by_normals = state;
    for (int s = 0; s < model.strand_count(); ++s)
        for (int i = model.offsets[s] + 2; i + 1 < model.offsets[s + 1]; ++i)
            if (!(model.held[i] && model.held[i + 1])) by_normals.directors[i] = now.normal[i];
    const std::vector<double> untwisted = relax(state), normal = relax(by_normals);
    for (int s = 0; s < model.strand_count(); ++s)
        if (normal[s] < untwisted[s])
            std::copy(by_normals.directors.begin() + model.offsets[s], by_normals.directors.begin() + model.offsets[s + 1],
                      state.directors.begin() + model.offsets[s]);
    return state;
}

} // namespace ringlet
