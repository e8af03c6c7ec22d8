#include "ringlet/cloth/objective.h"

#include "ringlet/dynamics/time_integrator.h"
#include "ringlet/energy/cloth/hinge.h"
#include "ringlet/math/parallel.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ringlet {
namespace {

constexpr int worth_threads = 1000; // elements: below, waking them takes longer

// f(i) for all i in parallel, and the sum in the order of i: the same bits for any number of threads.
template <class Term> double ordered_sum(int count, const Term &term) {
    std::vector<double> values(count);
    parallel_for(count, worth_threads, [&](int i) { values[i] = term(i); });
    return std::accumulate(values.begin(), values.end(), 0.0);
}

template <class Stencils> auto incidences(int vertices, const Stencils &stencils) {
    std::vector<std::vector<std::pair<int, int>>> of(vertices);
    for (int e = 0; e < int(stencils.size()); ++e) {
        int corner = 0;
        for (const int vertex : stencils[e]) of[vertex].emplace_back(e, corner++);
    }
    return of;
}

template <class Stencils> void add_pairs(const Stencils &stencils, std::vector<std::array<int, 2>> &pairs) {
    for (const auto &stencil : stencils)
        for (const int a : stencil)
            for (const int b : stencil)
                if (a < b) pairs.push_back({a, b});
}

template <size_t size, class Stencils>
std::vector<std::array<int, size>> slots(const Stencils &stencils, const BlockMatrix &matrix, int first) {
    std::vector<std::array<int, size>> result(stencils.size());
    for (size_t e = 0; e < stencils.size(); ++e) {
        int next = 0;
        for (const int a : stencils[e])
            for (const int b : stencils[e]) result[e][next++] = matrix.slot(first + a, first + b);
    }
    return result;
}

BlockMatrix pattern_of(const ClothModel &model) {
    std::vector<std::array<int, 2>> pairs;
    add_pairs(model.triangles, pairs);
    add_pairs(model.hinges, pairs);
    return {model.vertex_count(), pairs};
}

} // namespace

ClothObjective::ClothObjective(const ClothModel &model)
    : model_(&model), pattern_(pattern_of(model)), inertia_(model.vertex_count()),
      inertial_(model.vertex_count(), Vec3::Zero()), rest_strain_(model.triangles.size(), {1, 1, 0}),
      rest_angle_(model.rest_angle), triangle_terms_(model.triangles.size()), hinge_terms_(model.hinges.size()) {
    const auto flatten = [](const auto &of) {
        Incidences result{{0}, {}};
        for (const auto &list : of) {
            for (const auto &[element, corner] : list) result.list.push_back({element, corner});
            result.starts.push_back(int(result.list.size()));
        }
        return result;
    };
    triangles_of_ = flatten(incidences(model.vertex_count(), model.triangles));
    hinges_of_ = flatten(incidences(model.vertex_count(), model.hinges));
    use_pattern(pattern_, 0);
}

void ClothObjective::use_pattern(const BlockMatrix &matrix, int first) {
    triangle_slots_ = slots<9>(model_->triangles, matrix, first);
    hinge_slots_ = slots<16>(model_->hinges, matrix, first);
    diagonals_.resize(model_->vertex_count());
    for (int i = 0; i < model_->vertex_count(); ++i) diagonals_[i] = matrix.diagonal(first + i);
}

MembraneShape ClothObjective::shape(int triangle, View<Vec3> positions) const {
    const Triangle &t = model_->triangles[triangle];
    const Vec3 corners[3] = {positions[t[0]], positions[t[1]], positions[t[2]]};
    return membrane_shape(corners, model_->membrane[triangle]);
}

double ClothObjective::angle(int hinge, View<Vec3> positions) const {
    const auto &h = model_->hinges[hinge];
    const Vec3 corners[4] = {positions[h[0]], positions[h[1]], positions[h[2]], positions[h[3]]};
    return hinge_angle(corners);
}

void ClothObjective::begin(const ClothState &state, const ClothForces &forces) {
    const ClothModel &m = *model_;
    const auto integrator = RINGLET_SIMD::TimeIntegrator<double>::of_step(forces.dt, RINGLET_SIMD::backward_euler_lag);
    for (int i = 0; i < m.vertex_count(); ++i) {
        const auto inertia = integrator.inertia(m.mass[i], m.mass_damping, m.drag[i]);
        for (int k = 0; k < 3; ++k)
            inertial_[i][k] = inertia.target(state.positions[i][k], state.velocities[i][k], forces.gravity[k], forces.wind[k],
                                             forces.forces.empty() ? 0.0 : forces.forces[i][k]);
        inertia_[i] = inertia.stiffness + m.attachment[i];
        if (m.attachment[i] > 0)
            inertial_[i] = (inertia.stiffness * inertial_[i] + m.attachment[i] * forces.targets[i]) / inertia_[i];
    }
    const double b = m.damping / integrator.h;
    stiffer_ = 1 + b;
    const auto damped = [&](double rest, double now) { return (rest + b * now) / stiffer_; };
    for (int t = 0; t < int(m.triangles.size()); ++t) {
        const MembraneStrain now = shape(t, state.positions).strain();
        rest_strain_[t] = {damped(1, now.warp), damped(1, now.weft), damped(0, now.shear)};
    }
    for (int k = 0; k < int(m.hinges.size()); ++k) {
        const double strain = hinge_strain(angle(k, state.positions), m.rest_angle[k]);
        rest_angle_[k] = m.rest_angle[k] + damped(0, strain);
    }
}

