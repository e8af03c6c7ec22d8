#include "ringlet/solver/couplings.h"

#include "ringlet/math/collect.h"
#include "ringlet/math/disjoint_sets.h"
#include "ringlet/math/parallel.h"

#include <algorithm>
#include <atomic>

namespace ringlet {

void Couplings::find(const ContactSet &contacts, const VertexTable &table, const BlockSet &blocks) {
    collect_into(couplings_, contacts.count(), [&](int pair, std::vector<Coupling> &couplings) {
        const Stencil &at = contacts.stencil_of(pair);
        const std::array<int, 2> sides = table.objects_of(at);
        if (sides[0] >= 0 && sides[1] >= 0 && blocks.is_active(sides[0]) && blocks.is_active(sides[1]))
            couplings.push_back({pair, at.first, sides, {}, at.weight, {Vec3::Zero(), Vec3::Zero()}});
    });
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
    const auto for_coupled = [&](int coupling, const auto &work) { // (which of its four, vertex)
        const Stencil &at = contacts.stencil_of(couplings_[coupling].pair);
        for (int i = 0; i < 4; ++i)
            if (table.mesh.moves[at.vertex[i]] && at.weight[i] != 0.0) work(i, at.vertex[i]);
    };
    constexpr int none = -1;
    const int couplings = int(couplings_.size());
    std::vector<int> number(table.dynamic_vertices, none);
    parallel_for(couplings, [&](int k) {
        for_coupled(k, [&](int, int v) { std::atomic_ref(number[v]).store(0, std::memory_order_relaxed); });
    });
    for (int b = 0; b < blocks.count(); ++b)
        if (!blocks[b].is_exact())
            for (const BlockObject &object : blocks[b].objects())
                std::fill(number.begin() + object.first, number.begin() + object.end, 0);
    points_ = {size_t(blocks.count()), table.dynamic_vertices, [&](int v, const auto &add) {
                   if (const int object = table.object_of(v); number[v] != none) add(blocks.block_of(object), Point{v, object});
               }};
    range_.assign(table.objects, {0, 0});
    parallel_for(blocks.count(), [&](int b) {
        for (int k = begin(b); k < end(b); ++k) {
            number[vertex(k)] = k;
            std::array<int, 2> &range = range_[object(k)];
            if (range[1] == 0) range[0] = k;
            range[1] = k + 1;
        }
    });
    parallel_for(couplings, [&](int k) {
        couplings_[k].point.fill(none);
        for_coupled(k, [&](int i, int v) { couplings_[k].point[i] = number[v]; });
    });
    roles_ = {size_t(count()), couplings,
              [&](int k, const auto &add) { for_coupled(k, [&](int i, int v) { add(number[v], Role{k, i}); }); }};
}

void Couplings::multiply(View<Vec3> p, View<PairValue> values, View<unsigned char> busy) {
    parallel_for(int(couplings_.size()), [&](int k) {
        Coupling &c = couplings_[k];
        if (!busy[c.objects[0]] && !busy[c.objects[1]]) return;
        Vec3 side[2] = {Vec3::Zero(), Vec3::Zero()};
        for (int i = 0; i < 4; ++i)
            if (c.point[i] >= 0) side[i >= c.first] += c.weight[i] * p[c.point[i]];
        const Mat3 &hessian = values[c.pair].hessian;
        c.products = {hessian * side[1], hessian * side[0]};
    });
}

} // namespace ringlet
