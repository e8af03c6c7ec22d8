#include "ringlet/solver/couplings.h"

#include <numeric>

namespace ringlet {

void Couplings::find(const ContactSet &contacts, const SceneVertices &vertices, View<int> unit_of, int units) {
    const std::vector<Contact> &all = contacts.contacts();
    couplings_.clear();
    for (int k = 0; k < int(all.size()); ++k) {
        const Contact &c = all[k];
        const int a = vertices.part_of(c.vertex[0]), b = vertices.part_of(c.vertex[3]);
        if (a >= 0 && b >= 0) couplings_.push_back({k, c.first, {a, b}, {}, c.weight, {Vec3::Zero(), Vec3::Zero()}});
    }
    join_parts(vertices.parts());
    number_points(vertices, contacts, unit_of, units);
}

void Couplings::join_parts(int parts) {
    together_.assign(parts, 0);
    clusters_.resize(parts);
    std::iota(clusters_.begin(), clusters_.end(), 0);
    const auto find = [&](int part) {
        while (clusters_[part] != part) part = clusters_[part] = clusters_[clusters_[part]];
        return part;
    };
    for (const Coupling &c : couplings_) {
        const auto [a, b] = c.parts;
        together_[a] = together_[b] = 1;
        const int first = find(a), other = find(b);
        clusters_[std::max(first, other)] = std::min(first, other);
    }
    for (int part = 0; part < parts; ++part) clusters_[part] = find(part);
}

void Couplings::number_points(const SceneVertices &vertices, const ContactSet &contacts, View<int> unit_of, int units) {
    const auto for_coupled = [&](const auto &work) { // (which of the couplings, as which of its four, vertex)
        for (int k = 0; k < int(couplings_.size()); ++k)
            for (int i = 0; i < 4; ++i) {
                const int v = contacts.contacts()[couplings_[k].contact].vertex[i];
                if (vertices.mesh.moves[v] && couplings_[k].weight[i] != 0.0) work(k, i, v);
            }
    };
    constexpr int none = -1;
    std::vector<int> number(vertices.moving_vertices(), none);
    for_coupled([&](int, int, int v) { number[v] = 0; });
    points_ = {size_t(units), [&](const auto &work) {
                   for (const int v : contacts.vertices()) {
                       const int part = vertices.part_of(v);
                       if (number[v] != none) work(unit_of[part], Point{v, part});
                   }
               }};
    for (int k = 0; k < count(); ++k) number[vertex(k)] = k;
    for (Coupling &coupling : couplings_) coupling.point.fill(none);
    for_coupled([&](int k, int i, int v) { couplings_[k].point[i] = number[v]; });
    roles_ = {size_t(count()),
              [&](const auto &work) { for_coupled([&](int k, int i, int v) { work(number[v], Role{k, i}); }); }};
}

void Couplings::push(View<Vec3> p, View<ContactValue> values, View<unsigned char> busy, std::vector<double> &of_clusters) {
    std::vector<double> curvatures(couplings_.size(), 0.0);
#pragma omp parallel for schedule(static)
    for (int k = 0; k < int(couplings_.size()); ++k) {
        Coupling &c = couplings_[k];
        if (!busy[c.parts[0]] && !busy[c.parts[1]]) continue;
        Vec3 side[2] = {Vec3::Zero(), Vec3::Zero()};
        for (int i = 0; i < 4; ++i)
            if (c.point[i] >= 0) side[i >= c.first] += c.weight[i] * p[c.point[i]];
        const Mat3 &hessian = values[c.contact].hessian;
        c.pushes = {hessian * side[1], hessian * side[0]};
        curvatures[k] = 2.0 * side[0].dot(c.pushes[0]);
    }
    for (size_t k = 0; k < couplings_.size(); ++k) of_clusters[clusters_[couplings_[k].parts[0]]] += curvatures[k];
}

Vec3 Couplings::pushed(int point) const {
    Vec3 push = Vec3::Zero();
    for (const auto &[coupling, as] : roles_.of(point)) {
        const Coupling &c = couplings_[coupling];
        push += c.weight[as] * c.pushes[as >= c.first];
    }
    return push;
}

} // namespace ringlet
