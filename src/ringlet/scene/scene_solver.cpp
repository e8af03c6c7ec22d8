#include "ringlet/scene/scene_solver.h"

#include "ringlet/scene/scene_matrix.h"

#include <algorithm>
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

double dot(const AlignedVector &a, const AlignedVector &b, size_t first, size_t count) {
    double value = 0.0;
    for (size_t i = first; i < first + count; ++i) value += a[i] * b[i];
    return value;
}

} // namespace

SceneSolver::Result SceneSolver::solve(SceneSystem &system, System how, double tolerance, AlignedVector &direction) {
    all_ = how == System::conjugate_gradient || how == System::direct;
    how = choose(system, how);
    // The matrix of what is not active is not assembled.
    if (how == System::direct && std::count(system.active.begin(), system.active.end(), 0) > 0)
        how = System::conjugate_gradient;
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

// What nothing couples is solved by P. For the rest conjugate gradients begin at 0.
void SceneSolver::begin(SceneSystem &system, AlignedVector &direction) {
    for (AlignedVector *vector : {&direction, &searched_}) vector->fill(0.0); // of what is not active too
    system.for_units([&](int u) {
        const size_t first = system.unit_begin(u), count = system.unit_end(u) - first;
        system.factor(u);
        if (takes_part(system, u)) {
            system.negative_gradient(u, residual_);
            for (AlignedVector *vector : {&direction, &searched_, &image_}) std::fill_n(vector->data() + first, count, 0.0);
        } else {
            system.negative_gradient(u, direction);
            system.precondition(u, direction);
        }
    });
}

// Preconditioned by P. Strands' P is factored: P p follows from P z = r by the same recursion as p from z, so that no product
// with it is ever formed. (The factor is rounded; the P that it is the exact factor of is then also that of A.) Of a cloth P
// has only an incomplete factor: there the product is.
SceneSolver::Result SceneSolver::conjugate_gradient(SceneSystem &system, double tolerance, AlignedVector &direction) {
    constexpr int most = 2000;
    // Σ over the units that take part.
    const auto sum = [&](const auto &of) {
        return system.sum([&](int u) {
            const size_t first = system.unit_begin(u);
            return takes_part(system, u) ? of(u, first, system.unit_end(u) - first) : 0.0;
        });
    };
    const auto precondition = [&](int u, size_t first, size_t count) { // says what r · z is
        std::copy_n(residual_.data() + first, count, solved_.data() + first);
        system.precondition(u, solved_);
        return dot(residual_, solved_, first, count);
    };
    const auto search = [&](int u, double beta) { // p = z + β p, and P p
        const size_t first = system.unit_begin(u), count = system.unit_end(u) - first;
        double *p = searched_.data() + first, *Pp = image_.data() + first, *Ap = product_.data() + first;
        const double *z = solved_.data() + first, *r = residual_.data() + first;
        for (size_t i = 0; i < count; ++i) p[i] = z[i] + beta * p[i];
        for (size_t i = 0; i < count; ++i) Pp[i] = r[i] + beta * Pp[i];
        if (u < system.group_count()) {
            std::copy_n(Pp, count, Ap);
        } else {
            std::fill_n(Ap, count, 0.0);
            system.cloths[u - system.group_count()].multiply_add(p, Ap);
        }
    };
    double rho = sum(precondition), beta = 0.0;
    const double enough = tolerance * tolerance * rho;
    Result result;
    for (; rho > enough && result.iterations < most; ++result.iterations) {
        system.for_units([&](int u) {
            if (takes_part(system, u)) search(u, beta);
        });
        system.couple(searched_, product_);
        const double curvature = sum([&](int, size_t first, size_t count) { return dot(searched_, product_, first, count); });
        if (!(curvature > 0.0)) break;
        const double alpha = rho / curvature;
        const double next = sum([&](int u, size_t first, size_t count) {
            double *d = direction.data() + first, *r = residual_.data() + first;
            const double *p = searched_.data() + first, *Ap = product_.data() + first;
            for (size_t i = 0; i < count; ++i) d[i] += alpha * p[i];
            for (size_t i = 0; i < count; ++i) r[i] -= alpha * Ap[i];
            return precondition(u, first, count);
        });
        beta = next / rho;
        rho = next;
    }
    result.residual = enough > 0.0 ? tolerance * std::sqrt(std::max(rho, 0.0) / enough) : 0.0;
    return result;
}

} // namespace ringlet
