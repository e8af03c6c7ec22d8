#include "ringlet/scene/lane_vectors.h"

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

void lane_move(const double *x, const double *step, const double *direction, int rows, double *to) {
    const Pack part = of_lanes(step);
    for (int i = 0; i < rows; ++i) packs(to)[i] = packs(x)[i] + part * packs(direction)[i];
}

void lane_search(const double *z, const double *r, const double *beta, int rows, double *p, double *Pp, double *curvatures) {
    const Pack before = of_lanes(beta);
    Pack sum{};
    for (int i = 0; i < rows; ++i) {
        packs(p)[i] = packs(z)[i] + before * packs(p)[i];
        packs(Pp)[i] = packs(r)[i] + before * packs(Pp)[i];
        sum += packs(p)[i] * packs(Pp)[i];
    }
    to_lanes(sum, curvatures);
}

void lane_advance(const double *alpha, const double *p, const double *Pp, int rows, double *d, double *r) {
    const Pack step = of_lanes(alpha);
    for (int i = 0; i < rows; ++i) {
        packs(d)[i] += step * packs(p)[i];
        packs(r)[i] -= step * packs(Pp)[i];
    }
}

} // namespace ringlet::RINGLET_SIMD