double ClothObjective::energy(View<Vec3> positions) const {
    const ClothModel &m = *model_;
    const double inertia = ordered_sum(
        m.vertex_count(), [&](int i) { return 0.5 * free(i) * inertia_[i] * (positions[i] - inertial_[i]).squaredNorm(); });
    const double stretch = ordered_sum(int(m.triangles.size()), [&](int t) {
        return m.membrane[t].area * membrane_energy(shape(t, positions), rest_strain_[t], m.stiffness);
    });
    const double bend = ordered_sum(int(m.hinges.size()), [&](int k) {
        const double strain = hinge_strain(angle(k, positions), rest_angle_[k]);
        return 0.5 * m.hinge_stiffness[k] * strain * strain;
    });
    return inertia + stiffer_ * (stretch + bend);
}

// Derivatives of every element, to be gathered by the vertices.
void ClothObjective::measure(View<Vec3> positions) {
    const ClothModel &m = *model_;
    parallel_for(int(m.triangles.size()), worth_threads, [&](int t) {
        Membrane &at = triangle_terms_[t] = membrane(shape(t, positions), rest_strain_[t], m.stiffness);
        const double weight = stiffer_ * m.membrane[t].area;
        for (Vec3 *gradient : {&at.gradient_warp, &at.gradient_weft}) *gradient *= weight;
        for (Mat3 *block : {&at.warp_warp, &at.warp_weft, &at.weft_weft}) *block *= weight;
    });
    parallel_for(int(m.hinges.size()), worth_threads, [&](int k) {
        const auto &h = m.hinges[k];
        const Vec3 corners[4] = {positions[h[0]], positions[h[1]], positions[h[2]], positions[h[3]]};
        const Hinge at = hinge(corners);
        HingeTerms &terms = hinge_terms_[k];
        std::copy(at.gradient, at.gradient + 4, terms.gradient);
        terms.stiffness = stiffer_ * m.hinge_stiffness[k];
        terms.moment = terms.stiffness * hinge_strain(at.angle, rest_angle_[k]);
    });
}

// One vertex: its gradient and its row of the Hessian.
void ClothObjective::gather(int vertex, View<Vec3> positions, Vec3 &gradient, BlockMatrix &hessian) const {
    const ClothModel &m = *model_;
    if (m.held[vertex]) {
        gradient.setZero();
        hessian.block(diagonals_[vertex]) += Mat3::Identity();
        return;
    }
    gradient = inertia_[vertex] * (positions[vertex] - inertial_[vertex]);
    hessian.block(diagonals_[vertex]).diagonal().array() += inertia_[vertex];
    for (int k = triangles_of_.starts[vertex]; k < triangles_of_.starts[vertex + 1]; ++k) {
        const auto [t, a] = triangles_of_.list[k];
        const Membrane &at = triangle_terms_[t];
        const Vec3 &warp = m.membrane[t].warp, &weft = m.membrane[t].weft;
        gradient += warp[a] * at.gradient_warp + weft[a] * at.gradient_weft;
        const Mat3 by_warp = warp[a] * at.warp_warp + weft[a] * at.warp_weft.transpose();
        const Mat3 by_weft = warp[a] * at.warp_weft + weft[a] * at.weft_weft;
        for (int b = 0; b < 3; ++b)
            if (!m.held[m.triangles[t][b]])
                hessian.block(triangle_slots_[t][3 * a + b]) += warp[b] * by_warp + weft[b] * by_weft;
    }
    for (int k = hinges_of_.starts[vertex]; k < hinges_of_.starts[vertex + 1]; ++k) {
        const auto [e, a] = hinges_of_.list[k];
        const HingeTerms &at = hinge_terms_[e];
        gradient += at.moment * at.gradient[a];
        const Vec3 weighted = at.stiffness * at.gradient[a];
        for (int b = 0; b < 4; ++b)
            if (!m.held[m.hinges[e][b]]) hessian.block(hinge_slots_[e][4 * a + b]) += weighted * at.gradient[b].transpose();
    }
}

void ClothObjective::assemble(View<Vec3> positions, std::span<Vec3> gradient, BlockMatrix &hessian) {
    measure(positions);
    parallel_for(model_->vertex_count(), worth_threads, [&](int i) { gather(i, positions, gradient[i], hessian); });
}

ClothEnergies ClothObjective::energies(View<Vec3> positions) const {
    const ClothModel &m = *model_;
    ClothEnergies result;
    for (int t = 0; t < int(m.triangles.size()); ++t) {
        const MembraneShape now = shape(t, positions);
        const MembraneStrain strain = now.strain();
        result.stretch += m.membrane[t].area * membrane_energy(now, {1, 1, 0}, m.stiffness);
        result.max_stretch = std::max({result.max_stretch, std::abs(strain.warp - 1), std::abs(strain.weft - 1)});
    }
    for (int k = 0; k < int(m.hinges.size()); ++k) {
        const double strain = hinge_strain(angle(k, positions), m.rest_angle[k]);
        result.bend += 0.5 * m.hinge_stiffness[k] * strain * strain;
    }
    return result;
}

} // namespace ringlet
