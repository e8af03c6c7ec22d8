#include "ringlet/solver/scene_vertices.h"

#include <array>
#include <cmath>
#include <set>
#include <stdexcept>

namespace ringlet {
namespace {

// What vertices of one object have in common.
struct ObjectKind {
    double radius;
    int object, anchor, material;
};

int add_vertex(SceneVertices &all, const ObjectKind &kind, const Vec3 &now, const Vec3 &rest, bool moves, double mass) {
    const int vertex = all.count();
    all.positions.push_back(now);
    all.mass.push_back(mass);
    all.some_triangle.emplace_back(Triangle::Constant(vertex));
    all.mesh.rest.push_back(rest);
    all.mesh.radius.push_back(kind.radius);
    all.mesh.moves.push_back(moves);
    all.mesh.object.push_back(kind.object);
    all.mesh.anchor.push_back(moves ? -1 : kind.anchor);
    all.material.material.push_back(kind.material);
    return vertex;
}

// Triangles of an object whose first vertex is `base`, each edge once.
void add_surface(SceneVertices &all, View<Triangle> triangles, int base) {
    std::set<std::array<int, 2>> edges;
    for (const Triangle &t : triangles) {
        const Triangle moved = t + Triangle::Constant(base);
        all.mesh.triangles.push_back({moved[0], moved[1], moved[2]});
        const bool kinematic = !all.mesh.moves[moved[0]] && !all.mesh.moves[moved[1]] && !all.mesh.moves[moved[2]];
        for (int k = 0; k < 3; ++k) {
            const auto [a, b] = std::minmax(moved[k], moved[(k + 1) % 3]);
            edges.insert({a, b});
            if (kinematic) all.some_triangle[moved[k]] = moved;
        }
    }
    all.mesh.edges.insert(all.mesh.edges.end(), edges.begin(), edges.end());
}

void add_strand(SceneVertices &all, const StrandModel &model, const StrandState &state, int strand, const ObjectKind &kind) {
    const int first = model.offsets[strand], end = model.offsets[strand + 1];
    int held = 0;
    while (first + held < end && model.held[first + held]) ++held;
    for (int v = first; v < end; ++v) {
        add_vertex(all, kind, state.positions[v], state.positions[v], !model.held[v], model.mass[v]);
        if (held >= 3) all.some_triangle[v] = Triangle(first, first + 1, first + 2);
        all.mesh.points.push_back(v);
        if (v > first) all.mesh.edges.push_back({v - 1, v});
    }
}

void add_cloth(SceneVertices &all, const SceneCloth &cloth, const ObjectKind &kind) {
    const int base = all.count();
    for (int i = 0; i < cloth.model->vertex_count(); ++i)
        all.mesh.points.push_back(add_vertex(all, kind, cloth.state->positions[i], cloth.model->rest[i], !cloth.model->held[i],
                                             cloth.model->mass[i]));
    add_surface(all, cloth.model->triangles, base);
}

void add_body(SceneVertices &all, const BodyModel &body, const ObjectKind &kind, bool meets_triangles) {
    const int base = all.count();
    for (const Vec3 &rest : body.rest) {
        const int vertex = add_vertex(all, kind, rest, rest, false, 0.0);
        if (meets_triangles) all.mesh.points.push_back(vertex);
    }
    add_surface(all, body.triangles, base);
}

} // namespace

SceneVertices number_vertices(const StrandModel &strands, const StrandState &state, const std::vector<SceneCloth> &cloths,
                              const std::vector<BodyModel> &bodies, const std::vector<int> &rooted_in,
                              const SceneContact &contact) {
    SceneVertices all;
    all.strands = strands.strand_count();
    const int first_cloth = all.strands, first_body = first_cloth + int(cloths.size());
    const auto object_of_body = [&](int body) { return body >= 0 ? first_body + body : -1; };
    for (int s = 0; s < all.strands; ++s) {
        const int anchor = object_of_body(s < int(rooted_in.size()) ? rooted_in[s] : -1);
        add_strand(all, strands, state, s, {contact.strand_radius, s, anchor, contact.strand_material});
    }
    all.mesh.strand_edges = int(all.mesh.edges.size());
    cache_activation_distances(all.mesh, View<int>(strands.offsets));
    for (int c = 0; c < int(cloths.size()); ++c) {
        all.cloths.push_back(all.count());
        add_cloth(all, cloths[c],
                  {0.5 * cloths[c].model->thickness, first_cloth + c, object_of_body(cloths[c].pinned_to), cloths[c].material});
    }
    all.cloths.push_back(all.count());
    for (int b = 0; b < int(bodies.size()); ++b) {
        all.bodies.push_back(all.count());
        add_body(all, bodies[b], {bodies[b].thickness, first_body + b, -1, bodies[b].material}, !cloths.empty());
    }
    all.bodies.push_back(all.count());

    all.material.friction = contact.friction;
    all.material.materials = int(std::lround(std::sqrt(double(contact.friction.size()))));
    if (all.material.materials * all.material.materials != int(contact.friction.size()))
        throw std::invalid_argument("scene: friction must have a row and a column for each material");
    return all;
}

} // namespace ringlet
