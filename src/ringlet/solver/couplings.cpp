#include "ringlet/solver/couplings.h"

#include "ringlet/math/disjoint_sets.h"

#include <algorithm>

namespace ringlet {

void Couplings::find(const ContactSet &contacts, const VertexTable &table, const BlockSet &blocks) {
    const std::vector<Contact> &all = contacts.contacts();
    couplings_.clear();
    for (int k = 0; k < int(all.size()); ++k) {
        const Contact &c = all[k];
        const int a = table.object_of(c.vertex[0]), b = table.object_of(c.vertex[3]);
        if (a >= 0 && b >= 0 && blocks.is_active(a) && blocks.is_active(b))
            couplings_.push_back({k, c.first, {a, b}, {}, c.weight, {Vec3::Zero(), Vec3::Zero()}});
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
        for (int k = 0; k < int(couplings_.size()); ++k)
            for (int i = 0; i < 4; ++i) {
                const int v = contacts.contacts()[couplings_[k].contact].vertex[i];
                if (table.mesh.moves[v] && couplings_[k].weight[i] != 0.0) work(k, i, v);
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

void Couplings::multiply(View<Vec3> p, View<ContactValue> values, View<unsigned char> busy, std::vector<double> &of_clusters) {
    std::vector<double> curvatures(couplings_.size(), 0.0);
#pragma omp parallel for schedule(static)
    for (int k = 0; k < int(couplings_.size()); ++k) {
        Coupling &c = couplings_[k];
        if (!busy[c.objects[0]] && !busy[c.objects[1]]) continue;
        Vec3 side[2] = {Vec3::Zero(), Vec3::Zero()};
        for (int i = 0; i < 4; ++i)
            if (c.point[i] >= 0) side[i >= c.first] += c.weight[i] * p[c.point[i]];
        const Mat3 &hessian = values[c.contact].hessian;
        c.products = {hessian * side[1], hessian * side[0]};
        curvatures[k] = 2.0 * side[0].dot(c.products[0]);
    }
    for (size_t k = 0; k < couplings_.size(); ++k) of_clusters[clusters_[couplings_[k].objects[0]]] += curvatures[k];
}

} // namespace ringlet
