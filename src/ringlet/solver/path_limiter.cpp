#include "ringlet/solver/path_limiter.h"

#include "ringlet/solver/settings.h"

#include <algorithm>

namespace ringlet {
namespace {

double fraction_of(const Vec3 &now, const Vec3 &wanted, const Vec3 &to) {
    const Vec3 move = wanted - now;
    return move.dot(to - now) / move.squaredNorm();
}

// The least fraction of its move that is left to each object.
std::vector<double> fractions_left(const BlockSet &blocks, View<Vec3> now, View<Vec3> wanted, View<Vec3> to) {
    std::vector<double> left(blocks.objects(), 1.0);
    blocks.for_active_objects([&](const BlockObject &object) {
        for (int v = object.first; v < object.end; ++v)
            if (to[v] != wanted[v]) left[object.number] = std::min(left[object.number], fraction_of(now[v], wanted[v], to[v]));
    });
    return left;
}

// Sets where the paths of some objects lead, with the apexes of the triangles that hold them; `end` is scratch memory, a copy
// of x.
void set_end_of_path(const BlockSet &blocks, const VertexTable &table, View<Vec3> now, const AlignedVector &x,
                     const SearchPath &path, const std::vector<unsigned char> &objects, AlignedVector &end,
                     std::vector<Vec3> &to, std::vector<Vec3> &apex) {
    move_along(blocks, x, std::vector<double>(table.objects, 1.0), path, objects, end);
#pragma omp parallel for schedule(static)
    for (int v = 0; v < table.dynamic_vertices; ++v) {
        if (!table.mesh.moves[v] || !objects[table.mesh.object[v]]) continue;
        to[v] = blocks.position(end, v);
        apex[v] = now[v] + 0.5 * blocks.position(path.straight, v); // of a parabola, the tangents' intersection
    }
}

// The path of an object that was limited ends there. Each vertex goes on bending as far as it is left to. A chord of the curve
// would compress the edges that the curve turns, and stretch is too stiff for a step along it to be one of descent.
void end_where_limited(const BlockSet &blocks, const VertexTable &table, View<Vec3> now, View<Vec3> wanted, View<Vec3> to,
                       SearchPath &path) {
    blocks.for_active_objects([&](const BlockObject &object) {
        for (int v = object.first; v < object.end; ++v) {
            if (!table.mesh.moves[v] || to[v] == wanted[v]) continue;
            const double left = fraction_of(now[v], wanted[v], to[v]);
            const auto [first, stride] = blocks.slot(v);
            for (int k = 0; k < blocks.dofs(v); ++k) {
                const size_t i = size_t(first) + size_t(k) * stride;
                path.straight[i] = left * (path.straight[i] + (1.0 - left) * path.bend[i]);
                path.bend[i] *= left * left;
            }
        }
    });
}

} // namespace

LimitedPath limit_path(const Objective &objective, Configuration &configuration, const AlignedVector &x,
                       const PathLimits &limits, SearchPath &path, SceneReport &report) {
    const VertexTable &table = objective.table;
    const BlockSet &blocks = objective.blocks;
    const std::vector<int> &cluster = objective.couplings.clusters();
    const std::vector<Vec3> &now = configuration.positions;
    AlignedVector end = x.copy();
    std::vector<Vec3> wanted = now;
    PlannedMove move{{}, now};
    set_end_of_path(blocks, table, now, x, path, blocks.active_objects(), end, wanted, move.apex);
    move.to = wanted;
    configuration.limit(move, Yield::as_a_whole, limits.serve, report);

    std::vector<double> left = fractions_left(blocks, now, wanted, move.to);
    std::vector<unsigned char> straight(table.objects, 0), limited(table.objects, 0), changed(table.count(), 0);
    for (int object = 0; object < table.objects; ++object) {
        straight[object] = left[object] < solver_settings::near_impact && !limits.uniform[object];
        if (straight[object]) left[object] = solver_settings::straight_part;
    }
    share_least(cluster, limits.uniform, left);
    for (int object = 0; object < table.objects; ++object) limited[object] = left[object] < 1.0;
    if (std::count(limited.begin(), limited.end(), 1) == 0) { // one pass is enough
        ObjectMoves moves(blocks, now, wanted, move.to);
        return {std::move(move), std::move(moves)};
    }
    straighten(blocks, straight, path);
    shorten(blocks, left, path);

    set_end_of_path(blocks, table, now, x, path, limited, end, wanted, move.apex);
#pragma omp parallel for schedule(static)
    for (int v = 0; v < table.dynamic_vertices; ++v)
        if (table.mesh.moves[v] && limited[table.mesh.object[v]]) changed[v] = 1, move.to[v] = wanted[v];
    configuration.limit_again(move, limits.yield, changed, report);
    ObjectMoves moves(blocks, now, wanted, move.to);
    moves.shorten(left);
    end_where_limited(blocks, table, now, wanted, move.to, path);
    return {std::move(move), std::move(moves)};
}

} // namespace ringlet
