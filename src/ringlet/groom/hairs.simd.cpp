#include "ringlet/groom/hairs_kernel.h"

#include <algorithm>
#include <cmath>
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

// Cosine of a phase in turns, within 0.1 %.
float cosine(float turns) {
    const float shifted = turns + 0.25f, t = shifted - std::floor(shifted + 0.5f); // a sine over -½ … ½
    const float parabola = 8.0f * t * (1.0f - 2.0f * std::fabs(t));
    return parabola + 0.225f * (parabola * std::fabs(parabola) - parabola);
}

// Triangle wave in phase with the cosine.
float zigzag(float turns) { return 1.0f - 4.0f * std::fabs(turns - std::floor(turns + 0.5f)); }

// Places of a hair across its lock (x, y), and in the frame of the lock's centre line: the cosine and sine of the slip times
// the radius that is left, and the escape.
struct Across {
    const float *x, *y, *turn_cos, *turn_sin, *escape_x, *escape_y;
};

// By value and inline: else each point of a hair asks anew for what its lock has.
[[gnu::always_inline]] inline Float4 on_lock(LockTable lock, int i, float t, const Across &across, int k) {
    const Float4 point = on_lock(lock.segments[i], t, across.x[k], across.y[k]);
    if (lock.centres == nullptr) return point;
    const CentreSegment &centre = lock.centres[i];
    const Float4 u = row(centre.u) + t * row(centre.du), v = row(centre.v) + t * row(centre.dv);
    const float c = across.turn_cos[k], s = across.turn_sin[k];
    const float a = u[3], b = v[3];
    return point + (across.escape_x[k] + c * a - s * b) * u + (across.escape_y[k] + s * a + c * b) * v;
}

} // namespace

