#include "ringlet/solver/block_iteration.h"

#include <algorithm>

namespace ringlet {
namespace {

// Where P is exact, the first iterate P⁻¹ b leaves the residual −C d, which is zero but at the coupled points, and so it stays:
// P p follows from P z = r by the recursion of p. The sum of α P p at the points stands for d until the end.
class ExactIteration final : public BlockIteration {
public:
    ExactIteration(Objective &objective, int block, IterationState &state, const CoarseSpace &coarse)
        : objective_(objective), number_(block), block_(objective.blocks[block]), state_(state), coarse_(coarse) {}

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
        const int first = begin(), count = end() - first;
        for (std::vector<Vec3> *vector : {&r_, &Pz_, &Pp_, &load_}) vector->assign(count, Vec3::Zero());
        std::copy(alone_.data(), alone_.data() + block_.size(), d);
        for (int k = 0; k < count; ++k) state_.p[first + k] = at(d, first + k);
    }

    void search() override {
        const int first = begin(), count = end() - first;
        for (int k = 0; k < count; ++k) state_.pPp[object(first + k)] = 0.0;
        for (int k = 0; k < count; ++k) {
            const int of = object(first + k);
            const Vec3 p = state_.z[first + k] + state_.beta[of] * state_.p[first + k], Pp = Pz_[k] + state_.beta[of] * Pp_[k];
            state_.p[first + k] = p, Pp_[k] = Pp;
            state_.pPp[of] += p.dot(Pp);
        }
    }

    void advance(double *) override {
        const int first = begin(), count = end() - first;
        for (int k = 0; k < count; ++k) {
            const double alpha = state_.alpha[object(first + k)];
            load_[k] += alpha * Pp_[k];
            r_[k] -= alpha * (Pp_[k] + objective_.couplings.product(first + k));
        }
    }

    void precondition() override {
        const int first = begin(), count = end() - first;
        if (count == 0) return;
        const AlignedVector z = response(r_);
        for (int k = 0; k < count; ++k) {
            state_.z[first + k] = at(z.data(), first + k);
            Pz_[k] = r_[k];
        }
        sum_products();
    }

    Vec3 residual(int point) const override { return r_[point - begin()]; }

    void correct() override {
        for (int k = 0; k < end() - begin(); ++k) {
            const bool any = coarse_.has(object(begin() + k));
            state_.p[begin() + k] = any ? coarse_.motion(begin() + k) : Vec3::Zero();
            Pp_[k] = any ? coarse_.force(begin() + k) : Vec3::Zero();
        }
    }

    void deflate() override {
        for (int k = 0; k < end() - begin(); ++k)
            if (coarse_.has(object(begin() + k))) {
                state_.z[begin() + k] += coarse_.motion(begin() + k);
                Pz_[k] += coarse_.force(begin() + k);
            }
        sum_products();
    }

    void measure(const double *) override {
        for (int k = 0; k < end() - begin(); ++k)
            state_.bd[object(begin() + k)] += at(alone_.data(), begin() + k).dot(load_[k]);
    }

    void finish(double *d) override {
        if (load_.empty()) return;
        const AlignedVector more = response(load_);
        for (size_t i = 0; i < more.size(); ++i) d[i] += more[i];
    }

private:
    int begin() const { return objective_.couplings.begin(number_); }
    int end() const { return objective_.couplings.end(number_); }
    int object(int point) const { return objective_.couplings.object(point); }

    void sum_products() {
        for (int k = 0; k < end() - begin(); ++k) state_.rz[object(begin() + k)] = 0.0;
        for (int k = 0; k < end() - begin(); ++k) state_.rz[object(begin() + k)] += r_[k].dot(state_.z[begin() + k]);
    }

    Vec3 at(const double *x, int point) const {
        const auto [first, stride] = objective_.blocks.slot(objective_.couplings.vertex(point));
        const double *from = x + (first - objective_.blocks.begin(number_));
        return {from[0], from[stride], from[2 * size_t(stride)]};
    }

    // P⁻¹ of a vector that is zero but at the points.
    AlignedVector response(const std::vector<Vec3> &at_points) const {
        AlignedVector b(block_.size());
        double *const x = b.data() - objective_.blocks.begin(number_);
        int point = begin();
        for (const Vec3 &value : at_points) {
            const auto [first, stride] = objective_.blocks.slot(objective_.couplings.vertex(point++));
            for (int i = 0; i < 3; ++i) x[first + size_t(i) * stride] = value[i];
        }
        block_.solve(b.data());
        return b;
    }

    Objective &objective_;
    int number_;
    Block &block_;
    IterationState &state_;
    const CoarseSpace &coarse_;
    AlignedVector alone_;                  // P⁻¹ b
    std::vector<Vec3> r_, Pz_, Pp_, load_; // at the points
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
    }

    void precondition() override {
        z_ = r_;
        block_.solve(z_.data());
        lane_dots(r_.data(), z_.data(), block_.rows(), 1, &state_.rz[object()]);
        for_points([&](int k, size_t i) { state_.z[k] = Eigen::Map<const Vec3>(&z_[i]); });
    }

    Vec3 residual(int point) const override { return Eigen::Map<const Vec3>(&r_[entry(point)]); }
    void correct() override {
        for_points([&](int k, size_t) { state_.p[k].setZero(); });
    }
    void deflate() override {}

    void measure(const double *d) override {
        lane_dots(block_.gradient(), d, block_.rows(), 1, &state_.bd[object()]);
        state_.bd[object()] *= -1.0;
    }

    void finish(double *) override {}

private:
    int object() const { return block_.objects().front().number; }

    template <class Work> void for_points(const Work &work) const { // work(point, entry of the block's vectors)
        const Couplings &couplings = objective_.couplings;
        for (int k = couplings.begin(number_); k < couplings.end(number_); ++k) work(k, entry(k));
    }
    size_t entry(int point) const { // of the block's vectors
        return objective_.blocks.slot(objective_.couplings.vertex(point)).first - objective_.blocks.begin(number_);
    }

    Objective &objective_;
    int number_;
    Block &block_;
    IterationState &state_;
    std::vector<double> r_, z_, p_, Ap_;
};

} // namespace

void IterationState::resize(int objects, int points) {
    for (std::vector<double> *numbers : {&rz, &pPp, &alpha, &beta, &bd}) numbers->assign(objects, 0.0);
    for (std::vector<Vec3> *vector : {&p, &z}) vector->assign(points, Vec3::Zero());
}

std::unique_ptr<BlockIteration> BlockIteration::make(Objective &objective, int block, IterationState &state,
                                                     const CoarseSpace &coarse) {
    if (objective.blocks[block].is_exact()) return std::make_unique<ExactIteration>(objective, block, state, coarse);
    return std::make_unique<InexactIteration>(objective, block, state);
}

} // namespace ringlet
