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

template <class Work>
void CoupledSystem::for_blocks(const Mask &blocks, const Work &work, bool backwards, LoopSite site) const {
    objective_.blocks.for_active(
        [&](int b) {
            if (blocks[b]) work(b);
        },
        backwards, site);
}

template <class Work> void CoupledSystem::for_objects(int b, const Work &work) const {
    for (const BlockObject &object : objective_.blocks[b].objects())
        if (const auto [first, end] = objective_.couplings.of_object(object.number); first < end)
            work(object.number, first, end);
}

void CoupledSystem::begin() {
    for (Numbers *numbers : {&alone_products_, &rz_, &pAp_, &bd_}) numbers->assign(clusters(), 0.0);
    joint_.clear();
    for (int object = 0; object < int(clusters()); ++object)
        if (!objective_.is_alone(object)) joint_.push_back(object);
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
    const Mask all(clusters(), 1), blocks = blocks_with(all);
    Unknowns joint, before;
    Residual d, forces;
    for (auto *points : {&r, &x.at, &x.force, &d, &forces, &joint.at, &joint.force, &before.at, &before.force})
        points->resize(couplings.count());
    for_blocks(blocks, [&](int b) {
        for (int k = couplings.begin(b); k < couplings.end(b); ++k) {
            for (Unknowns *of : {&x, &joint, &before}) of->at[k] = of->force[k] = Vec3::Zero();
            d[k] = is_exact(b) ? at(k, b, objective_.blocks.of(b, alone_)) : Vec3::Zero();
            r[k] = is_exact(b) ? Vec3::Zero() : Vec3(-at(k, b, objective_.blocks[b].gradient()));
        }
    });
    couplings.multiply(d, objective_.pair_values(), all);
    for_blocks(blocks, [&](int b) {
        for (int k = couplings.begin(b); k < couplings.end(b); ++k) r[k] -= couplings.product(k);
    });
    if (!coarse_.empty()) {
        coarse_.find_coefficients([&](int k) { return r[k]; });
        for_blocks(blocks, [&](int b) { coarse_.add_correction(b, joint.at, joint.force); });
        extend(joint, Numbers(clusters(), 0.0), before, forces, all);
        for_blocks(blocks, [&](int b) {
            for (int k = couplings.begin(b); k < couplings.end(b); ++k)
                x.at[k] = joint.at[k], x.force[k] = joint.force[k], r[k] -= forces[k];
        });
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

CoupledSystem::Numbers CoupledSystem::extend(const Unknowns &z, const Numbers &beta, Unknowns &p, Residual &Ap,
                                             const Mask &busy) {
    Couplings &couplings = objective_.couplings;
    const Mask blocks = blocks_with(busy);
    for_blocks(blocks, [&](int b) {
        for_objects(b, [&](int object, int first, int end) {
            const double of_old = beta[cluster(object)];
            flat(p.at, first, end) = flat(z.at, first, end) + of_old * flat(p.at, first, end);
            flat(p.force, first, end) = flat(z.force, first, end) + of_old * flat(p.force, first, end);
        });
        if (const int first = couplings.begin(b); !is_exact(b)) {
            flat(p.force, first, couplings.end(b)).setZero();
            objective_.blocks[b].multiply_add(p.at[first].data(), p.force[first].data());
        }
    });
    couplings.multiply(p.at, objective_.pair_values(), busy);
    for_blocks(blocks, [&](int b) {
        for_objects(b, [&](int object, int first, int end) {
            double curvature = 0.0;
            for (int k = first; k < end; ++k) {
                Ap[k] = p.force[k];
                if (couplings.couples(object)) Ap[k] += couplings.product(k);
                curvature += p.at[k].dot(Ap[k]);
            }
            pAp_[object] = curvature;
        });
    });
    return of_clusters(pAp_);
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
CoupledSystem::Numbers CoupledSystem::advance(const Numbers &alpha, const Unknowns &p, const Residual &Ap, Unknowns &x,
                                              Residual &r, Unknowns &z, const Mask &busy) {
    Couplings &couplings = objective_.couplings;
    const Mask blocks = blocks_with(busy);
    backwards_ = !backwards_;
    for_blocks(
        blocks,
        [&](int b) {
            for_objects(b, [&](int object, int first, int end) {
                const double of_step = alpha[cluster(object)];
                flat(x.at, first, end) += of_step * flat(p.at, first, end);
                flat(x.force, first, end) += of_step * flat(p.force, first, end);
                flat(r, first, end) -= of_step * flat(Ap, first, end);
                bd_[object] = work_of(b, object, x);
            });
            precondition_block(b, r, z);
        },
        backwards_);
    if (!coarse_.empty()) {
        couplings.multiply(z.at, objective_.pair_values(), busy);
        coarse_.find_coefficients([&](int k) { return Vec3(-couplings.product(k)); });
    }
    for_blocks(blocks, [&](int b) {
        if (!coarse_.empty()) coarse_.add_correction(b, z.at, z.force);
        for_objects(b, [&](int object, int first, int end) {
            double product = 0.0;
            for (int k = first; k < end; ++k) product += r[k].dot(z.at[k]);
            rz_[object] = product;
        });
    });
    return of_clusters(rz_);
}

// b · d of an object.
double CoupledSystem::work_of(int b, int object, const Unknowns &x) const {
    const auto [first, end] = objective_.couplings.of_object(object);
    if (!is_exact(b)) {
        const Eigen::Map<const Eigen::VectorXd> gradient(objective_.blocks[b].gradient(), 3 * (end - first));
        return -gradient.dot(flat(x.at, first, end));
    }
    const double *const alone = objective_.blocks.of(b, alone_);
    double sum = alone_products_[object];
    for (int k = first; k < end; ++k) sum += at(k, b, alone).dot(x.force[k]);
    return sum;
}

CoupledSystem::Numbers CoupledSystem::of_clusters(const Numbers &of_objects) const {
    Numbers sums(of_objects.size(), 0.0);
    for (const int object : joint_) sums[cluster(object)] += of_objects[object];
    return sums;
}

} // namespace ringlet
