#include "ringlet/groom/hairs.h"

#include "ringlet/groom/hairs_kernel.h"

namespace ringlet {
namespace {

// Coordinates apart, with a point more before the root and two after the tip.
class Table {
public:
    // Rows: x, y, z of the point, of a and of b.
    LockTable fill(View<Vec3f> source, View<Vec3> axis_seed) {
        const size_t n = source.size(), stride = n + 3;
        points_.resize(n);
        tangents_.resize(n);
        axes_.resize(n);
        for (size_t i = 0; i < n; ++i) points_[i] = source[i].cast<double>();
        tangents(points_, tangents_);
        transport(points_, tangents_, axis_seed.front(), axes_);

        numbers_.resize(9 * stride);
        const auto put = [&](size_t at, const Vec3f &p, const Vec3f &a, const Vec3f &b) {
            for (size_t c = 0; c < 3; ++c) {
                numbers_[c * stride + at] = p[c];
                numbers_[(3 + c) * stride + at] = a[c];
                numbers_[(6 + c) * stride + at] = b[c];
            }
        };
        for (size_t i = 0; i < n; ++i)
            put(i + 1, source[i], axes_[i].cast<float>(), tangents_[i].cross(axes_[i]).cast<float>());
        // The curve goes on as a parabola beyond its ends (see resample.cpp).
        const bool bent = n > 2;
        const Vec3f before =
            bent ? Vec3f(3.0f * source[0] - 3.0f * source[1] + source[2]) : Vec3f(2.0f * source[0] - source[1]);
        const Vec3f after = bent ? Vec3f(3.0f * source[n - 1] - 3.0f * source[n - 2] + source[n - 3])
                                 : Vec3f(2.0f * source[n - 1] - source[n - 2]);
        put(0, before, axes_[0].cast<float>(), tangents_[0].cross(axes_[0]).cast<float>());
        const Vec3f a = axes_[n - 1].cast<float>(), b = tangents_[n - 1].cross(axes_[n - 1]).cast<float>();
        put(n + 1, after, a, b);
        put(n + 2, after, a, b);

        LockTable table{};
        for (size_t c = 0; c < 3; ++c) {
            table.point[c] = &numbers_[c * stride + 1];
            table.a[c] = &numbers_[(3 + c) * stride + 1];
            table.b[c] = &numbers_[(6 + c) * stride + 1];
        }
        table.last = static_cast<int>(n) - 1;
        return table;
    }

private:
    std::vector<Vec3> points_, tangents_, axes_;
    std::vector<float> numbers_;
};

} // namespace

void warp_hairs(View<Vec3f> lock_points, View<int> lock_offsets, View<Vec3> axis, View<float> root, const HairLayout &layout,
                std::span<float> result) {
    const int locks = static_cast<int>(lock_offsets.size()) - 1, points = static_cast<int>(layout.profile.size());
#pragma omp parallel
    {
        Table table;
        std::vector<float> scratch(5 * static_cast<size_t>(points));
#pragma omp for schedule(dynamic, 8)
        for (int lock = 0; lock < locks; ++lock) {
            const int begin = lock_offsets[lock];
            const LockTable filled =
                table.fill(lock_points.subspan(begin, lock_offsets[lock + 1] - begin), axis.subspan(lock, 1));
            const size_t first = layout.first[lock];
            const HairSpan hairs{.count = layout.first[lock + 1] - layout.first[lock],
                                 .points = points,
                                 .knots = layout.knots,
                                 .offset = layout.offset.data() + 2 * first,
                                 .tip = layout.tip.data() + first,
                                 .frizz = layout.frizz.data() + 2 * layout.knots * first,
                                 .root = root.data() + 3 * first,
                                 .profile = layout.profile.data(),
                                 .hold = layout.hold.data(),
                                 .scratch = scratch.data(),
                                 .result = result.data() + 3 * first * points};
            RINGLET_DISPATCH(fill_hairs, filled, hairs);
        }
    }
}

} // namespace ringlet
