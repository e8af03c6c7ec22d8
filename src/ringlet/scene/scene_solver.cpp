#include "ringlet/scene/scene_solver.h"

#include "ringlet/scene/scene_matrix.h"

#include <cmath>
#include <optional>

namespace ringlet {
namespace {

System choose(const SceneSystem &system, System how) {
    if (how == System::banded && system.any_coupled())
        throw CoupledError("scene: the system 'banded' solves strands alone, but something couples them");
    if (how != System::automatic) return how;
    return system.any_coupled() ? System::conjugate_gradient : System::banded;
}

// Work for every unknown of a unit, in order.
template <class Work> void each(const SceneSystem &system, int unit, const Work &work) {
    for (size_t i = system.unit_begin(unit); i < system.unit_end(unit); ++i) work(i);
}

double dot(const SceneSystem &system, int unit, const AlignedVector &a, const AlignedVector &b) {
    double value = 0.0;
    each(system, unit, [&](size_t i) { value += a[i] * b[i]; });
    return value;
}

} // namespace

SceneSolver::Result SceneSolver::solve(SceneSystem &system, System how, double tolerance, AlignedVector &direction) {
    all_ = how == System::conjugate_gradient || how == System::direct;
    how = choose(system, how);
    if (residual_.size() != system.size())
        for (AlignedVector *vector : {&residual_, &solved_, &searched_, &image_, &product_})
            *vector = AlignedVector(system.size());
    std::optional<SceneMatrix> whole; // before its parts are factored in place
    if (how == System::direct) whole.emplace(system);
    begin(system, direction);
    if (how == System::banded) return {};
    if (whole && whole->size() > 0) {
        DirectSolver solver;
        solver.analyse(whole->pattern());
        if (solver.factor(whole->triplets())) {
            std::vector<double> solution(whole->size());
            const double residual = solver.solve(whole->right_hand_side(), solution);
            whole->set(solution, direction);
            return {0, residual};
        }
    }
    return conjugate_gradient(system, tolerance, direction);
}

// Solves by P. That is the direction of what nothing couples, and where conjugate gradients begin for the rest.
void SceneSolver::begin(SceneSystem &system, AlignedVector &direction) {
    system.for_units([&](int u) {
        system.factor(u);
        each(system, u, [&](size_t i) { solved_[i] = residual_[i] = -system.gradient(i, u); });
        system.precondition(u, solved_);
        each(system, u, [&](size_t i) { direction[i] = takes_part(system, u) ? 0.0 : solved_[i]; });
    });
}

// Preconditioned by P. Strands' P is factored exactly: P p follows from P z = r by the same recursion as p from z, so that no
// product with it is ever formed. Of a cloth P has only an incomplete factor: there the product is.
SceneSolver::Result SceneSolver::conjugate_gradient(SceneSystem &system, double tolerance, AlignedVector &direction) {
    constexpr int most = 2000;
    const auto for_coupled = [&](const auto &work) {
        system.for_units([&](int u) {
            if (takes_part(system, u)) work(u);
        });
    };
    const auto sum = [&](const auto &of) { return system.sum([&](int u) { return takes_part(system, u) ? of(u) : 0.0; }); };
    const auto follow = [&](double beta) { // p = z + β p, and P p
        for_coupled([&](int u) {
            each(system, u, [&](size_t i) {
                searched_[i] = solved_[i] + beta * searched_[i];
                image_[i] = residual_[i] + beta * image_[i];
            });
        });
    };
    searched_.fill(0.0);
    image_.fill(0.0);
    double rho = sum([&](int u) { return dot(system, u, residual_, solved_); });
    follow(0.0);
    const double enough = tolerance * tolerance * rho;
    Result result;
    for (; rho > enough && result.iterations < most; ++result.iterations) {
        for_coupled([&](int u) {
            const bool exact = u < system.group_count();
            each(system, u, [&](size_t i) { product_[i] = exact ? image_[i] : 0.0; });
            if (!exact)
                system.cloths[u - system.group_count()].multiply_add(searched_.data() + system.unit_begin(u),
                                                                     product_.data() + system.unit_begin(u));
        });
        system.couple(searched_, product_);
        const double curvature = sum([&](int u) { return dot(system, u, searched_, product_); });
        if (!(curvature > 0.0)) break;
        const double alpha = rho / curvature;
        const double next = sum([&](int u) {
            each(system, u, [&](size_t i) {
                direction[i] += alpha * searched_[i];
                residual_[i] -= alpha * product_[i];
                solved_[i] = residual_[i];
            });
            system.precondition(u, solved_);
            return dot(system, u, residual_, solved_);
        });
        const double beta = next / rho;
        rho = next;
        follow(beta);
    }
    result.residual = enough > 0.0 ? tolerance * std::sqrt(std::max(rho, 0.0) / enough) : 0.0;
    return result;
}

} // namespace ringlet
