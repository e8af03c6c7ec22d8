#include "ringlet/solver/block_iteration.h"

#include <algorithm>

namespace ringlet {
namespace {

// Where P is exact, the first iterate P⁻¹ b leaves the residual −C d, which is zero but at the coupled points, and so it stays:
// P p follows from P z = r by the recursion of p. The sum of α P p at the points stands for d until the end.
class ExactIteration final : public BlockIteration {
public:
    ExactIteration(Objective &objective, int block, IterationState &state)
        : objective_(objective), number_(block), block_(objective.blocks[block]), state_(state) {}

    void start() override {
        block_.factor();
        if (alone_.size() != block_.size()) alone_ = AlignedVector(block_.size());
        const double *gradient = block_.gradient();
        std::transform(gradient, gradient + block_.unknowns(), alone_.data(), [](double g) { return -g; });
        std::fill(alone_.data() + block_.unknowns(), alone_.data() + block_.size(), 0.0);
        block_.solve(alone_.data());
        double products[max_lanes] = {};
        lane_dots(gradient, alone_.data(), block_.rows(), block_.lanes(), products);
        for (double &product : products) product = -product;
        objective_.blocks.from_lanes(number_, products, state_.rz);
    }

    void first_iterate(double *d) override {
        for (std::vector<Vec3> *vector : {&r_, &z_, &Pp_, &load_}) vector->assign(end() - begin(), Vec3::Zero());
        std::copy(alone_.data(), alone_.data() + block_.size(), d);
        for (int k = begin(); k < end(); ++k) state_.p[k] = at(d, k);
    }

    void search() override {
        for (int k = begin(); k < end(); ++k) state_.pPp[object(k)] = 0.0;
        for (int k = begin(); k < end(); ++k) {
            const double beta = state_.beta[object(k)];
            Vec3 &p = state_.p[k], &Pp = Pp_[k - begin()];
            p = z_[k - begin()] + beta * p;
            Pp = r_[k - begin()] + beta * Pp;
            state_.pPp[object(k)] += p.dot(Pp);
        }
    }

    void advance(double *) override {
        if (begin() == end()) return;
        for (int k = begin(); k < end(); ++k) {
            const double alpha = state_.alpha[object(k)];
            const Vec3 &Pp = Pp_[k - begin()];
            load_[k - begin()] += alpha * Pp;
            r_[k - begin()] -= alpha * (Pp + objective_.couplings.product(k));
        }
        const AlignedVector z = response(r_);
        for (int k = begin(); k < end(); ++k) state_.rz[object(k)] = 0.0;
        for (int k = begin(); k < end(); ++k) {
            z_[k - begin()] = at(z.data(), k);
            state_.rz[object(k)] += r_[k - begin()].dot(z_[k - begin()]);
        }
    }

    void finish(double *d) override {
        const AlignedVector more = response(load_);
        for (size_t i = 0; i < more.size(); ++i) d[i] += more[i];
    }

private:
    int begin() const { return objective_.couplings.begin(number_); }
    int end() const { return objective_.couplings.end(number_); }
    int object(int point) const { return objective_.couplings.object(point); }

    Vec3 at(const double *x, int point) const {
        const auto [first, stride] = objective_.blocks.slot(objective_.couplings.vertex(point));
        const double *from = x + (first - objective_.blocks.begin(number_));
        return {from[0], from[stride], from[2 * size_t(stride)]};
    }

    // P⁻¹ of a vector that is zero but at the points.
    AlignedVector response(const std::vector<Vec3> &at_points) const {
        AlignedVector b(block_.size());
        for (int k = begin(); k < end(); ++k) {
            const auto [first, stride] = objective_.blocks.slot(objective_.couplings.vertex(k));
            double *to = b.data() + (first - objective_.blocks.begin(number_));
            for (int i = 0; i < 3; ++i) to[size_t(i) * stride] = at_points[k - begin()][i];
        }
        block_.solve(b.data());
        return b;
    }

    Objective &objective_;
    int number_;
    Block &block_;
    IterationState &state_;
    AlignedVector alone_;                 // P⁻¹ b
    std::vector<Vec3> r_, z_, Pp_, load_; // at the points
};

// Where P has only an incomplete factor, vectors are those of the whole block, and A p is formed. It has one lane.
class InexactIteration final : public BlockIteration {
public:
    InexactIteration(Objective &objective, int block, IterationState &state)
        : objective_(objective), number_(block), block_(objective.blocks[block]), state_(state) {}

    void start() override {
        block_.factor();
        for (std::vector<double> *vector : {&r_, &p_, &Ap_}) vector->assign(block_.size(), 0.0);
        std::transform(block_.gradient(), block_.gradient() + block_.unknowns(), r_.begin(), [](double g) { return -g; });
        precondition();
    }

    void first_iterate(double *) override {}

    void search() override {
        for (size_t i = 0; i < p_.size(); ++i) p_[i] = z_[i] + state_.beta[object()] * p_[i];
        std::fill(Ap_.begin(), Ap_.end(), 0.0);
        block_.multiply_add(p_.data(), Ap_.data());
        lane_dots(p_.data(), Ap_.data(), block_.rows(), 1, &state_.pPp[object()]);
        for_points([&](int k, size_t i) { state_.p[k] = Eigen::Map<const Vec3>(&p_[i]); });
    }

    void advance(double *d) override {
        const double alpha = state_.alpha[object()];
        for (size_t i = 0; i < p_.size(); ++i) d[i] += alpha * p_[i];
        for (size_t i = 0; i < p_.size(); ++i) r_[i] -= alpha * Ap_[i];
        for_points([&](int k, size_t i) { Eigen::Map<Vec3>(&r_[i]) -= alpha * objective_.couplings.product(k); });
        precondition();
    }

    void finish(double *) override {}

private:
    int object() const { return block_.objects().front().number; }

    void precondition() {
        z_ = r_;
        block_.solve(z_.data());
        lane_dots(r_.data(), z_.data(), block_.rows(), 1, &state_.rz[object()]);
    }

    template <class Work> void for_points(const Work &work) const { // work(point, entry of the block's vectors)
        const Couplings &couplings = objective_.couplings;
        for (int k = couplings.begin(number_); k < couplings.end(number_); ++k)
            work(k, objective_.blocks.slot(couplings.vertex(k)).first - objective_.blocks.begin(number_));
    }

    Objective &objective_;
    int number_;
    Block &block_;
    IterationState &state_;
    std::vector<double> r_, z_, p_, Ap_;
};

} // namespace

void IterationState::resize(int objects, int points) {
    for (std::vector<double> *numbers : {&rz, &pPp, &alpha, &beta}) numbers->assign(objects, 0.0);
    p.assign(points, Vec3::Zero());
}

std::unique_ptr<BlockIteration> BlockIteration::make(Objective &objective, int block, IterationState &state) {
    if (objective.blocks[block].is_exact()) return std::make_unique<ExactIteration>(objective, block, state);
    return std::make_unique<InexactIteration>(objective, block, state);
}

} // namespace ringlet
