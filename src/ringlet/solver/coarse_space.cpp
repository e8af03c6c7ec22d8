#include "ringlet/solver/coarse_space.h"

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

// Adds a block to the entry there, or makes one.
void add_entry(std::array<int, 2> at, const CoarseSpace::Factor::Block &block,
               std::vector<CoarseSpace::Factor::Entry> &entries) {
    const auto found = std::find_if(entries.begin(), entries.end(), [&](const auto &entry) { return entry.at == at; });
    if (found == entries.end())
        entries.push_back({at, block});
    else
        found->block += block;
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
    if (empty()) return;
    const Couplings &couplings = objective_.couplings;
    forces_.assign(couplings.count(), Columns::Zero());
    responses_.assign(couplings.count(), Columns::Zero());
    for (const Couplings::Coupling &coupling : couplings.all()) {
        const Mat3 &hessian = objective_.pair_values()[coupling.pair].hessian;
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
    points_ = {size_t(aggregates_), [&](const auto &add) {
                   for (int point = 0; point < couplings.count(); ++point)
                       if (const int a = aggregate_[couplings.object(point)]; a >= 0) add(a, point);
               }};
    couplings_ = {size_t(aggregates_), [&](const auto &add) {
                      for (int k = 0; k < int(couplings.all().size()); ++k) {
                          const auto [a, b] = couplings.all()[k].objects;
                          if (has(a) && has(b)) add(std::max(aggregate_[a], aggregate_[b]), k);
                      }
                  }};
}

void CoarseSpace::find_responses(int number) {
    const Couplings &couplings = objective_.couplings;
    const BlockSet &blocks = objective_.blocks;
    const int begin = couplings.begin(number), end = couplings.end(number);
    if (empty() || begin == end || !blocks[number].is_exact()) return;
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

CoarseSpace::Columns CoarseSpace::response_of_side(const Couplings::Coupling &coupling, int side) const {
    Columns sum = Columns::Zero();
    for (int i = side == 0 ? 0 : coupling.first; i < (side == 0 ? coupling.first : 4); ++i)
        if (coupling.point[i] >= 0) sum += coupling.weight[i] * responses_[coupling.point[i]];
    return sum;
}

// Block (a, b) of E sums what couplings do between the columns of aggregates a and b; a diagonal block has P in addition.
CoarseSpace::Row CoarseSpace::row(int a) const {
    Row row{Factor::Block::Zero(), {}};
    Factor::Block &diagonal = row.diagonal;
    for (const int point : points_.of(a)) diagonal.noalias() += forces_[point].transpose() * responses_[point];
    for (const int k : couplings_.of(a)) {
        const Couplings::Coupling &coupling = objective_.couplings.all()[k];
        const int here = aggregate_[coupling.objects[0]] == a ? 0 : 1, b = aggregate_[coupling.objects[1 - here]];
        const Columns force = objective_.pair_values()[coupling.pair].hessian * response_of_side(coupling, 1 - here);
        const Factor::Block product = response_of_side(coupling, here).transpose() * force;
        if (b == a)
            diagonal += product + product.transpose();
        else
            add_entry({a, b}, product, row.below);
    }
    diagonal = (0.5 * (diagonal + diagonal.transpose())).eval();
    const double largest = diagonal.diagonal().maxCoeff();
    for (int i = 0; i < columns; ++i) // a motion that contacts do not resist has no column
        diagonal(i, i) = largest > 0.0 ? diagonal(i, i) + solver_settings::coarse_rounding * largest : 1.0;
    return row;
}

void CoarseSpace::factor() {
    std::vector<Row> rows(aggregates_);
#pragma omp parallel for schedule(dynamic, 16)
    for (int a = 0; a < aggregates_; ++a) rows[a] = row(a);
#pragma omp parallel for schedule(dynamic) if (clusters_.size() > 1)
    for (int c = 0; c < int(clusters_.size()); ++c) {
        Cluster &cluster = clusters_[c];
        std::vector<Factor::Block> diagonal;
        std::vector<Factor::Entry> below;
        for (int a = cluster.first; a < cluster.end; ++a) {
            diagonal.push_back(rows[a].diagonal);
            for (const auto &[at, block] : rows[a].below)
                below.push_back({{at[0] - cluster.first, at[1] - cluster.first}, block});
        }
        cluster.is_definite = cluster.factor.factor(diagonal, below);
    }
}

void CoarseSpace::solve() {
#pragma omp parallel for schedule(dynamic) if (clusters_.size() > 1)
    for (int c = 0; c < int(clusters_.size()); ++c) {
        const Cluster &cluster = clusters_[c];
        if (cluster.is_definite)
            cluster.factor.solve(coefficients_.data() + cluster.first);
        else
            std::fill(coefficients_.begin() + cluster.first, coefficients_.begin() + cluster.end, Coefficients::Zero());
    }
}

} // namespace ringlet
