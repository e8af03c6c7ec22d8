#include "ringlet/strand/lane_groups.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <numeric>

namespace ringlet {

std::vector<int> order_by_length(const StrandModel &model) {
    std::vector<int> order(model.strand_count());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
        return model.offsets[a + 1] - model.offsets[a] > model.offsets[b + 1] - model.offsets[b];
    });
    return order;
}

namespace {

// Morton code of a point of the unit cube: near points have near codes.
uint32_t morton_code(const Eigen::Array3d &point) {
    constexpr int bits = 10;
    uint32_t code = 0;
    for (int bit = bits - 1; bit >= 0; --bit)
        for (int k = 0; k < 3; ++k) code = code << 1 | (uint32_t(point[k] * ((1 << bits) - 1)) >> bit & 1);
    return code;
}

} // namespace

std::vector<int> order_by_length_and_position(const StrandModel &model, View<Vec3> positions) {
    Eigen::AlignedBox3d box;
    for (int s = 0; s < model.strand_count(); ++s) box.extend(positions[model.offsets[s]]);
    std::vector<uint32_t> code(model.strand_count());
    for (int s = 0; s < model.strand_count(); ++s) {
        const Eigen::Array3d point = (positions[model.offsets[s]] - box.min()).array() / (box.sizes().array() + 1e-300);
        code[s] = morton_code(point.min(1.0));
    }
    std::vector<int> order = order_by_length(model);
    const auto length = [&](int s) { return model.offsets[s + 1] - model.offsets[s]; };
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return length(a) != length(b) ? length(a) > length(b) : code[a] < code[b]; });
    return order;
}

} // namespace ringlet
