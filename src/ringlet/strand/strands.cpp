#include "ringlet/strand/strands.h"

#include "ringlet/linear/lane_vectors.h"
#include "ringlet/math/aligned.h"
#include "ringlet/rest/resolution.h"
#include "ringlet/rest/rest_shape.h"
#include "ringlet/strand/strand_groups.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <exception>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <string>

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

std::vector<int> by_length(const StrandModel &model) {
    std::vector<int> order(model.strand_count());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
        return model.offsets[a + 1] - model.offsets[a] > model.offsets[b + 1] - model.offsets[b];
    });
    return order;
}

namespace {

// Where a place is on a curve through the box of all of them that keeps what is near together (Morton's).
uint32_t on_the_curve(const Eigen::Array3d &part) {
    constexpr int bits = 10;
    uint32_t place = 0;
    for (int bit = bits - 1; bit >= 0; --bit)
        for (int k = 0; k < 3; ++k) place = place << 1 | (uint32_t(part[k] * ((1 << bits) - 1)) >> bit & 1);
    return place;
}

} // namespace

std::vector<int> by_length_and_place(const StrandModel &model, View<Vec3> positions) {
    Eigen::AlignedBox3d box;
    for (int s = 0; s < model.strand_count(); ++s) box.extend(positions[model.offsets[s]]);
    std::vector<uint32_t> place(model.strand_count());
    for (int s = 0; s < model.strand_count(); ++s) {
        const Eigen::Array3d part = (positions[model.offsets[s]] - box.min()).array() / (box.sizes().array() + 1e-300);
        place[s] = on_the_curve(part.min(1.0));
    }
    std::vector<int> order = by_length(model);
    const auto length = [&](int s) { return model.offsets[s + 1] - model.offsets[s]; };
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return length(a) != length(b) ? length(a) > length(b) : place[a] < place[b]; });
    return order;
}

namespace {

int longest_strand(const StrandModel &model) {
    int most = 3;
    for (int s = 0; s < model.strand_count(); ++s) most = std::max(most, model.offsets[s + 1] - model.offsets[s]);
    return most;
}

// work(group, workspace) for groups of as many strands as there are lanes, in parallel.
template <class Work> void for_each_group(const StrandModel &model, const Work &work) {
    const std::vector<int> order = by_length(model);
    const int strands = model.strand_count(), lanes = RINGLET_DISPATCH(strand_lanes);
    const int groups = (strands + lanes - 1) / lanes;
    const size_t bytes = RINGLET_DISPATCH(strand_workspace, longest_strand(model));
#pragma omp parallel
    {
        const AlignedMemory workspace(bytes);
#pragma omp for schedule(dynamic)
        for (int g = 0; g < groups; ++g)
            work(StrandGroup{order.data() + g * lanes, std::min(lanes, strands - g * lanes)}, workspace.get());
    }
}

// Per edge of a strand; the two end edges, which have one corner only, take those of their neighbours.
std::vector<ResolutionFactors> resolution_of(const StrandModel &model, int first, int end) {
    std::vector<ResolutionFactors> factors(end - first - 1);
    for (int i = first + 1; i + 2 < end; ++i)
        factors[i - first] = resolution_factors(0.5 * (model.rest_angle[i] + model.rest_angle[i + 1]), model.rest_dihedral[i]);
    if (factors.size() > 2) {
        factors.front() = factors[1];
        factors.back() = factors[factors.size() - 2];
    }
    return factors;
}

} // namespace

