#include "ringlet/linear/lane_vectors.h"

#include "ringlet/math/pack.h"

namespace ringlet::RINGLET_SIMD {
namespace {

const Pack *packs(const double *values) { return reinterpret_cast<const Pack *>(values); }
Pack *packs(double *values) { return reinterpret_cast<Pack *>(values); }

} // namespace

int lane_width() { return lanes; }

void lane_dots(const double *a, const double *b, int rows, double *dots) {
    Pack sum{};
    for (int i = 0; i < rows; ++i) sum += packs(a)[i] * packs(b)[i];
    for (int lane = 0; lane < lanes; ++lane) dots[lane] = sum[lane];
}

void lane_points(const double *x, const double *t, const double *straight, const double *bend, int rows, double *to) {
    Pack at;
    for (int lane = 0; lane < lanes; ++lane) set_lane(at, lane, t[lane]);
    for (int i = 0; i < rows; ++i) packs(to)[i] = packs(x)[i] + at * (packs(straight)[i] + at * packs(bend)[i]);
}

} // namespace ringlet::RINGLET_SIMD
