#include "ringlet/solver/coupled_system.h"

#include <algorithm>

namespace ringlet {
namespace {

auto flat(std::vector<Vec3> &points, int first, int end) {
    return Eigen::Map<Eigen::VectorXd>(points.data()->data() + 3 * size_t(first), 3 * (end - first));
}
auto flat(const std::vector<Vec3> &points, int first, int end) {
    return Eigen::Map<const Eigen::VectorXd>(points.data()->data() + 3 * size_t(first), 3 * (end - first));
}

} // namespace

CoupledSystem::CoupledSystem(Objective &objective) : objective_(objective), coarse_(objective) {}

// Calls work(block) for those with busy objects.
template <class Work> void CoupledSystem::for_busy(const Mask &busy, const Work &work, bool backwards) const {
    const Mask blocks = objective_.blocks.blocks_with(busy);
    objective_.blocks.for_active(
        [&](int b) {
            if (blocks[b]) work(b);
        },
        backwards);
}

// Calls work(object, first point, their end) for the objects of blocks with busy ones.
template <class Work> void CoupledSystem::for_objects(const Mask &busy, const Work &work) const {
    for_busy(busy, [&](int b) {
        for (const BlockObject &object : objective_.blocks[b].objects())
            if (const auto [first, end] = objective_.couplings.of_object(object.number); first < end)
                work(object.number, first, end);
    });
}

void CoupledSystem::begin() {
    for (Numbers *numbers : {&alone_products_, &rz_, &pPp_, &bd_}) numbers->assign(clusters(), 0.0);
    if (alone_.size() != objective_.blocks.size()) alone_ = AlignedVector(objective_.blocks.size());
    coarse_.find_forces();
}

void CoupledSystem::begin_block(int b) {
    Block &block = objective_.blocks[b];
    block.factor();
    double *const alone = objective_.blocks.of(b, alone_);
    std::transform(block.gradient(), block.gradient() + block.unknowns(), alone, [](double g) { return -g; });
    block.solve(alone);
    double products[max_lanes] = {};
    lane_dots(block.gradient(), alone, block.rows(), block.lanes(), products);
    for (double &product : products) product = -product;
    objective_.blocks.from_lanes(b, products, alone_products_);
    coarse_.find_responses(b);
}

Vec3 CoupledSystem::at(int point, int block, const double *of_block) const {
    const auto [first, stride] = objective_.blocks.slot(objective_.couplings.vertex(point));
    const double *const from = of_block + (first - objective_.blocks.begin(block));
    return {from[0], from[stride], from[2 * size_t(stride)]};
}

// P⁻¹ of a vector that is zero but at the points.
AlignedVector CoupledSystem::solve(int b, const std::vector<Vec3> &at_points) const {
    const BlockSet &blocks = objective_.blocks;
    AlignedVector x(blocks[b].size());
    double *const of_all = x.data() - blocks.begin(b);
    for (int k = objective_.couplings.begin(b); k < objective_.couplings.end(b); ++k) {
        const auto [first, stride] = blocks.slot(objective_.couplings.vertex(k));
        for (int i = 0; i < 3; ++i) of_all[first + size_t(i) * stride] = at_points[k][i];
    }
    blocks[b].solve(x.data());
    return x;
}

void CoupledSystem::first_iterate(Residual &r, Unknowns &x) {
    Couplings &couplings = objective_.couplings;
    const Mask all(clusters(), 1);
    const std::vector<Vec3> zero(couplings.count(), Vec3::Zero());
    Numbers unused(clusters(), 0.0);
    r = zero, x = {zero, zero};
    std::vector<Vec3> d = zero;
    for_busy(all, [&](int b) {
        for (int k = couplings.begin(b); k < couplings.end(b); ++k) {
            if (is_exact(b))
                d[k] = at(k, b, objective_.blocks.of(b, alone_));
            else
                r[k] = -at(k, b, objective_.blocks[b].gradient());
        }
    });
    couplings.multiply(d, objective_.pair_values(), all, unused);
    for_objects(all, [&](int, int first, int end) {
        for (int k = first; k < end; ++k) r[k] -= couplings.product(k);
    });
    if (!coarse_.empty()) {
        const Numbers whole(clusters(), 1.0);
        Unknowns joint{zero, zero};
        Residual forces = zero;
        coarse_.add_correction([&](int k) { return r[k]; }, joint.at, joint.force);
        multiply(joint, forces, all);
        add(whole, joint, x, all);
        subtract(whole, forces, r, all);
    }
    backwards_ = false;
}

void CoupledSystem::solution(const Unknowns &x, AlignedVector &d) {
    const BlockSet &blocks = objective_.blocks;
    blocks.for_active([&](int b) {
        double *const of_block = blocks.of(b, d);
        if (is_exact(b)) {
            std::copy_n(blocks.of(b, alone_), blocks[b].size(), of_block);
            if (objective_.couplings.begin(b) == objective_.couplings.end(b)) return;
            const AlignedVector more = solve(b, x.force);
            for (size_t i = 0; i < more.size(); ++i) of_block[i] += more[i];
        } else {
            std::copy_n(x.at[objective_.couplings.begin(b)].data(), blocks[b].unknowns(), of_block);
        }
    });
}

CoupledSystem::Numbers CoupledSystem::multiply(Unknowns &p, Residual &Ap, const Mask &busy) {
    Couplings &couplings = objective_.couplings;
    for_busy(busy, [&](int b) {
        if (const int first = couplings.begin(b); !is_exact(b)) {
            flat(p.force, first, couplings.end(b)).setZero();
            objective_.blocks[b].multiply_add(p.at[first].data(), p.force[first].data());
        }
        set_products(b, p.at, p.force, pPp_);
    });
    Numbers curvature = of_clusters(pPp_);
    couplings.multiply(p.at, objective_.pair_values(), busy, curvature);
    for_objects(busy, [&](int object, int first, int end) {
        flat(Ap, first, end) = flat(p.force, first, end);
        for (int k = first; k < end && couplings.couples(object); ++k) Ap[k] += couplings.product(k);
    });
    return curvature;
}

void CoupledSystem::precondition_block(int b, const Residual &r, Unknowns &z) const {
    const int first = objective_.couplings.begin(b), end = objective_.couplings.end(b);
    if (first == end) return;
    if (!is_exact(b)) {
        flat(z.at, first, end) = flat(r, first, end);
        return objective_.blocks[b].solve(z.at[first].data());
    }
    flat(z.force, first, end) = flat(r, first, end);
    const AlignedVector solved = solve(b, r);
    for (int k = first; k < end; ++k) z.at[k] = at(k, b, solved.data());
}

// After the blocks the coarse space, so that the iteration does not return to its motions (A-DEF2: Tang et al. 2009).
// Alternating directions reuse the factors that are still in the cache.
CoupledSystem::Numbers CoupledSystem::precondition(const Residual &r, Unknowns &z, const Mask &busy) {
    Couplings &couplings = objective_.couplings;
    backwards_ = !backwards_;
    for_busy(busy, [&](int b) { precondition_block(b, r, z); }, backwards_);
    if (!coarse_.empty()) {
        Numbers unused(clusters(), 0.0);
        couplings.multiply(z.at, objective_.pair_values(), busy, unused);
        coarse_.add_correction([&](int k) { return Vec3(-couplings.product(k)); }, z.at, z.force);
    }
    for_busy(busy, [&](int b) { set_products(b, r, z.at, rz_); });
    return of_clusters(rz_);
}

void CoupledSystem::add(const Numbers &alpha, const Unknowns &p, Unknowns &x, const Mask &busy) const {
    for_objects(busy, [&](int object, int first, int end) {
        const double a = alpha[cluster(object)];
        flat(x.at, first, end) += a * flat(p.at, first, end);
        flat(x.force, first, end) += a * flat(p.force, first, end);
    });
}

void CoupledSystem::subtract(const Numbers &alpha, const Residual &Ap, Residual &r, const Mask &busy) const {
    for_objects(busy,
                [&](int object, int first, int end) { flat(r, first, end) -= alpha[cluster(object)] * flat(Ap, first, end); });
}

void CoupledSystem::extend(const Unknowns &z, const Numbers &beta, Unknowns &p, const Mask &busy) const {
    for_objects(busy, [&](int object, int first, int end) {
        const double b = beta[cluster(object)];
        flat(p.at, first, end) = flat(z.at, first, end) + b * flat(p.at, first, end);
        flat(p.force, first, end) = flat(z.force, first, end) + b * flat(p.force, first, end);
    });
}

CoupledSystem::Numbers CoupledSystem::work(const Unknowns &x, const Mask &busy) {
    for_busy(busy, [&](int b) {
        const double *const alone = objective_.blocks.of(b, alone_);
        for (const BlockObject &object : objective_.blocks[b].objects()) {
            const auto [first, end] = objective_.couplings.of_object(object.number);
            double &bd = bd_[object.number];
            if (!is_exact(b)) {
                const Eigen::Map<const Eigen::VectorXd> gradient(objective_.blocks[b].gradient(), 3 * (end - first));
                bd = -gradient.dot(flat(x.at, first, end));
            } else {
                bd = alone_products_[object.number];
                for (int k = first; k < end; ++k) bd += at(k, b, alone).dot(x.force[k]);
            }
        }
    });
    return of_clusters(bd_);
}

void CoupledSystem::set_products(int b, const std::vector<Vec3> &x, const std::vector<Vec3> &y, Numbers &of_objects) const {
    for (const BlockObject &object : objective_.blocks[b].objects()) {
        const auto [first, end] = objective_.couplings.of_object(object.number);
        double sum = 0.0;
        for (int k = first; k < end; ++k) sum += x[k].dot(y[k]);
        of_objects[object.number] = sum;
    }
}

CoupledSystem::Numbers CoupledSystem::of_clusters(const Numbers &of_objects) const {
    Numbers sums(of_objects.size(), 0.0);
    for (size_t object = 0; object < sums.size(); ++object)
        if (!objective_.is_alone(int(object))) sums[objective_.couplings.clusters()[object]] += of_objects[object];
    return sums;
}

} // namespace ringlet