StrandModel make_strand_model(View<int> offsets, View<Vec3> rest, View<unsigned char> held, const StrandMaterial &material,
                              const StrandVariation &variation) {
    const int strands = int(offsets.size()) - 1;
    const size_t n = rest.size();
    if (strands < 0 || offsets.front() != 0 || offsets.back() != int(n) || held.size() != n)
        throw std::invalid_argument("strands: offsets, points and held do not fit together");
    for (const View<double> &factor : {variation.radius, variation.stretch, variation.bend, variation.twist, variation.damping})
        if (!factor.empty() && factor.size() != n) throw std::invalid_argument("strands: a variation does not fit the points");

    StrandModel model;
    model.offsets.assign(offsets.begin(), offsets.end());
    model.held.assign(held.begin(), held.end());
    RestShape shape = measure_rest_shape(offsets, rest);
    model.rest_length = std::move(shape.length);
    model.rest_angle = std::move(shape.angle);
    model.rest_dihedral = std::move(shape.dihedral);
    model.rest_normal = std::move(shape.normal);
    model.rest_tangent.assign(n, Vec3::Zero());
    model.mass_damping = material.mass_damping;
    model.stretch_stiffness.assign(n, 0.0);
    model.bend_stiffness.assign(n, 0.0);
    model.twist_stiffness.assign(n, 0.0);
    model.mass.assign(n, 0.0);
    model.drag.assign(n, 0.0);
    model.damping.assign(n, material.damping);

    const auto at = [](View<double> factor, int i) { return factor.empty() ? 1.0 : factor[i]; };
    const auto on_edge = [&at](View<double> factor, int i) { return 0.5 * (at(factor, i) + at(factor, i + 1)); };
    const auto area = [&](double factor) { return std::numbers::pi * std::pow(factor * material.radius, 2); };
    const auto bending = [&](double radius_factor, double bend_factor) { // EI [N m²]
        return bend_factor * material.bend_scale * material.youngs_modulus * std::pow(area(radius_factor), 2) /
               (4 * std::numbers::pi);
    };
    for (int s = 0; s < strands; ++s) {
        const int first = offsets[s], end = offsets[s + 1];
        const std::string name = "strands: strand " + std::to_string(s);
        if (end - first < 3) throw std::invalid_argument(name + " has fewer than 3 vertices");
        if (!held[first]) throw std::invalid_argument(name + " does not hold its root");
        std::vector<ResolutionFactors> factors(end - first - 1);
        if (material.correct_resolution) factors = resolution_of(model, first, end);
        for (int i = first; i + 1 < end; ++i) {
            const double length = model.rest_length[i];
            const ResolutionFactors &factor = factors[i - first];
            if (!(length > 0)) throw std::invalid_argument(name + " has an edge without length");
            model.rest_tangent[i] = (rest[i + 1] - rest[i]) / length;
            const double section = area(on_edge(variation.radius, i));
            model.stretch_stiffness[i] =
                material.stretch_scale * on_edge(variation.stretch, i) * material.youngs_modulus * section / length;
            for (const int vertex : {i, i + 1}) {
                model.mass[vertex] += 0.5 * material.density * section * length * factor.mass;
                model.drag[vertex] += 0.5 * material.drag * length;
            }
            model.damping[i] *= at(variation.damping, i);
            if (i == first) continue;
            const double EI = bending(at(variation.radius, i), at(variation.bend, i));
            model.bend_stiffness[i] =
                EI * 0.5 * (factors[i - first - 1].bend + factor.bend) / (0.5 * (model.rest_length[i - 1] + length));
            if (i + 2 == end) continue;
            const double most = material.limit_twist ? 1.0 : 1e300; // safeguard: twist never above bend
            const double ratio = std::clamp(material.twist_ratio * on_edge(variation.twist, i), 0.0, most);
            // An edge that is held is held to its middle, as the bend behind it has it: only half of it can twist.
            const double twisting_length = held[i] && held[i + 1] ? 0.5 * length : length;
            model.twist_stiffness[i] =
                ratio * factor.twist * bending(on_edge(variation.radius, i), on_edge(variation.bend, i)) / twisting_length;
        }
    }
    return model;
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
            double group_energies[max_lanes];
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
    const AlignedMemory workspace(RINGLET_DISPATCH(strand_workspace, longest_strand(model)));
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
        energy += RINGLET_DISPATCH(strand_group_energy, arrays, step, s, positions.data()->data(), workspace.get(),
                                   gradient[model.offsets[s]].data(), hessian ? hessian->data() : nullptr);
    return energy;
}

} // namespace ringlet
