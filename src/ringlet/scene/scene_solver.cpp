#include "ringlet/scene/scene_solver.h"

#include "ringlet/scene/lane_vectors.h"

#include <algorithm>
#include <cmath>

namespace ringlet {
namespace {

System choose(const SceneSystem &system, System how) {
    if (how == System::banded && system.any_coupled())
        throw CoupledError("scene: the system 'banded' solves strands alone, but something couples them");
    // The matrix of what is not active is not assembled.
    const bool all = std::count(system.active.begin(), system.active.end(), 0) == 0;
    return how == System::direct && all ? how : System::conjugate_gradient;
}

double dot(const double *a, const double *b, size_t count) {
    double value = 0.0;
    for (size_t i = 0; i < count; ++i) value += a[i] * b[i];
    return value;
}

} // namespace

void SceneSolver::prepare(SceneSystem &system, const AlignedVector &x, System how) {
    all_ = how == System::conjugate_gradient || how == System::direct;
    how = choose(system, how);
    if (residual_.size() != system.size())
        for (AlignedVector *vector : {&residual_, &solved_, &searched_, &image_}) *vector = AlignedVector(system.size());
    for (AlignedVector *vector : {&searched_, &image_}) vector->fill(0.0); // of what is not active too
    for (std::vector<double> *of_parts : {&products_, &curvatures_, &alpha_, &beta_})
        of_parts->assign(system.vertices.parts(), 0.0);
    system.linearise(x);
    whole_.reset();
    if (how == System::direct) {
        system.for_units([&](int u) { system.assemble(u, x); });
        whole_.emplace(system);
        system.for_units([&](int u) { begin(system, u); });
    } else {
        system.for_units([&](int u) { // all of it while it is in the processor's own memory
            system.assemble(u, x);
            begin(system, u);
        });
    }
}

void SceneSolver::begin(SceneSystem &system, int unit) {
    system.factor(unit);
    system.negative_gradient(unit, residual_);
    precondition(system, unit);
}

SceneSolver::Result SceneSolver::solve(SceneSystem &system, double tolerance, AlignedVector &direction) {
    Result result;
    direction.fill(0.0); // of what is not active too
    if (whole_ && whole_->size() > 0 && solve_whole(*whole_, direction, result)) return result;
    return conjugate_gradient(system, tolerance, direction);
}

bool SceneSolver::solve_whole(const SceneMatrix &whole, AlignedVector &direction, Result &result) {
    DirectSolver solver;
    solver.analyse(whole.pattern());
    if (!solver.factor(whole.triplets())) return false;
    std::vector<double> solution(whole.size());
    result.residual = solver.solve(whole.right_hand_side(), solution);
    whole.set(solution, direction);
    return true;
}

// Preconditioned by P. Strands' P is factored: P p follows from P z = r by the same recursion as p from z, so that no product
// with it is ever formed. (The factor is rounded; the P that it is the exact factor of is then also that of A.) Of a cloth P
// has only an incomplete factor: there the product is. Clusters are systems of their own, and each goes its own number of
// steps; a strand that is alone is solved by P.
SceneSolver::Result SceneSolver::conjugate_gradient(SceneSystem &system, double tolerance, AlignedVector &direction) {
    constexpr int most = 2000;
    const int parts = system.vertices.parts();
    const std::vector<int> &cluster = system.clusters();
    const auto sum = [&](const std::vector<double> &of_parts, std::vector<double> &of_clusters) {
        of_clusters.assign(parts, 0.0);
        for (int p = 0; p < parts; ++p) of_clusters[cluster[p]] += of_parts[p];
    };
    std::vector<double> rho, next, curvature, alpha(parts), beta(parts);
    std::vector<unsigned char> busy(parts), busy_units;
    sum(products_, rho);
    for (int p = 0; p < parts; ++p)
        if (is_alone(system, p)) rho[p] = 0.0;
    const double all = std::accumulate(rho.begin(), rho.end(), 0.0);
    std::vector<double> enough = rho;
    for (double &of_cluster : enough) of_cluster *= tolerance * tolerance;
    for (int p = 0; p < parts; ++p) alpha_[p] = is_alone(system, p);
    system.for_units([&](int u) { take_solved(system, u, direction); });
    Result result;
    for (;; ++result.iterations) {
        bool any = false;
        busy_units.assign(system.unit_count(), 0);
        for (int p = 0; p < parts; ++p) {
            busy[p] = rho[cluster[p]] > enough[cluster[p]];
            if (!busy[p]) continue;
            any = true;
            busy_units[system.unit_of(p)] = 1;
        }
        const double left = std::accumulate(rho.begin(), rho.end(), 0.0);
        if (!any || left <= tolerance * tolerance * all || result.iterations == most) break;
        const auto for_busy = [&](const auto &work) {
            system.for_units([&](int u) {
                if (busy_units[u]) work(u);
            });
        };
        for_busy([&](int u) { search(system, u); });
        sum(curvatures_, curvature);
        system.couple(searched_, busy, curvature);
        for (int p = 0; p < parts; ++p) { // of clusters, then of their parts
            if (busy[p] && cluster[p] == p) alpha[p] = curvature[p] > 0.0 ? rho[p] / curvature[p] : 0.0;
            alpha_[p] = busy[p] ? alpha[cluster[p]] : 0.0;
        }
        for_busy([&](int u) { advance(system, u, direction); });
        sum(products_, next);
        for (int p = 0; p < parts; ++p) {
            if (cluster[p] == p && busy[p]) {
                beta[p] = next[p] / rho[p];
                rho[p] = alpha[p] > 0.0 ? next[p] : 0.0;
            }
            beta_[p] = busy[p] ? beta[cluster[p]] : 0.0;
        }
    }
    const double left = std::accumulate(rho.begin(), rho.end(), 0.0);
    result.residual = all > 0.0 ? std::sqrt(std::max(left, 0.0) / all) : 0.0;
    return result;
}

// P z = r, and r · z.
void SceneSolver::precondition(const SceneSystem &system, int unit) {
    const size_t first = system.unit_begin(unit), count = system.unit_end(unit) - first;
    std::copy_n(residual_.data() + first, count, solved_.data() + first);
    system.precondition(unit, solved_);
    const double *r = residual_.data() + first, *z = solved_.data() + first;
    double of_lanes[most_lanes] = {};
    if (unit < system.group_count())
        RINGLET_DISPATCH(lane_products, r, z, int(count / system.strands.stride()), of_lanes);
    else
        of_lanes[0] = dot(r, z, count);
    system.from_lanes(unit, of_lanes, products_);
}

// Of a strand that is alone, its direction.
void SceneSolver::take_solved(const SceneSystem &system, int unit, AlignedVector &direction) const {
    if (unit >= system.group_count()) return;
    const size_t first = system.unit_begin(unit), count = system.unit_end(unit) - first;
    double alone[most_lanes] = {};
    system.to_lanes(unit, alpha_, alone);
    double *d = direction.data() + first;
    RINGLET_DISPATCH(lane_move, d, alone, solved_.data() + first, int(count / system.strands.stride()), d);
}

// p = z + β p, P p, and p · P p.
void SceneSolver::search(const SceneSystem &system, int unit) {
    const size_t first = system.unit_begin(unit), count = system.unit_end(unit) - first;
    double *p = searched_.data() + first, *Pp = image_.data() + first;
    const double *z = solved_.data() + first, *r = residual_.data() + first;
    double beta[most_lanes] = {}, of_lanes[most_lanes] = {};
    system.to_lanes(unit, beta_, beta);
    if (unit < system.group_count()) {
        RINGLET_DISPATCH(lane_search, z, r, beta, int(count / system.strands.stride()), p, Pp, of_lanes);
    } else {
        for (size_t i = 0; i < count; ++i) p[i] = z[i] + beta[0] * p[i];
        std::fill_n(Pp, count, 0.0);
        system.cloths[unit - system.group_count()].multiply_add(p, Pp);
        of_lanes[0] = dot(p, Pp, count);
    }
    system.from_lanes(unit, of_lanes, curvatures_);
}

// d += α p, r −= α A p, and what follows from r.
void SceneSolver::advance(SceneSystem &system, int unit, AlignedVector &direction) {
    const size_t first = system.unit_begin(unit), count = system.unit_end(unit) - first;
    double *d = direction.data() + first, *r = residual_.data() + first;
    const double *p = searched_.data() + first, *Pp = image_.data() + first;
    double alpha[most_lanes] = {};
    system.to_lanes(unit, alpha_, alpha);
    if (unit < system.group_count()) {
        RINGLET_DISPATCH(lane_advance, alpha, p, Pp, int(count / system.strands.stride()), d, r);
    } else {
        for (size_t i = 0; i < count; ++i) d[i] += alpha[0] * p[i];
        for (size_t i = 0; i < count; ++i) r[i] -= alpha[0] * Pp[i];
    }
    system.subtract_pushes(unit, alpha_, residual_);
    precondition(system, unit);
}

} // namespace ringlet
