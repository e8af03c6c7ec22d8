#include "ringlet/solver/lane_vectors.h"

#include "ringlet/math/pack.h"

namespace ringlet::RINGLET_SIMD {
namespace {

const Pack *packs(const double *values) { return reinterpret_cast<const Pack *>(values); }
Pack *packs(double *values) { return reinterpret_cast<Pack *>(values); }

Pack of_lanes(const double *values) {
    Pack pack;
    for (int lane = 0; lane < lanes; ++lane) set_lane(pack, lane, values[lane]);
    return pack;
}

void to_lanes(Pack pack, double *values) {
    for (int lane = 0; lane < lanes; ++lane) values[lane] = pack[lane];
}

} // namespace

void lane_products(const double *a, const double *b, int rows, double *products) {
    Pack sum{};
    for (int i = 0; i < rows; ++i) sum += packs(a)[i] * packs(b)[i];
    to_lanes(sum, products);
}

void lane_move(const double *x, const double *step, const double *straight, const double *bend, int rows, double *to) {
    const Pack part = of_lanes(step);
    for (int i = 0; i < rows; ++i) packs(to)[i] = packs(x)[i] + part * (packs(straight)[i] + part * packs(bend)[i]);
}

} // namespace ringlet::RINGLET_SIMD
