#include "ringlet/solver/search_path.h"

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

} // namespace ringlet
