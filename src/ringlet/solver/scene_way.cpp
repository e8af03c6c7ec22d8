#include "ringlet/solver/scene_way.h"

#include "ringlet/solver/lane_vectors.h"

#include <cmath>

namespace ringlet {
namespace {

// work(part, the unit's unknowns that are its own: first, stride, count).
template <class Work> void for_parts(const SceneSystem &system, int unit, const Work &work) {
    if (unit >= system.group_count())
        return work(unit - system.group_count() + system.vertices.strands, system.unit_begin(unit), size_t(1),
                    system.unit_end(unit) - system.unit_begin(unit));
    const StrandGroup group = system.strands.strands_of(unit);
    const StrandGroupSystem &of = system.strands.system(unit);
    for (int lane = 0; lane < group.count; ++lane)
        work(group.strands[lane], system.unit_begin(unit) + lane, size_t(of.lanes), size_t(of.dofs()) * of.vertices);
}

} // namespace

void measure(const SceneSystem &system, AlignedVector &direction, std::vector<double> &reach) {
    reach.resize(system.vertices.parts(), 0.0);
    system.for_units([&](int u) {
        for_parts(system, u, [&](int part, size_t first, size_t stride, size_t count) {
            reach[part] = 0.0;
            double sum = 0.0;
            for (size_t i = first; i < first + count * stride; i += stride) {
                reach[part] = std::max(reach[part], std::abs(direction[i]));
                sum += direction[i];
            }
            if (std::isfinite(sum)) return;
            reach[part] = 0.0;
            for (size_t i = first; i < first + count * stride; i += stride) direction[i] = 0.0;
        });
    });
}

std::vector<double> worth_going(const SceneSystem &system, const AlignedVector &x, const AlignedVector &direction) {
    std::vector<double> parts(system.vertices.parts(), 1.0);
    system.for_units([&](int u) {
        if (u >= system.group_count()) return;
        double of_lanes[most_lanes];
        system.strands.worth_going(u, x, direction, of_lanes);
        system.from_lanes(u, of_lanes, parts);
    });
    return parts;
}

void shorten(const SceneSystem &system, const std::vector<double> &parts, SceneWay &way) {
    system.for_units([&](int u) {
        for_parts(system, u, [&](int part, size_t first, size_t stride, size_t count) {
            const double left = parts[part];
            if (left == 1.0) return;
            for (size_t i = first; i < first + count * stride; i += stride) way.straight[i] *= left, way.bend[i] *= left * left;
        });
    });
}

void bend(const SceneSystem &system, const AlignedVector &x, SceneWay &way) {
    system.for_units([&](int u) {
        if (u >= system.group_count()) return;
        system.strands.turn(u, x, way.straight, way.bend);
        const StrandGroupSystem &of = system.strands.system(u);
        const size_t first = system.unit_begin(u), count = size_t(of.dofs()) * of.vertices * of.lanes;
        for (size_t i = first; i < first + count; ++i) way.bend[i] -= x[i] + way.straight[i];
    });
}

void straighten(const SceneSystem &system, const std::vector<unsigned char> &parts, SceneWay &way) {
    system.for_units([&](int u) {
        for_parts(system, u, [&](int part, size_t first, size_t stride, size_t count) {
            if (parts[part])
                for (size_t i = first; i < first + count * stride; i += stride) way.bend[i] = 0.0;
        });
    });
}

void move(const SceneSystem &system, const AlignedVector &x, const std::vector<double> &step, const SceneWay &way,
          const std::vector<unsigned char> &changed, AlignedVector &to) {
    std::vector<unsigned char> asked(system.unit_count(), 0);
    for (size_t p = 0; p < changed.size(); ++p)
        if (changed[p]) asked[system.unit_of(int(p))] = 1;
    system.for_units([&](int u) {
        if (!asked[u]) return;
        const size_t first = system.unit_begin(u), count = system.unit_end(u) - first;
        double steps[most_lanes] = {};
        system.to_lanes(u, step, steps);
        if (u < system.group_count())
            RINGLET_DISPATCH(lane_move, x.data() + first, steps, way.straight.data() + first, way.bend.data() + first,
                             int(count / system.strands.stride()), to.data() + first);
        else
            for (size_t i = first; i < first + count; ++i) to[i] = x[i] + steps[0] * way.straight[i];
    });
}

} // namespace ringlet
