#include "ringlet/cloth/block.h"

#include <algorithm>

namespace ringlet {
namespace {

constexpr double contact_stretch = 0.01; // of the stretch stiffness, in that against contacts

// A hundredth of the stretch, and the bending over the length of an edge: what a vertex resists by before the rest of the cloth
// does.
std::vector<double> elastic_stiffness(const ClothModel &model) {
    std::vector<double> stiffness(model.vertex_count(), contact_stretch * std::max(model.stiffness.warp, model.stiffness.weft));
    std::vector<double> bend(model.vertex_count(), 0.0);
    for (size_t k = 0; k < model.hinges.size(); ++k) {
        const auto &h = model.hinges[k];
        const double length2 = (model.rest[h[1]] - model.rest[h[2]]).squaredNorm();
        for (const int v : h) bend[v] = std::max(bend[v], model.hinge_stiffness[k] / length2);
    }
    for (int v = 0; v < model.vertex_count(); ++v) stiffness[v] += bend[v] + model.attachment[v];
    return stiffness;
}

} // namespace

ClothBlock::ClothBlock(const ClothModel &model, ClothState &state, int object, int first)
    : model_(model), state_(state), first_(first), objective_(model), elastic_(elastic_stiffness(model)),
      gradient_(model.vertex_count()), matrix_(objective_.pattern()) {
    objects_ = {{object, first, first + model.vertex_count()}};
    rows_ = 3 * model.vertex_count();
    size_ = rows_;
}

void ClothBlock::begin_step(const BlockStep &step) {
    const size_t count = model_.vertex_count();
    dt_ = step.dt, gravity_ = step.gravity;
    objective_.begin(
        state_, {step.dt, step.gravity, step.wind, step.targets.subspan(first_, count), step.forces.subspan(first_, count)});
}

void ClothBlock::initial_guess(double *x) const {
    std::vector<Vec3> flying = state_.positions;
    for (int v = 0; v < model_.vertex_count(); ++v) {
        if (model_.held[v])
            flying[v] = vectors(x)[v];
        else
            flying[v] += dt_ * state_.velocities[v];
    }
    if (objective_.energy(flying) < objective_.energy(vectors(x))) std::copy_n(flying.data()->data(), size(), x);
}

void ClothBlock::energies(const double *x, double *of_lanes) { of_lanes[0] = objective_.energy(vectors(x)); }

void ClothBlock::assemble(const double *x, double *of_lanes) {
    energies(x, of_lanes);
    matrix_.set_zero();
    objective_.assemble(vectors(x), gradient_, matrix_);
}

void ClothBlock::add_block(int row, int column, const Mat3 &block) {
    matrix_.block(matrix_.slot(row - first_, column - first_)) += block;
    if (row != column) matrix_.block(matrix_.slot(column - first_, row - first_)) += block.transpose();
}

// Unknowns that a vertex of a cloth does not have get the unit matrix.
void ClothBlock::add_to(MatrixAssembly &matrix) const {
    const int stride = matrix.block();
    for (int row = 0; row < matrix_.rows(); ++row)
        for (int slot = matrix_.diagonal(row); slot < matrix_.row_end(row); ++slot) {
            double *block = matrix.add_block(first_ + row, first_ + matrix_.column(slot));
            for (int r = 0; r < 3; ++r)
                for (int c = 0; c < 3; ++c) block[r * stride + c] = matrix_.block(slot)(r, c);
            for (int k = 3; k < stride && matrix_.column(slot) == row; ++k) block[k * stride + k] = 1.0;
        }
}

void ClothBlock::solve(double *b) const {
    Eigen::Map<Eigen::VectorXd> whole(b, Eigen::Index(size()));
    Eigen::VectorXd solved;
    factor_.solve(whole, solved);
    whole = solved;
}

void ClothBlock::multiply_add(const double *p, double *q) const {
    Eigen::VectorXd product;
    matrix_.multiply(Eigen::Map<const Eigen::VectorXd>(p, Eigen::Index(size())), product);
    Eigen::Map<Eigen::VectorXd>(q, Eigen::Index(size())) += product;
}

void ClothBlock::contact_stiffness(double dt, std::vector<double> &of_vertices) const {
    for (int v = 0; v < model_.vertex_count(); ++v)
        if (!model_.held[v]) of_vertices[first_ + v] = model_.mass[v] / (dt * dt) + elastic_[v];
}

bool ClothBlock::commit(const double *x, double dt, const SolverEffort &effort) {
    const View<Vec3> end = vectors(x);
    report = {};
    report.newton = effort.iterations, report.residual = effort.residual, report.unconverged = !effort.converged;
    if (!std::all_of(end.begin(), end.end(), [](const Vec3 &at) { return at.allFinite(); })) {
        report.nan = 1;
        std::fill(state_.velocities.begin(), state_.velocities.end(), Vec3::Zero());
        return false;
    }
    for (int i = 0; i < model_.vertex_count(); ++i) {
        state_.velocities[i] = (end[i] - state_.positions[i]) / dt;
        state_.positions[i] = end[i];
        if (model_.held[i]) continue;
        report.gravity -= model_.mass[i] * gravity_.dot(end[i]);
        report.kinetic += 0.5 * model_.mass[i] * state_.velocities[i].squaredNorm();
    }
    const ClothEnergies elastic = objective_.energies(end);
    report.stretch = elastic.stretch, report.bend = elastic.bend, report.max_stretch = elastic.max_stretch;
    return true;
}

} // namespace ringlet
