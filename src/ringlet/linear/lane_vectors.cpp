#include "ringlet/linear/lane_vectors.h"

namespace ringlet {

void lane_dots(const double *a, const double *b, int rows, int lanes, double *dots) {
    if (lanes > 1) return RINGLET_DISPATCH(lane_dots, a, b, rows, dots);
    dots[0] = 0.0;
    for (int i = 0; i < rows; ++i) dots[0] += a[i] * b[i];
}

void lane_points(const double *x, const double *t, const double *straight, const double *bend, int rows, int lanes,
                 double *to) {
    if (lanes > 1) return RINGLET_DISPATCH(lane_points, x, t, straight, bend, rows, to);
    for (int i = 0; i < rows; ++i) to[i] = x[i] + t[0] * (straight[i] + t[0] * bend[i]);
}

} // namespace ringlet
