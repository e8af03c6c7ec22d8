#include "ringlet/solver/scene_solver.h"

#include "ringlet/solver/lane_vectors.h"

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

double dot(const std::vector<double> &a, const std::vector<double> &b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

} // namespace

void SceneSolver::prepare(SceneSystem &system, const AlignedVector &x, System how) {
    how = choose(system, how);
    if (alone_.size() != system.strands.size()) alone_ = AlignedVector(system.strands.size());
    cloths_.resize(system.cloths.size());
    products_.assign(system.vertices.parts(), 0.0);
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
    const size_t first = system.unit_begin(unit), count = system.unit_end(unit) - first;
    double products[most_lanes] = {};
    if (unit < system.group_count()) {
        double *z = alone_.data() + first;
        system.negative_gradient(unit, z);
        system.precondition(unit, z);
        const StrandGroupSystem &group = system.strands.system(unit);
        RINGLET_DISPATCH(lane_products, group.gradient, z, group.dofs() * group.vertices, products);
        for (double &product : products) product = -product;
    } else {
        OfCloth &cloth = cloths_[unit - system.group_count()];
        for (std::vector<double> *vector : {&cloth.r, &cloth.p, &cloth.Ap}) vector->assign(count, 0.0);
        system.negative_gradient(unit, cloth.r.data());
        cloth.z = cloth.r;
        system.precondition(unit, cloth.z.data());
        products[0] = dot(cloth.r, cloth.z);
    }
    system.from_lanes(unit, products, products_);
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

// Preconditioned by P, from where strands would go by P alone: for them nothing is left then but C d, at the points that are
// coupled, and so it stays. P p follows from P z = r by the same recursion as p from z, and how far strands go from there from
// what they have borne at these points. Of a cloth P has only an incomplete factor: there vectors are whole, and A p is
// formed. Clusters are systems of their own, and each goes its own number of steps, until little is left of it or of all; but
// a cloth sets out from nowhere, and beside strands that have much to do little of it would count: it goes on until little is
// left of what it began with itself, an iteration at least: what began as hair that pushed it hair may have taken away.
SceneSolver::Result SceneSolver::conjugate_gradient(SceneSystem &system, double tolerance, AlignedVector &direction) {
    constexpr int most = 2000;
    const int parts = system.vertices.parts();
    const std::vector<int> &cluster = system.clusters();
    const auto sum = [&](const std::vector<double> &of_parts, std::vector<double> &of_clusters) {
        of_clusters.assign(parts, 0.0);
        for (int p = 0; p < parts; ++p)
            if (!system.is_alone(p)) of_clusters[cluster[p]] += of_parts[p];
    };
    std::vector<double> rho, next, curvature, alpha(parts), beta(parts);
    std::vector<unsigned char> busy(parts), busy_units, went(system.unit_count(), 0);
    sum(products_, rho);
    const double all = std::accumulate(rho.begin(), rho.end(), 0.0);
    std::vector<double> enough = rho;
    for (double &of_cluster : enough) of_cluster *= tolerance * tolerance;
    std::vector<double> enough_of_cloths;
    for (int p = system.vertices.strands; p < parts; ++p) enough_of_cloths.push_back(tolerance * tolerance * products_[p]);
    set_out(system, direction);
    sum(products_, rho);
    Result result;
    for (;; ++result.iterations) {
        const bool enough_of_all = std::accumulate(rho.begin(), rho.end(), 0.0) <= tolerance * tolerance * all;
        std::vector<unsigned char> goes_on(parts, 0); // clusters
        for (int p = 0; p < parts; ++p) goes_on[p] = !enough_of_all && rho[p] > enough[p];
        for (size_t c = 0; c < enough_of_cloths.size(); ++c) {
            const int part = system.vertices.strands + int(c);
            const bool has_enough = result.iterations > 0 && products_[part] <= enough_of_cloths[c];
            goes_on[cluster[part]] |= rho[cluster[part]] > 0.0 && !has_enough;
        }
        bool any = false;
        busy_units.assign(system.unit_count(), 0);
        for (int p = 0; p < parts; ++p) {
            busy[p] = goes_on[cluster[p]];
            if (!busy[p]) continue;
            any = true;
            busy_units[system.unit_of(p)] = 1;
        }
        if (!any || result.iterations == most) break;
        const auto for_busy = [&](const auto &work, bool backwards = false) {
            system.for_units(
                [&](int u) {
                    if (busy_units[u]) work(u);
                },
                backwards);
        };
        for_busy([&](int u) { search(system, u); });
        sum(curvatures_, curvature);
        system.couplings.push(p_, system.values(), busy, curvature);
        for (int p = 0; p < parts; ++p) { // of clusters, then of their parts
            if (busy[p] && cluster[p] == p) alpha[p] = curvature[p] > 0.0 ? rho[p] / curvature[p] : 0.0;
            alpha_[p] = busy[p] ? alpha[cluster[p]] : 0.0;
        }
        // To and fro: where factors do not all fit into the cache, those of the last are still there.
        const bool back = result.iterations % 2 != 0;
        for_busy(
            [&](int u) {
                advance(system, u, direction);
                went[u] = 1;
            },
            back);
        sum(products_, next);
        for (int p = 0; p < parts; ++p) {
            if (cluster[p] == p && busy[p]) {
                beta[p] = next[p] / rho[p];
                rho[p] = alpha[p] > 0.0 ? next[p] : 0.0;
            }
            beta_[p] = busy[p] ? beta[cluster[p]] : 0.0;
        }
    }
    system.for_units([&](int u) {
        if (went[u]) arrive(system, u, direction);
    });
    const double left = std::accumulate(rho.begin(), rho.end(), 0.0);
    result.residual = all > 0.0 ? std::sqrt(std::max(left, 0.0) / all) : 0.0;
    return result;
}

// d = P⁻¹ b of strands, 0 of cloths, and what is left then.
void SceneSolver::set_out(SceneSystem &system, AlignedVector &direction) {
    const int points = system.couplings.count(), parts = system.vertices.parts();
    for (std::vector<Vec3> *vector : {&r_, &z_, &p_, &Pp_, &borne_}) vector->assign(points, Vec3::Zero());
    for (std::vector<double> *of_parts : {&products_, &curvatures_, &beta_}) of_parts->assign(parts, 0.0);
    system.for_units([&](int u) {
        if (u >= system.group_count()) return;
        std::copy(alone_.data() + system.unit_begin(u), alone_.data() + system.unit_end(u),
                  direction.data() + system.unit_begin(u));
        for (int k = system.couplings.begin(u); k < system.couplings.end(u); ++k)
            p_[k] = system.position(direction, system.couplings.vertex(k));
    });
    std::vector<double> unused(parts, 0.0);
    system.couplings.push(p_, system.values(), std::vector<unsigned char>(parts, 1), unused);
    alpha_.assign(parts, 1.0);
    system.for_units([&](int u) { advance(system, u, direction); }, true);
}

// p = z + β p, P p, and p · P p.
void SceneSolver::search(const SceneSystem &system, int unit) {
    const Couplings &couplings = system.couplings;
    if (unit >= system.group_count()) {
        const int number = unit - system.group_count(), part = system.vertices.strands + number;
        OfCloth &cloth = cloths_[number];
        for (size_t i = 0; i < cloth.p.size(); ++i) cloth.p[i] = cloth.z[i] + beta_[part] * cloth.p[i];
        std::fill(cloth.Ap.begin(), cloth.Ap.end(), 0.0);
        system.cloths[number].multiply_add(cloth.p.data(), cloth.Ap.data());
        curvatures_[part] = dot(cloth.p, cloth.Ap);
        for (int k = couplings.begin(unit); k < couplings.end(unit); ++k)
            p_[k] = Eigen::Map<const Vec3>(&cloth.p[3 * (couplings.vertex(k) - system.vertices.cloths[number])]);
        return;
    }
    for (int k = couplings.begin(unit); k < couplings.end(unit); ++k) curvatures_[couplings.part(k)] = 0.0;
    for (int k = couplings.begin(unit); k < couplings.end(unit); ++k) {
        const int part = couplings.part(k);
        p_[k] = z_[k] + beta_[part] * p_[k];
        Pp_[k] = r_[k] + beta_[part] * Pp_[k];
        curvatures_[part] += p_[k].dot(Pp_[k]);
    }
}

// d += α p, r −= α A p, and what follows from r. What strands have borne stands for d.
void SceneSolver::advance(const SceneSystem &system, int unit, AlignedVector &direction) {
    const Couplings &couplings = system.couplings;
    if (unit >= system.group_count()) {
        const int number = unit - system.group_count(), part = system.vertices.strands + number;
        OfCloth &cloth = cloths_[number];
        double *d = direction.data() + system.unit_begin(unit);
        for (size_t i = 0; i < cloth.p.size(); ++i) d[i] += alpha_[part] * cloth.p[i];
        for (size_t i = 0; i < cloth.p.size(); ++i) cloth.r[i] -= alpha_[part] * cloth.Ap[i];
        for (int k = couplings.begin(unit); k < couplings.end(unit); ++k)
            Eigen::Map<Vec3>(&cloth.r[3 * (couplings.vertex(k) - system.vertices.cloths[number])]) -=
                alpha_[part] * couplings.pushed(k);
        cloth.z = cloth.r;
        system.precondition(unit, cloth.z.data());
        products_[part] = dot(cloth.r, cloth.z);
        return;
    }
    if (couplings.begin(unit) == couplings.end(unit)) return;
    for (int k = couplings.begin(unit); k < couplings.end(unit); ++k) {
        const double alpha = alpha_[couplings.part(k)];
        borne_[k] += alpha * Pp_[k];
        r_[k] -= alpha * (Pp_[k] + couplings.pushed(k));
    }
    const AlignedVector z = response(system, unit, r_);
    for (int k = couplings.begin(unit); k < couplings.end(unit); ++k) products_[couplings.part(k)] = 0.0;
    for (int k = couplings.begin(unit); k < couplings.end(unit); ++k) {
        const double *at = z.data() + (system.slot(couplings.vertex(k)) - system.unit_begin(unit));
        for (int i = 0; i < 3; ++i) z_[k][i] = at[i * system.strands.stride()];
        products_[couplings.part(k)] += r_[k].dot(z_[k]);
    }
}

// What a group of strands has borne at its points moves all of it.
void SceneSolver::arrive(const SceneSystem &system, int unit, AlignedVector &direction) const {
    if (unit >= system.group_count()) return;
    const AlignedVector more = response(system, unit, borne_);
    double *d = direction.data() + system.unit_begin(unit);
    for (size_t i = 0; i < more.size(); ++i) d[i] += more[i];
}

// P⁻¹ of what is at the points of a group of strands.
AlignedVector SceneSolver::response(const SceneSystem &system, int group, const std::vector<Vec3> &at_points) {
    AlignedVector b(system.unit_end(group) - system.unit_begin(group));
    for (int k = system.couplings.begin(group); k < system.couplings.end(group); ++k) {
        double *at = b.data() + (system.slot(system.couplings.vertex(k)) - system.unit_begin(group));
        for (int i = 0; i < 3; ++i) at[i * system.strands.stride()] = at_points[k][i];
    }
    system.precondition(group, b.data());
    return b;
}

} // namespace ringlet
