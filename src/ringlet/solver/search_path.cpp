#include "ringlet/solver/search_path.h"

#include "ringlet/math/parallel_copy.h"
#include "ringlet/solver/settings.h"

#include <algorithm>
#include <cmath>

namespace ringlet {
void measure_direction(const BlockSet &blocks, AlignedVector &direction, std::vector<double> &largest) {
    blocks.for_active([&](int b) {
        blocks.for_objects(b, [&](int object, size_t first, size_t stride, size_t count) {
            double most = 0.0, sum = 0.0;
            for (size_t i = first; i < first + count * stride; i += stride) {
                most = std::max(most, std::abs(direction[i]));
                sum += direction[i];
            }
            const bool finite = std::isfinite(sum);
            if (blocks.is_active(object)) largest[object] = finite ? most : 0.0;
            if (finite && blocks.is_active(object)) return;
            for (size_t i = first; i < first + count * stride; i += stride) direction[i] = 0.0;
        });
    });
}

std::vector<double> slopes(const BlockSet &blocks, const AlignedVector &direction) {
    std::vector<double> slope(blocks.objects(), 0.0);
    blocks.for_active([&](int b) {
        double of_lanes[max_lanes] = {};
        lane_dots(blocks[b].gradient(), blocks.of(b, direction), blocks[b].rows(), blocks[b].lanes(), of_lanes);
        blocks.from_lanes(b, of_lanes, slope);
    });
    return slope;
}

std::vector<double> max_step(const BlockSet &blocks, const AlignedVector &x, const AlignedVector &direction) {
    std::vector<double> steps(blocks.objects(), 1.0);
    blocks.for_active([&](int b) {
        double of_lanes[max_lanes] = {};
        blocks[b].max_step(blocks.of(b, x), blocks.of(b, direction), of_lanes);
        blocks.from_lanes(b, of_lanes, steps);
    });
    return steps;
}

void share_least(const std::vector<int> &cluster, const std::vector<unsigned char> &objects, std::vector<double> &t) {
    std::vector<double> least(t.size(), 1.0);
    for (size_t o = 0; o < t.size(); ++o) least[cluster[o]] = std::min(least[cluster[o]], t[o]);
    for (size_t o = 0; o < t.size(); ++o)
        if (objects[o]) t[o] = least[cluster[o]];
}

void shorten(const BlockSet &blocks, const std::vector<double> &t, SearchPath &path) {
    blocks.for_active([&](int b) {
        blocks.for_objects(b, [&](int object, size_t first, size_t stride, size_t count) {
            const double left = t[object];
            if (left == 1.0) return;
            for (size_t i = first; i < first + count * stride; i += stride)
                path.straight[i] *= left, path.bend[i] *= left * left;
        });
    });
}

void bend(const BlockSet &blocks, const AlignedVector &x, SearchPath &path) {
    blocks.for_active([&](int b) { blocks[b].bend(blocks.of(b, x), blocks.of(b, path.straight), blocks.of(b, path.bend)); });
}

void straighten(const BlockSet &blocks, const std::vector<unsigned char> &objects, SearchPath &path) {
    blocks.for_active([&](int b) {
        blocks.for_objects(b, [&](int object, size_t first, size_t stride, size_t count) {
            if (objects[object])
                for (size_t i = first; i < first + count * stride; i += stride) path.bend[i] = 0.0;
        });
    });
}

void move_along(const BlockSet &blocks, const AlignedVector &x, const std::vector<double> &t, const SearchPath &path,
                const std::vector<unsigned char> &changed, AlignedVector &to) {
    const std::vector<unsigned char> moves = blocks.blocks_with(changed);
    blocks.for_active([&](int b) {
        if (!moves[b]) return;
        double of_lanes[max_lanes] = {};
        blocks.to_lanes(b, t, of_lanes);
        lane_points(blocks.of(b, x), of_lanes, blocks.of(b, path.straight), blocks.of(b, path.bend), blocks[b].rows(),
                    blocks[b].lanes(), blocks.of(b, to));
    });
}

ObjectMoves::ObjectMoves(const BlockSet &blocks, View<Vec3> now, View<Vec3> wanted, View<Vec3> to)
    : length(blocks.objects(), 0.0), fraction(blocks.objects(), 1.0) {
    blocks.for_active_objects([&](const BlockObject &object) {
        double &longest = length[object.number], &least = fraction[object.number];
        for (int v = object.first; v < object.end; ++v) {
            const double of_vertex = (wanted[v] - now[v]).norm();
            longest = std::max(longest, of_vertex);
            if (of_vertex > 0.0) least = std::min(least, (to[v] - now[v]).norm() / of_vertex);
        }
    });
}

void ObjectMoves::shorten(const std::vector<double> &t) {
    for (size_t object = 0; object < t.size(); ++object) fraction[object] *= t[object];
}

bool ObjectMoves::are_full() const {
    return std::all_of(fraction.begin(), fraction.end(), [](double t) { return t > 1.0 - solver_settings::move_rounding; });
}

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
    parallel_for(table.dynamic_vertices, [&](int v) {
        if (!table.mesh.moves[v] || !objects[table.mesh.object[v]]) return;
        to[v] = blocks.position(end, v);
        apex[v] = now[v] + 0.5 * blocks.position(path.straight, v); // of a parabola, the tangents' intersection
    });
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
    AlignedVector end = parallel_copy(x);
    std::vector<Vec3> wanted = parallel_copy(now);
    PlannedMove move{{}, parallel_copy(now)};
    set_end_of_path(blocks, table, now, x, path, blocks.active_objects(), end, wanted, move.apex);
    parallel_copy(wanted, move.to);
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
    parallel_for(table.dynamic_vertices, [&](int v) {
        if (table.mesh.moves[v] && limited[table.mesh.object[v]]) changed[v] = 1, move.to[v] = wanted[v];
    });
    configuration.limit_again(move, limits.yield, changed, report);
    ObjectMoves moves(blocks, now, wanted, move.to);
    moves.shorten(left);
    end_where_limited(blocks, table, now, wanted, move.to, path);
    return {std::move(move), std::move(moves)};
}

} // namespace ringlet
