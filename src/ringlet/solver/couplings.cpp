#include "ringlet/solver/couplings.h"

#include "ringlet/math/disjoint_sets.h"

#include <algorithm>

namespace ringlet {

void Couplings::find(const ContactSet &contacts, const VertexTable &table, const BlockSet &blocks) {
    couplings_.clear();
    for (int pair = 0; pair < contacts.count(); ++pair) {
        const Stencil &at = contacts.stencil_of(pair);
        const auto [a, b] = table.objects_of(at);
        if (a >= 0 && b >= 0 && blocks.is_active(a) && blocks.is_active(b))
            couplings_.push_back({pair, at.first, {a, b}, {}, at.weight, {Vec3::Zero(), Vec3::Zero()}});
    }
    join_clusters(table.objects);
    number_points(contacts, table, blocks);
}

void Couplings::join_clusters(int objects) {
    coupled_.assign(objects, 0);
    DisjointSets joined(objects);
    for (const Coupling &c : couplings_) {
        const auto [a, b] = c.objects;
        coupled_[a] = coupled_[b] = 1;
        joined.join(a, b);
    }
    clusters_.resize(objects);
    for (int object = 0; object < objects; ++object) clusters_[object] = joined.find(object);
}

void Couplings::number_points(const ContactSet &contacts, const VertexTable &table, const BlockSet &blocks) {
    const auto for_coupled = [&](const auto &work) { // (coupling, which of its four, vertex)
        for (int k = 0; k < int(couplings_.size()); ++k) {
            const Stencil &at = contacts.stencil_of(couplings_[k].pair);
            for (int i = 0; i < 4; ++i)
                if (table.mesh.moves[at.vertex[i]] && at.weight[i] != 0.0) work(k, i, at.vertex[i]);
        }
    };
    constexpr int none = -1;
    std::vector<int> number(table.dynamic_vertices, none);
    for_coupled([&](int, int, int v) { number[v] = 0; });
    for (int b = 0; b < blocks.count(); ++b)
        if (!blocks[b].is_exact())
            for (const BlockObject &object : blocks[b].objects())
                std::fill(number.begin() + object.first, number.begin() + object.end, 0);
    points_ = {size_t(blocks.count()), [&](const auto &work) {
                   for (int v = 0; v < table.dynamic_vertices; ++v)
                       if (const int object = table.object_of(v); number[v] != none)
                           work(blocks.block_of(object), Point{v, object});
               }};
    range_.assign(table.objects, {0, 0});
    for (int k = 0; k < count(); ++k) {
        number[vertex(k)] = k;
        auto &[first, end] = range_[object(k)];
        if (end == 0) first = k;
        end = k + 1;
    }
    for (Coupling &coupling : couplings_) coupling.point.fill(none);
    for_coupled([&](int k, int i, int v) { couplings_[k].point[i] = number[v]; });
    roles_ = {size_t(count()),
              [&](const auto &work) { for_coupled([&](int k, int i, int v) { work(number[v], Role{k, i}); }); }};
}

void Couplings::multiply(View<Vec3> p, View<PairValue> values, View<unsigned char> busy, std::vector<double> &of_clusters) {
    std::vector<double> curvatures(couplings_.size(), 0.0);
#pragma omp parallel for schedule(static)
    for (int k = 0; k < int(couplings_.size()); ++k) {
        Coupling &c = couplings_[k];
        if (!busy[c.objects[0]] && !busy[c.objects[1]]) continue;
        Vec3 side[2] = {Vec3::Zero(), Vec3::Zero()};
        for (int i = 0; i < 4; ++i)
            if (c.point[i] >= 0) side[i >= c.first] += c.weight[i] * p[c.point[i]];
        const Mat3 &hessian = values[c.pair].hessian;
        c.products = {hessian * side[1], hessian * side[0]};
        curvatures[k] = 2.0 * side[0].dot(c.products[0]);
    }
    for (size_t k = 0; k < couplings_.size(); ++k) of_clusters[clusters_[couplings_[k].objects[0]]] += curvatures[k];
}

} // namespace ringlet
