#include "ringlet/groom/hairs.h"

#include "ringlet/geometry/centre_line.h"
#include "ringlet/groom/hairs_kernel.h"

#include <algorithm>

namespace ringlet {
namespace {

void put(float (&row)[4], const Vec3f &v) {
    for (int c = 0; c < 3; ++c) row[c] = v[c];
    row[3] = 0.0f;
}

// Writes the segments of a lock: Catmull–Rom splines for points, linear interpolation for axes.
class Segmenter {
public:
    void operator()(View<Vec3f> points, const Vec3 &axis, std::span<LockSegment> segments) {
        const size_t n = points.size();
        points_.resize(n), tangents_.resize(n), axes_.resize(n);
        for (size_t i = 0; i < n; ++i) points_[i] = points[i].cast<double>();
        tangents(points_, tangents_);
        transport(points_, tangents_, axis, axes_);

        // Parabolic extrapolation beyond the ends (see resample.cpp).
        const auto beyond = [&](size_t end, size_t next, size_t third) {
            return n > 2 ? Vec3f(3.0f * points[end] - 3.0f * points[next] + points[third])
                         : Vec3f(2.0f * points[end] - points[next]);
        };
        const Vec3f before = beyond(0, 1, std::min<size_t>(2, n - 1)), after = beyond(n - 1, n - 2, n > 2 ? n - 3 : 0);
        for (size_t i = 0; i < n; ++i) {
            LockSegment &segment = segments[i];
            const Vec3f a = axes_[i].cast<float>(), b = tangents_[i].cross(axes_[i]).cast<float>();
            const bool tip = i + 1 == n;
            const Vec3f &p1 = points[i], &p2 = tip ? points[i] : points[i + 1];
            const Vec3f &p0 = tip ? p1 : i > 0 ? points[i - 1] : before, &p3 = tip ? p1 : i + 2 < n ? points[i + 2] : after;
            const size_t next = tip ? i : i + 1;
            put(segment.c0, p1);
            put(segment.c1, 0.5f * (p2 - p0));
            put(segment.c2, 0.5f * (2.0f * p0 - 5.0f * p1 + 4.0f * p2 - p3));
            put(segment.c3, 0.5f * (3.0f * (p1 - p2) + p3 - p0));
            put(segment.a, a);
            put(segment.b, b);
            put(segment.da, axes_[next].cast<float>() - a);
            put(segment.db, tangents_[next].cross(axes_[next]).cast<float>() - b);
        }
    }

    // Writes the centre line of the lock's coil, for the points given last.
    void centres(int window, const Vec3 &axis, std::span<CentreSegment> segments) {
        const size_t n = points_.size();
        centre_.resize(n), centre_line(points_, window, centre_);
        tangents(centre_, tangents_);
        transport(centre_, tangents_, axis, axes_);
        const auto frame = [&](size_t i, CentreSegment &segment) {
            const Vec3 v = tangents_[i].cross(axes_[i]), across = points_[i] - centre_[i];
            put(segment.u, axes_[i].cast<float>()), put(segment.v, v.cast<float>());
            segment.u[3] = static_cast<float>(across.dot(axes_[i])), segment.v[3] = static_cast<float>(across.dot(v));
        };
        for (size_t i = 0; i < n; ++i) frame(i, segments[i]);
        for (size_t i = 0; i < n; ++i) {
            const CentreSegment &next = segments[std::min(i + 1, n - 1)];
            for (int c = 0; c < 4; ++c)
                segments[i].du[c] = next.u[c] - segments[i].u[c], segments[i].dv[c] = next.v[c] - segments[i].v[c];
        }
    }

private:
    std::vector<Vec3> points_, tangents_, axes_, centre_;
};

// The curl's arrays from a hair on.
CurlSpan from(const HairCurl &curl, size_t hair, int knots) {
    if (curl.empty()) return {};
    return {.slip = curl.slip.data() + knots * hair,
            .escape = curl.escape.data() + 2 * hair,
            .relax = curl.relax.data() + hair,
            .family = curl.family.data() + 2 * hair,
            .coil = curl.coil.data() + 4 * hair,
            .phase = curl.phase.data() + knots * hair,
            .escaping = curl.escaping.data(),
            .relaxing = curl.relaxing.data(),
            .tight = curl.tight.data(),
            .opening = curl.opening.data()};
}

} // namespace

void warp_hairs(View<Vec3f> lock_points, View<int> lock_offsets, View<Vec3> axis, View<float> root, const HairLayout &layout,
                std::span<float> result) {
    const int locks = static_cast<int>(lock_offsets.size()) - 1, points = static_cast<int>(layout.profile.size());
    const bool blended = !layout.other.empty(), curled = !layout.curl.empty();
    int longest = 0;
    for (int lock = 0; lock < locks; ++lock) longest = std::max(longest, lock_offsets[lock + 1] - lock_offsets[lock]);
    // Blended hairs need the segments of all locks; otherwise each thread keeps those of one lock in its cache.
    std::vector<LockSegment> all(blended ? lock_points.size() : 0);
    std::vector<CentreSegment> all_centres(blended && curled ? lock_points.size() : 0);
    std::vector<LockTable> tables(blended ? locks : 0);
#pragma omp parallel
    {
        Segmenter fill;
        std::vector<LockSegment> one(blended ? 0 : longest);
        std::vector<CentreSegment> one_centre(curled && !blended ? longest : 0);
        std::vector<float> scratch(scratch_rows * static_cast<size_t>(points));
        const auto table = [&](int lock) {
            const size_t begin = lock_offsets[lock], count = lock_offsets[lock + 1] - begin;
            const std::span<LockSegment> segments =
                blended ? std::span(all).subspan(begin, count) : std::span(one).first(count);
            fill(lock_points.subspan(begin, count), axis[lock], segments);
            if (!curled) return LockTable{segments.data(), nullptr, static_cast<int>(count) - 1};
            const std::span<CentreSegment> centres =
                blended ? std::span(all_centres).subspan(begin, count) : std::span(one_centre).first(count);
            fill.centres(layout.curl.window[lock], axis[lock], centres);
            return LockTable{segments.data(), centres.data(), static_cast<int>(count) - 1};
        };
        if (blended) {
#pragma omp for schedule(dynamic, 8)
            for (int lock = 0; lock < locks; ++lock) tables[lock] = table(lock);
        }
#pragma omp for schedule(dynamic, 8)
        for (int lock = 0; lock < locks; ++lock) {
            const size_t first = layout.first[lock];
            const HairSpan hairs{.count = layout.first[lock + 1] - layout.first[lock],
                                 .points = points,
                                 .knots = layout.knots,
                                 .offset = layout.offset.data() + 2 * first,
                                 .tip = layout.tip.data() + first,
                                 .join = layout.join.data() + first,
                                 .flat = layout.flat.data() + first,
                                 .taper = layout.taper.data() + first,
                                 .frizz = layout.frizz.data() + 2 * layout.knots * first,
                                 .root = root.data() + 3 * first,
                                 .profile = layout.profile.data(),
                                 .hold = layout.hold.data(),
                                 .pace = layout.pace.data(),
                                 .blend = layout.blend.data(),
                                 .other = blended ? layout.other.data() + first : nullptr,
                                 .share = blended ? layout.share.data() + first : nullptr,
                                 .locks = tables.data(),
                                 .curl = from(layout.curl, first, layout.knots),
                                 .scratch = scratch.data(),
                                 .result = result.data() + 3 * first * points};
            RINGLET_DISPATCH(fill_hairs, blended ? tables[lock] : table(lock), hairs);
        }
    }
}

} // namespace ringlet
