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
    const int count = int(couplings.all().size());
    amounts_.resize(count);
    parallel_for(count, [&](int k) {
        const Couplings::Coupling &coupling = couplings.all()[k];
        amounts_[k] = {};
        for (int i = 0; i < 4; ++i) {
            const int side = i >= coupling.first ? 1 : 0, object = coupling.objects[side];
            if (coupling.point[i] < 0 || !has(object)) continue;
            const BlockObject &of = objective_.blocks.of_object(object).objects()[objective_.blocks.lane_of(object)];
            const std::array<double, shapes> at = shapes_at(couplings.vertex(coupling.point[i]), of);
            for (int shape = 0; shape < shapes; ++shape) amounts_[k][side][shape] += coupling.weight[i] * at[shape];
        }
    });
    forces_.resize(couplings.count());
    responses_.resize(couplings.count());
    parallel_for(couplings.count(), [&](int point) {
        Columns force = Columns::Zero();
        responses_[point].setZero();
        for (const Couplings::Role &role : couplings.roles(point)) {
            const Couplings::Coupling &coupling = couplings.all()[role.coupling];
            const Mat3 &hessian = objective_.pair_values()[coupling.pair].hessian;
            const std::array<double, shapes> &amounts = amounts_[role.coupling][role.as >= coupling.first ? 1 : 0];
            for (int shape = 0; shape < shapes; ++shape)
                force.template middleCols<3>(3 * shape) += coupling.weight[role.as] * amounts[shape] * hessian;
        }
        forces_[point] = force;
    });
}

// Objects of exact blocks that something couples, by cluster. Where each touches many, E would fill up as it is factored: there
// some that are close together share their columns.
void CoarseSpace::aggregate() {
    const BlockSet &blocks = objective_.blocks;
    const Couplings &couplings = objective_.couplings;
    const int objects = blocks.objects(), count = int(couplings.all().size());
    clear();
    const auto takes_part = [&](int object) {
        return couplings.couples(object) && blocks.is_active(object) && blocks.of_object(object).is_exact();
    };
    const Lists<int> touched(objects, count, [&](int k, const auto &add) { // of each object, more than once
        const auto [a, b] = couplings.all()[k].objects;
        add(a, b), add(b, a);
    });
    std::vector<double> neighbours(objects); // of each object, then of all of a cluster
    parallel_for(objects, [&](int object) {
        std::vector<int> others(touched.of(object).begin(), touched.of(object).end());
        std::sort(others.begin(), others.end());
        neighbours[object] = double(std::unique(others.begin(), others.end()) - others.begin());
    });
    for (int object = 0; object < objects; ++object)
        if (const int first = couplings.clusters()[object]; first != object) neighbours[first] += neighbours[object];

    const Lists<int> members(objects, objects, [&](int object, const auto &add) {
        if (takes_part(object)) add(couplings.clusters()[object], object);
    });
    std::vector<size_t> together(objects, 1); // objects that share columns, of each cluster
    for (int cluster = 0; cluster < objects; ++cluster)
        for (const auto &[above, size] : solver_settings::aggregate_sizes)
            if (neighbours[cluster] > above * double(members.of(cluster).size())) together[cluster] = size;
    std::vector<Vec3> centres(objects, Vec3::Zero());
    parallel_for(objects, [&](int object) {
        if (!takes_part(object) || together[couplings.clusters()[object]] == 1) return;
        const BlockObject &place = blocks.of_object(object).objects()[blocks.lane_of(object)];
        for (int v = place.first; v < place.end; ++v)
            centres[object] += objective_.position(v) / double(place.end - place.first);
    });
    for (int cluster = 0; cluster < objects; ++cluster) {
        const View<int> of = members.of(cluster);
        if (of.size() < solver_settings::least_cluster) continue;
        in_cluster_[cluster] = 1;
        const int first = aggregates_;
        bisect({of.begin(), of.end()}, centres, together[cluster], [&](const std::vector<int> &part) {
            for (const int object : part) aggregate_[object] = aggregates_;
            ++aggregates_;
        });
        clusters_.push_back({first, aggregates_, false, {}});
    }
    points_ = {size_t(aggregates_), couplings.count(), [&](int point, const auto &add) {
                   if (const int a = aggregate_[couplings.object(point)]; a >= 0) add(a, point);
               }};
    couplings_ = {size_t(aggregates_), count, [&](int k, const auto &add) {
                      const auto [a, b] = couplings.all()[k].objects;
                      if (has(a) && has(b)) add(std::max(aggregate_[a], aggregate_[b]), k);
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
    parallel_chunks(aggregates_, 16, [&](int a) { rows[a] = row(a); });
    parallel_chunks(int(clusters_.size()), 1, [&](int c) {
        Cluster &cluster = clusters_[c];
        std::vector<Factor::Block> diagonal;
        std::vector<Factor::Entry> below;
        for (int a = cluster.first; a < cluster.end; ++a) {
            diagonal.push_back(rows[a].diagonal);
            for (const auto &[at, block] : rows[a].below)
                below.push_back({{at[0] - cluster.first, at[1] - cluster.first}, block});
        }
        cluster.is_definite = cluster.factor.factor(diagonal, below);
    });
}

void CoarseSpace::solve() {
    parallel_chunks(int(clusters_.size()), 1, [&](int c) {
        const Cluster &cluster = clusters_[c];
        if (cluster.is_definite)
            cluster.factor.solve(coefficients_.data() + cluster.first);
        else
            std::fill(coefficients_.begin() + cluster.first, coefficients_.begin() + cluster.end, Coefficients::Zero());
    });
}

} // namespace ringlet
