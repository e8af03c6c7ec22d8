#include "ringlet/solver/coarse_space.h"

#include "ringlet/math/lists.h"
#include "ringlet/solver/settings.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numeric>

namespace ringlet {
namespace {

// Amounts of the shapes at a vertex of an object.
std::array<double, CoarseSpace::shapes> shapes_at(int vertex, const BlockObject &object) {
    const int last = object.end - 1 - object.first;
    const double t = last > 0 ? double(vertex - object.first) / last : 1.0;
    return {t, t * t};
}

// Halves a set of objects at the median along its longest axis, until no part has more than `most`.
template <class Done> void bisect(std::vector<int> objects, View<Vec3> centres, size_t most, const Done &done) {
    if (objects.size() <= most) return done(objects);
    Vec3 mean = Vec3::Zero();
    for (const int o : objects) mean += centres[o] / double(objects.size());
    Mat3 spread = Mat3::Zero();
    for (const int o : objects) spread += (centres[o] - mean) * (centres[o] - mean).transpose();
    const Vec3 axis = Eigen::SelfAdjointEigenSolver<Mat3>(spread).eigenvectors().col(2);
    std::stable_sort(objects.begin(), objects.end(),
                     [&](int a, int b) { return axis.dot(centres[a] - mean) < axis.dot(centres[b] - mean); });
    const auto middle = objects.begin() + objects.size() / 2;
    bisect({objects.begin(), middle}, centres, most, done);
    bisect({middle, objects.end()}, centres, most, done);
}

} // namespace

void CoarseSpace::clear() {
    aggregates_ = 0;
    aggregate_.assign(objective_.blocks.objects(), -1);
    in_cluster_.assign(objective_.blocks.objects(), 0);
    clusters_.clear();
}

void CoarseSpace::find_forces() {
    aggregate();
    const Couplings &couplings = objective_.couplings;
    forces_.assign(couplings.count(), Columns::Zero());
    responses_.assign(couplings.count(), Columns::Zero());
    if (empty()) return;
    for (const Couplings::Coupling &coupling : couplings.all()) {
        const Mat3 &hessian = objective_.contact_values()[coupling.contact].hessian;
        for (int side = 0; side < 2; ++side) {
            const int object = coupling.objects[side];
            if (!has(object)) continue;
            const BlockObject &of = objective_.blocks.of_object(object).objects()[objective_.blocks.lane_of(object)];
            std::array<double, shapes> amounts{};
            const int begin = side == 0 ? 0 : coupling.first, end = side == 0 ? coupling.first : 4;
            for (int i = begin; i < end; ++i)
                if (coupling.point[i] >= 0)
                    for (int k = 0; k < shapes; ++k)
                        amounts[k] += coupling.weight[i] * shapes_at(couplings.vertex(coupling.point[i]), of)[k];
            for (int i = begin; i < end; ++i)
                if (coupling.point[i] >= 0)
                    for (int k = 0; k < shapes; ++k)
                        forces_[coupling.point[i]].template middleCols<3>(3 * k) += coupling.weight[i] * amounts[k] * hessian;
        }
    }
}

// Objects of exact blocks that something couples, by cluster. Where each touches many, E would fill up as it is factored: there
// some that are close together share their columns.
void CoarseSpace::aggregate() {
    const BlockSet &blocks = objective_.blocks;
    const Couplings &couplings = objective_.couplings;
    const int objects = blocks.objects();
    clear();
    const auto takes_part = [&](int object) {
        return couplings.couples(object) && blocks.is_active(object) && blocks.of_object(object).is_exact();
    };
    std::vector<std::pair<int, int>> pairs; // of objects
    for (const Couplings::Coupling &coupling : couplings.all())
        pairs.emplace_back(std::minmax(coupling.objects[0], coupling.objects[1]));
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    std::vector<double> ends(objects, 0.0); // of pairs, per cluster
    for (const auto &[a, b] : pairs) ends[couplings.clusters()[a]] += 2.0;

    const Lists<int> members(objects, [&](const auto &add) {
        for (int object = 0; object < objects; ++object)
            if (takes_part(object)) add(couplings.clusters()[object], object);
    });
    std::vector<Vec3> centres(objects, Vec3::Zero());
    for (int cluster = 0; cluster < objects; ++cluster) {
        const View<int> of = members.of(cluster);
        if (of.size() < solver_settings::least_cluster) continue;
        in_cluster_[cluster] = 1;
        const int first = aggregates_;
        const double neighbours = ends[cluster] / double(of.size());
        size_t most = 1;
        for (const auto &[above, size] : solver_settings::aggregate_sizes)
            if (neighbours > above) most = size;
        if (most > 1)
            for (const int object : of) {
                const BlockObject &place = blocks.of_object(object).objects()[blocks.lane_of(object)];
                for (int v = place.first; v < place.end; ++v)
                    centres[object] += objective_.position(v) / double(place.end - place.first);
            }
        bisect({of.begin(), of.end()}, centres, most, [&](const std::vector<int> &part) {
            for (const int object : part) aggregate_[object] = aggregates_;
            ++aggregates_;
        });
        clusters_.push_back({first, aggregates_, false, {}});
    }
}

void CoarseSpace::find_responses(int number) {
    const Couplings &couplings = objective_.couplings;
    const BlockSet &blocks = objective_.blocks;
    const int begin = couplings.begin(number), end = couplings.end(number);
    if (begin == end || !blocks[number].is_exact()) return;
    AlignedVector b(blocks[number].size());
    for (int column = 0; column < columns; ++column) {
        b.fill(0.0);
        double *const x = b.data() - blocks.begin(number);
        for (int point = begin; point < end; ++point) {
            const auto [first, stride] = blocks.slot(couplings.vertex(point));
            for (int i = 0; i < 3; ++i) x[first + size_t(i) * stride] = forces_[point](i, column);
        }
        blocks[number].solve(b.data());
        for (int point = begin; point < end; ++point) {
            const auto [first, stride] = blocks.slot(couplings.vertex(point));
            for (int i = 0; i < 3; ++i) responses_[point](i, column) = x[first + size_t(i) * stride];
        }
    }
}

CoarseSpace::Columns CoarseSpace::side(const Couplings::Coupling &coupling, int side) const {
    Columns sum = Columns::Zero();
    for (int i = side == 0 ? 0 : coupling.first; i < (side == 0 ? coupling.first : 4); ++i)
        if (coupling.point[i] >= 0) sum += coupling.weight[i] * responses_[coupling.point[i]];
    return sum;
}

void CoarseSpace::factor() {
    using Block = BlockCholesky<columns>::Block;
    using Entry = BlockCholesky<columns>::Entry;
    const Couplings &couplings = objective_.couplings;
    const Lists<int> points(aggregates_, [&](const auto &add) {
        for (int point = 0; point < couplings.count(); ++point)
            if (const int a = aggregate_[couplings.object(point)]; a >= 0) add(a, point);
    });
    // A coupling belongs to the aggregate with the larger number.
    const Lists<int> rows(aggregates_, [&](const auto &add) {
        for (int k = 0; k < int(couplings.all().size()); ++k) {
            const auto [a, b] = couplings.all()[k].objects;
            if (has(a) && has(b)) add(std::max(aggregate_[a], aggregate_[b]), k);
        }
    });
    std::vector<Block> diagonal(aggregates_, Block::Zero());
    std::vector<std::vector<Entry>> below(aggregates_);
#pragma omp parallel for schedule(dynamic, 16)
    for (int a = 0; a < aggregates_; ++a) {
        for (const int point : points.of(a)) diagonal[a].noalias() += forces_[point].transpose() * responses_[point];
        for (const int k : rows.of(a)) {
            const Couplings::Coupling &coupling = couplings.all()[k];
            const int row_side = aggregate_[coupling.objects[0]] == a ? 0 : 1;
            const int other = aggregate_[coupling.objects[1 - row_side]];
            const Columns with = objective_.contact_values()[coupling.contact].hessian * side(coupling, 1 - row_side);
            const Block product = side(coupling, row_side).transpose() * with;
            if (other == a) {
                diagonal[a] += product + product.transpose();
                continue;
            }
            const auto found = std::find_if(below[a].begin(), below[a].end(), [&](const Entry &e) { return e.at[1] == other; });
            if (found == below[a].end())
                below[a].push_back({{a, other}, product});
            else
                found->block += product;
        }
        diagonal[a] = (0.5 * (diagonal[a] + diagonal[a].transpose())).eval();
        const double largest = diagonal[a].diagonal().maxCoeff();
        for (int i = 0; i < columns; ++i) // a motion that contacts do not resist has no column
            diagonal[a](i, i) = largest > 0.0 ? diagonal[a](i, i) + solver_settings::coarse_rounding * largest : 1.0;
    }
#pragma omp parallel for schedule(dynamic) if (clusters_.size() > 1)
    for (int c = 0; c < int(clusters_.size()); ++c) {
        Cluster &cluster = clusters_[c];
        const std::vector<Block> own(diagonal.begin() + cluster.first, diagonal.begin() + cluster.end);
        std::vector<Entry> entries;
        for (int a = cluster.first; a < cluster.end; ++a)
            for (const Entry &entry : below[a])
                entries.push_back({{entry.at[0] - cluster.first, entry.at[1] - cluster.first}, entry.block});
        cluster.positive = cluster.factor.factor(own, entries);
    }
}

void CoarseSpace::solve() {
#pragma omp parallel for schedule(dynamic) if (clusters_.size() > 1)
    for (int c = 0; c < int(clusters_.size()); ++c) {
        const Cluster &cluster = clusters_[c];
        if (cluster.positive)
            cluster.factor.solve(coefficients_.data() + cluster.first);
        else
            std::fill(coefficients_.begin() + cluster.first, coefficients_.begin() + cluster.end, Coefficients::Zero());
    }
}

} // namespace ringlet