void fill_hairs(const LockTable &table, const HairSpan &hairs) {
    const LockTable lock = table; // no result is written over it
    const int n = hairs.points, last = lock.last, last_knot = hairs.knots - 2;
    float *__restrict x = hairs.scratch, *__restrict y = x + n, *__restrict along = y + n, *__restrict eased = along + n;
    int *__restrict segment = reinterpret_cast<int *>(eased + n), *__restrict knot = segment + n;
    float *__restrict turn_cos = eased + 3L * n, *__restrict turn_sin = turn_cos + n;
    float *__restrict escape_x = turn_sin + n, *__restrict escape_y = escape_x + n;
    const float *__restrict profile = hairs.profile, *__restrict hold = hairs.hold, *__restrict pace = hairs.pace;
    const CurlSpan &curl = hairs.curl;
    const Across across{x, y, turn_cos, turn_sin, escape_x, escape_y};
    const float ends = static_cast<float>(n - 1), per_point = 1.0f / ends;

    // Frizz is interpolated by a smoothstep between knots, whose places all hairs share.
    for (int k = 0; k < n; ++k) {
        const float at = static_cast<float>(k) * (static_cast<float>(last_knot + 1) * per_point);
        const int i = static_cast<int>(at);
        knot[k] = i < last_knot ? i : last_knot;
        const float t = at - static_cast<float>(i < last_knot ? i : last_knot);
        eased[k] = t * t * (3.0f - 2.0f * t);
    }

    for (int hair = 0; hair < hairs.count; ++hair) {
        const float *__restrict frizz = hairs.frizz + 2 * hairs.knots * hair;
        const float offset_x = hairs.offset[2 * hair], offset_y = hairs.offset[2 * hair + 1];
        const float taper = hairs.taper[hair] * per_point;
        for (int k = 0; k < n; ++k) { // across the lock
            const int i = 2 * knot[k];
            const float t = eased[k], follow = 1.0f - hold[k], wide = profile[k] * (1.0f - taper * static_cast<float>(k));
            x[k] = follow * (wide * offset_x + frizz[i] + t * (frizz[i + 2] - frizz[i]));
            y[k] = follow * (wide * offset_y + frizz[i + 1] + t * (frizz[i + 3] - frizz[i + 1]));
        }
        if (curl.slip != nullptr) {
            const float *__restrict slip = curl.slip + hairs.knots * hair, *__restrict phase = curl.phase + hairs.knots * hair;
            const float family_x = curl.family[2 * hair], family_y = curl.family[2 * hair + 1];
            const float coil_x = curl.coil[4 * hair], coil_y = curl.coil[4 * hair + 1], kink = curl.coil[4 * hair + 3];
            const float turns = curl.coil[4 * hair + 2] * per_point, relax = curl.relax[hair];
            const float away_x = curl.escape[2 * hair], away_y = curl.escape[2 * hair + 1];
            for (int k = 0; k < n; ++k) {
                const int i = knot[k];
                const float t = eased[k], follow = 1.0f - hold[k], wide = profile[k] * (1.0f - taper * static_cast<float>(k));
                const float at = turns * static_cast<float>(k) + phase[i] + t * (phase[i + 1] - phase[i]);
                const float flat = cosine(at), open = follow * curl.opening[k], tight = follow * wide * curl.tight[k];
                const float to = open * (flat + kink * (zigzag(at) - flat)), up = open * (1.0f - kink) * cosine(at - 0.25f);
                x[k] += tight * family_x + to * coil_x - up * coil_y;
                y[k] += tight * family_y + to * coil_y + up * coil_x;
                const float turned = slip[i] + t * (slip[i + 1] - slip[i]), left = 1.0f - relax * curl.relaxing[k];
                turn_cos[k] = follow * (left * cosine(turned) - 1.0f);
                turn_sin[k] = follow * left * cosine(turned - 0.25f);
                escape_x[k] = follow * curl.escaping[k] * away_x;
                escape_y[k] = follow * curl.escaping[k] * away_y;
            }
        }
        const float join = hairs.join[hair], flat = hairs.flat[hair], begin = join * static_cast<float>(last);
        const float step = (hairs.tip[hair] - join) * (static_cast<float>(last) * per_point);
        for (int k = 0; k < n; ++k) { // along it
            const float s = static_cast<float>(k), at = begin + (s + flat * (pace[k] * ends - s)) * step;
            const int i = static_cast<int>(at);
            segment[k] = i < last ? i : last;
            along[k] = at - static_cast<float>(i < last ? i : last);
        }

        const auto joined = [&](const LockTable &of, float at) { // place of a lock where the hair joins it
            const int i = std::min(static_cast<int>(at), of.last);
            return join > 0.0f ? on_lock(of.segments[i], at - static_cast<float>(i), 0.0f, 0.0f) : row(of.segments[0].c0);
        };
        const Float4 from{hairs.root[3 * hair], hairs.root[3 * hair + 1], hairs.root[3 * hair + 2], 0.0f};
        const Float4 root = from + (row(lock.segments[0].c0) - joined(lock, begin));
        float *result = hairs.result + 3L * n * hair;
        // A row of four also writes the first number of the next point, which is written after it.
        const auto put = [&](int k, Float4 point) { std::memcpy(result + 3 * k, &point, k + 1 < n ? 16 : 12); };
        if (hairs.other == nullptr || hairs.share[hair] == 0.0f) {
            for (int k = 0; k + 1 < n; ++k) put(k, on_lock(lock, segment[k], along[k], across, k) + hold[k] * root);
            put(n - 1, on_lock(lock, segment[n - 1], along[n - 1], across, n - 1) + hold[n - 1] * root);
            continue;
        }
        const float share = hairs.share[hair];
        const LockTable other = hairs.locks[hairs.other[hair]];
        const float rescale = static_cast<float>(other.last) / static_cast<float>(lock.last);
        const Float4 other_root = from + (row(lock.segments[0].c0) - joined(other, begin * rescale));
        for (int k = 0; k < n; ++k) {
            const float at = (static_cast<float>(segment[k]) + along[k]) * rescale;
            int i = static_cast<int>(at);
            i = i < other.last ? i : other.last;
            const Float4 own = on_lock(lock, segment[k], along[k], across, k) + hold[k] * root;
            const Float4 theirs = on_lock(other, i, at - static_cast<float>(i), across, k) + hold[k] * other_root;
            put(k, own + share * hairs.blend[k] * (theirs - own));
        }
    }
}

} // namespace ringlet::RINGLET_SIMD
