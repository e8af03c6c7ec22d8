#include "ringlet/groom/hairs_kernel.h"

#include <cstring>

namespace ringlet::RINGLET_SIMD {
namespace {

using Float4 = float __attribute__((vector_size(16)));

Float4 row(const float *numbers) {
    Float4 result;
    std::memcpy(&result, numbers, sizeof(result));
    return result;
}

Float4 on_lock(const LockSegment &lock, float t, float x, float y) {
    const Float4 point = row(lock.c0) + t * (row(lock.c1) + t * (row(lock.c2) + t * row(lock.c3)));
    return point + x * (row(lock.a) + t * row(lock.da)) + y * (row(lock.b) + t * row(lock.db));
}

} // namespace

void fill_hairs(const LockTable &lock, const HairSpan &hairs) {
    const int n = hairs.points;
    float *__restrict x = hairs.scratch, *__restrict y = x + n, *__restrict along = y + n;
    int *__restrict segment = reinterpret_cast<int *>(along + n);
    const float *__restrict profile = hairs.profile, *__restrict hold = hairs.hold;
    const float per_point = 1.0f / static_cast<float>(n - 1);

    for (int hair = 0; hair < hairs.count; ++hair) {
        const float *offset = hairs.offset + 2 * hair;
        const float *__restrict frizz = hairs.frizz + 2 * hairs.knots * hair;
        const float offset_x = offset[0], offset_y = offset[1], taper = hairs.taper[hair] * per_point;
        const float knot_step = static_cast<float>(hairs.knots - 1) * per_point;
        const float step = hairs.tip[hair] * (static_cast<float>(lock.last) * per_point);
        for (int k = 0; k < n; ++k) {
            // Across the lock: the offset, and a wander eased from knot to knot.
            const float knot = static_cast<float>(k) * knot_step;
            int i = static_cast<int>(knot);
            i = i < hairs.knots - 2 ? i : hairs.knots - 2;
            float t = knot - static_cast<float>(i);
            t = t * t * (3.0f - 2.0f * t);
            const float follow = 1.0f - hold[k], wide = profile[k] * (1.0f - taper * static_cast<float>(k));
            x[k] = follow * (wide * offset_x + (1.0f - t) * frizz[2 * i] + t * frizz[2 * i + 2]);
            y[k] = follow * (wide * offset_y + (1.0f - t) * frizz[2 * i + 1] + t * frizz[2 * i + 3]);
            // Along the lock.
            const float at = static_cast<float>(k) * step;
            i = static_cast<int>(at);
            i = i < lock.last ? i : lock.last;
            segment[k] = i;
            along[k] = at - static_cast<float>(i);
        }

        const Float4 root{hairs.root[3 * hair], hairs.root[3 * hair + 1], hairs.root[3 * hair + 2], 0.0f};
        float *result = hairs.result + 3L * n * hair;
        // A row of four is written over the first number of the next point, which comes after it.
        const auto put = [&](int k, Float4 point) { std::memcpy(result + 3 * k, &point, k + 1 < n ? 16 : 12); };
        const float share = hairs.other ? hairs.share[hair] : 0.0f;
        if (share == 0.0f) {
            for (int k = 0; k + 1 < n; ++k) put(k, on_lock(lock.segments[segment[k]], along[k], x[k], y[k]) + hold[k] * root);
            put(n - 1, on_lock(lock.segments[segment[n - 1]], along[n - 1], x[n - 1], y[n - 1]) + hold[n - 1] * root);
            continue;
        }
        const LockTable &other = hairs.locks[hairs.other[hair]];
        const Float4 other_root = root + row(lock.segments[0].c0) - row(other.segments[0].c0);
        const float rescale = static_cast<float>(other.last) / static_cast<float>(lock.last);
        for (int k = 0; k < n; ++k) {
            const float at = (static_cast<float>(segment[k]) + along[k]) * rescale;
            int i = static_cast<int>(at);
            i = i < other.last ? i : other.last;
            const Float4 own = on_lock(lock.segments[segment[k]], along[k], x[k], y[k]) + hold[k] * root;
            const Float4 theirs = on_lock(other.segments[i], at - static_cast<float>(i), x[k], y[k]) + hold[k] * other_root;
            put(k, own + share * hairs.blend[k] * (theirs - own));
        }
    }
}

} // namespace ringlet::RINGLET_SIMD
