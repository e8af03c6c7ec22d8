#include "ringlet/cloth/coupled_cloth.h"

#include <algorithm>

namespace ringlet {
namespace {

// A hundredth of how hard it is to stretch, and how hard to bend over the length of an edge: what a vertex resists by before
// the rest of the cloth does.
std::vector<double> elastic_stiffness(const ClothModel &model) {
    constexpr double part_of_stretch = 0.01;
    std::vector<double> stiffness(model.vertex_count(), part_of_stretch * std::max(model.stiffness.warp, model.stiffness.weft));
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

CoupledCloth::CoupledCloth(const ClothModel &model, ClothState &state)
    : gradient(model.vertex_count()), model_(&model), state_(&state), objective_(model), elastic_(elastic_stiffness(model)) {
    matrix = objective_.pattern();
}

void CoupledCloth::begin(const ClothForces &forces) {
    forces_ = forces;
    objective_.begin(*state_, forces);
}

void CoupledCloth::guess(double *x) const {
    std::vector<Vec3> fly = state_->positions;
    for (int v = 0; v < model_->vertex_count(); ++v) {
        if (model_->held[v])
            fly[v] = vectors(x)[v];
        else
            fly[v] += forces_.dt * state_->velocities[v];
    }
    if (objective_.energy(fly) < energy(x)) std::copy_n(fly.data()->data(), size(), x);
}

void CoupledCloth::end(const double *x, ClothReport &report) {
    const View<Vec3> positions = vectors(x);
    end_cloth_step(objective_, *state_, forces_, {positions.begin(), positions.end()}, report);
}

double CoupledCloth::energy(const double *x) const { return objective_.energy(vectors(x)); }

void CoupledCloth::assemble(const double *x) {
    matrix.set_zero();
    objective_.assemble(vectors(x), gradient, matrix);
}

void CoupledCloth::precondition(double *b) const {
    Eigen::Map<Eigen::VectorXd> whole(b, Eigen::Index(size()));
    Eigen::VectorXd solved;
    factor_.solve(whole, solved);
    whole = solved;
}

void CoupledCloth::multiply_add(const double *p, double *q) const {
    Eigen::VectorXd product;
    matrix.multiply(Eigen::Map<const Eigen::VectorXd>(p, Eigen::Index(size())), product);
    Eigen::Map<Eigen::VectorXd>(q, Eigen::Index(size())) += product;
}

} // namespace ringlet
