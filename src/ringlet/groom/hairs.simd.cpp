#include "ringlet/groom/hairs_kernel.h"

namespace ringlet::RINGLET_SIMD {

void fill_hairs(const LockTable &lock, const HairSpan &hairs) {
    const int n = hairs.points;
    float *__restrict x = hairs.scratch, *__restrict y = x + n, *__restrict xyz[3] = {y + n, y + 2 * n, y + 3 * n};
    const float *__restrict profile = hairs.profile, *__restrict hold = hairs.hold;
    const float per_point = 1.0f / static_cast<float>(n - 1);

    for (int hair = 0; hair < hairs.count; ++hair) {
        const float *offset = hairs.offset + 2 * hair, *root = hairs.root + 3 * hair;
        const float *__restrict frizz = hairs.frizz + 2 * hairs.knots * hair;
        const float offset_x = offset[0], offset_y = offset[1];

        // Across the lock: the offset, and a wander eased from knot to knot.
        const float knot_step = static_cast<float>(hairs.knots - 1) * per_point;
        for (int k = 0; k < n; ++k) {
            const float at = static_cast<float>(k) * knot_step;
            int i = static_cast<int>(at);
            i = i < hairs.knots - 2 ? i : hairs.knots - 2;
            float t = at - static_cast<float>(i);
            t = t * t * (3.0f - 2.0f * t);
            const float follow = 1.0f - hold[k];
            x[k] = follow * (profile[k] * offset_x + (1.0f - t) * frizz[2 * i] + t * frizz[2 * i + 2]);
            y[k] = follow * (profile[k] * offset_y + (1.0f - t) * frizz[2 * i + 1] + t * frizz[2 * i + 3]);
        }

        // Along the lock: Catmull–Rom for the points, straight for the frame.
        const float step = hairs.tip[hair] * (static_cast<float>(lock.last) * per_point);
        for (int c = 0; c < 3; ++c) {
            const float *__restrict p = lock.point[c], *__restrict a = lock.a[c], *__restrict b = lock.b[c];
            float *__restrict out = xyz[c];
            const float root_c = root[c];
            for (int k = 0; k < n; ++k) {
                const float at = static_cast<float>(k) * step;
                int i = static_cast<int>(at);
                i = i < lock.last ? i : lock.last;
                const float t = at - static_cast<float>(i);
                const float p0 = p[i - 1], p1 = p[i], p2 = p[i + 1], p3 = p[i + 2];
                const float on_lock =
                    p1 +
                    0.5f * t * ((p2 - p0) + t * ((2.0f * p0 - 5.0f * p1 + 4.0f * p2 - p3) + t * (3.0f * (p1 - p2) + p3 - p0)));
                out[k] =
                    on_lock + x[k] * (a[i] + t * (a[i + 1] - a[i])) + y[k] * (b[i] + t * (b[i + 1] - b[i])) + hold[k] * root_c;
            }
        }
        float *__restrict result = hairs.result + 3L * n * hair;
        for (int k = 0; k < n; ++k)
            for (int c = 0; c < 3; ++c) result[3 * k + c] = xyz[c][k];
    }
}

} // namespace ringlet::RINGLET_SIMD
