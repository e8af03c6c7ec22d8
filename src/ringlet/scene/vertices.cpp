#include "ringlet/scene/vertices.h"

#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

namespace ringlet {
namespace {

// Appends objects to the table, one after the other.
class Numbering {
public:
    explicit Numbering(SceneVertices &all) : all_(all) {}

    struct Object {
        int number, carrier, material; // carrier: the object that carries its prescribed vertices
    };

    // radii: of contact, per vertex of strands [m]
    void add_strand(const StrandModel &model, const StrandState &state, int strand, View<double> radii, const Object &object) {
        const int first = model.offsets[strand], end = model.offsets[strand + 1];
        int held = 0;
        while (first + held < end && model.held[first + held]) ++held;
        add_yield(model, first, end);
        all_.mesh.objects.push_back({first, end, true});
        for (int v = first; v < end; ++v) {
            add_vertex(object, radii[v], state.positions[v], !model.held[v], model.mass[v]);
            if (held >= 3) all_.carriers[v] = Triangle(first, first + 1, first + 2);
            all_.mesh.points.push_back(v);
            if (v > first) all_.mesh.edges.push_back({v - 1, v});
        }
    }

    void add_cloth(const SceneCloth &cloth, const Object &object) {
        const int base = all_.count();
        all_.mesh.objects.push_back({base, base + cloth.model->vertex_count()});
        const double radius = 0.5 * cloth.model->thickness;
        all_.mesh.yield.insert(all_.mesh.yield.end(), cloth.model->vertex_count(), std::numeric_limits<double>::infinity());
        for (int i = 0; i < cloth.model->vertex_count(); ++i)
            all_.mesh.points.push_back(
                add_vertex(object, radius, cloth.model->rest[i], !cloth.model->held[i], cloth.model->mass[i]));
        add_surface(cloth.model->triangles, base);
    }

    void add_body(const BodyModel &body, const Object &object, bool meets_triangles) {
        const int base = all_.count();
        all_.mesh.objects.push_back({base, base + int(body.rest.size())});
        for (const Vec3 &rest : body.rest) {
            const int vertex = add_vertex(object, body.thickness, rest, false, 0.0);
            all_.mesh.yield.push_back(0.0);
            if (meets_triangles) all_.mesh.points.push_back(vertex);
        }
        add_surface(body.triangles, base);
    }

private:
    void add_yield(const StrandModel &model, int first, int end) {
        std::vector<double> &yield = all_.mesh.yield;
        double length = std::numeric_limits<double>::infinity();
        for (int v = first; v < end; ++v) {
            if (v > first) length += model.rest_length[v - 1];
            if (model.held[v]) length = 0.0;
            yield.push_back(length);
        }
        for (int v = end - 1; v-- > first;) yield[v] = std::min(yield[v], yield[v + 1] + model.rest_length[v]);
    }

    int add_vertex(const Object &object, double radius, const Vec3 &rest, bool moves, double mass) {
        const int vertex = all_.count();
        all_.mass.push_back(mass);
        all_.carriers.emplace_back(Triangle::Constant(vertex));
        all_.mesh.rest.push_back(rest);
        all_.mesh.radius.push_back(radius);
        all_.mesh.moves.push_back(moves);
        all_.mesh.object.push_back(object.number);
        all_.mesh.anchor.push_back(moves ? -1 : object.carrier);
        all_.material.material.push_back(object.material);
        return vertex;
    }

    void add_surface(View<Triangle> triangles, int base) { // each edge once
        std::set<std::array<int, 2>> edges;
        for (const Triangle &t : triangles) {
            const Triangle at = t + Triangle::Constant(base);
            all_.mesh.triangles.push_back({at[0], at[1], at[2]});
            const bool prescribed = !all_.mesh.moves[at[0]] && !all_.mesh.moves[at[1]] && !all_.mesh.moves[at[2]];
            for (int k = 0; k < 3; ++k) {
                const auto [a, b] = std::minmax(at[k], at[(k + 1) % 3]);
                edges.insert({a, b});
                if (prescribed) all_.carriers[at[k]] = at;
            }
        }
        all_.mesh.edges.insert(all_.mesh.edges.end(), edges.begin(), edges.end());
    }

    SceneVertices &all_;
};

// A table in which nothing can touch.
void remove_primitives(CollisionMesh &mesh) {
    mesh.edges.clear(), mesh.triangles.clear(), mesh.points.clear();
    mesh.curve_edges = 0;
}

} // namespace

SceneVertices number_vertices(const StrandModel &strands, const StrandState &state, const std::vector<SceneCloth> &cloths,
                              const std::vector<BodyModel> &bodies, const std::vector<int> &rooted_in,
                              const SceneContact &contact) {
    SceneVertices all;
    Numbering numbering(all);
    all.strands = strands.strand_count();
    all.objects = all.strands + int(cloths.size());
    const auto object_of_body = [&](int body) { return body >= 0 ? all.objects + body : -1; };
    std::vector<double> radii = contact.strand_radii;
    if (radii.empty()) radii.assign(state.positions.size(), contact.strand_radius);
    if (radii.size() != state.positions.size()) throw std::invalid_argument("scene: as many radii as vertices of strands");
    for (int s = 0; s < all.strands; ++s) {
        const int carrier = object_of_body(s < int(rooted_in.size()) ? rooted_in[s] : -1);
        numbering.add_strand(strands, state, s, radii, {s, carrier, contact.strand_material});
    }
    all.mesh.curve_edges = int(all.mesh.edges.size());
    cache_activation_distances(all.mesh);
    for (int c = 0; c < int(cloths.size()); ++c) {
        all.cloths.push_back(all.count());
        numbering.add_cloth(cloths[c], {all.strands + c, object_of_body(cloths[c].pinned_to), cloths[c].material});
    }
    all.cloths.push_back(all.count());
    all.dynamic_vertices = all.count();
    for (int b = 0; b < int(bodies.size()); ++b) {
        all.bodies.push_back(all.count());
        numbering.add_body(bodies[b], {object_of_body(b), -1, bodies[b].material}, !cloths.empty());
    }
    all.bodies.push_back(all.count());
    if (!contact.enabled) remove_primitives(all.mesh);

    all.material.friction = contact.friction;
    all.material.materials = int(std::lround(std::sqrt(double(contact.friction.size()))));
    if (all.material.materials * all.material.materials != int(contact.friction.size()))
        throw std::invalid_argument("scene: friction must have a row and a column for each material");
    return all;
}

} // namespace ringlet
