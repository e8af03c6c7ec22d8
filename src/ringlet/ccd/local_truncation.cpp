#include "ringlet/ccd/local_truncation.h"

#include "ringlet/ccd/settings.h"
#include "ringlet/ccd/spread_correction.h"

namespace ringlet {
namespace {

// Marks all vertices of the objects of some vertices; of bodies only where they may.
void mark_objects(const CollisionMesh &mesh, const std::vector<int> &vertices, bool bodies,
                  std::vector<Correction> &corrections) {
    const int objects = mesh.object.empty() ? 0 : mesh.object.back() + 1;
    std::vector<unsigned char> dynamic(objects, 0), marked(objects, 0);
    for (size_t v = 0; v < mesh.object.size(); ++v) dynamic[mesh.object[v]] |= mesh.moves[v];
    for (const int v : vertices) marked[mesh.object[v]] = dynamic[mesh.object[v]] || bodies;
    for (size_t v = 0; v < mesh.object.size(); ++v)
        if (marked[mesh.object[v]]) corrections[v].weight = 1.0;
}

// All vertices of a whole object make the move of that which makes the least.
void spread_over_objects(const CollisionMesh &mesh, View<unsigned char> whole, std::vector<Correction> &corrections) {
    if (whole.empty()) return;
    std::vector<double> weight(whole.size(), 0.0);
    for (size_t v = 0; v < corrections.size(); ++v)
        weight[mesh.object[v]] = std::max(weight[mesh.object[v]], corrections[v].weight);
    for (size_t v = 0; v < corrections.size(); ++v)
        if (whole[mesh.object[v]]) corrections[v].weight = weight[mesh.object[v]];
}

} // namespace

void truncate_locally(AdvectedMove &move, View<unsigned char> whole) {
    const CollisionMesh &mesh = move.mesh;
    for (int round = 0; !move.impacts().empty(); ++round)
        move.round([&](const std::vector<Impact> &impacts) {
            std::vector<Correction> corrections(move.end.size());
            std::vector<int> vertices;
            for (const Impact &impact : impacts)
                for (const int v : impact.vertices) {
                    const bool partial = round < ccd::partial_rounds && !impact.close;
                    const double weight = partial ? 1.0 - ccd::before_first_impact * impact.toi : 1.0;
                    corrections[v].weight = std::max(corrections[v].weight, weight);
                    vertices.push_back(v);
                }
            spread_over_objects(mesh, whole, corrections);
            if (round >= ccd::vertex_rounds) mark_objects(mesh, vertices, round >= ccd::object_rounds, corrections);
            spread_correction(move.candidates, move.start, move.end, ccd::max_strain, corrections);
            for (size_t v = 0; v < corrections.size(); ++v) {
                const double weight = corrections[v].weight;
                if (weight == 1.0)
                    move.end[v] = move.start[v];
                else if (weight > 0.0)
                    move.end[v] += weight * (move.start[v] - move.end[v]);
            }
        });
}

} // namespace ringlet
