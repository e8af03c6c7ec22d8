#include "arrays.h"

#include "ringlet/groom/curl.h"
#include "ringlet/groom/hairs.h"
#include "ringlet/groom/push_out.h"
#include "ringlet/groom/sample.h"

#include <stdexcept>

namespace nb = nanobind;
using namespace nb::literals;
using namespace ringlet;
using namespace ringlet::bindings;

namespace {

template <class Scalar> using Table = nb::ndarray<const Scalar, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

template <class Scalar> View<Scalar> numbers(const Table<Scalar> &table) { return {table.data(), table.size()}; }

void require(bool holds, const char *message) {
    if (!holds) throw std::invalid_argument(message);
}

nb::ndarray<nb::numpy, int> thin_out_samples(const Array3<double> &candidates, double area, int count) {
    require(area > 0.0 && count >= 0, "area must be positive and count at least 0");
    std::vector<int> kept;
    {
        nb::gil_scoped_release release;
        kept = thin_out(vectors<Vec3>(candidates), area, count);
    }
    const size_t size = kept.size();
    return to_numpy<int>(std::move(kept), {size});
}

nb::ndarray<nb::numpy, double> curl_curves(const Array3<double> &points, const Array1<int> &offsets, const Array3<double> &axis,
                                           const Array1<double> &radius, const Array1<double> &turns,
                                           const Array1<double> &phase, const Array1<double> &start,
                                           const Array1<double> &width_ramp, const Array1<double> &rate_ramp,
                                           const Table<double> &width_noise, const Table<double> &rate_noise,
                                           const Table<double> &hand, double flatness, bool keep_length, int count) {
    const CurveView shapes{vectors<Vec3>(points), view(offsets)};
    const size_t locks = shapes.count(), noises = hand.shape(1);
    require(axis.shape(0) == locks && radius.size() == locks && turns.size() == locks && phase.size() == locks &&
                start.size() == locks,
            "axis, radius, turns, phase and start need one value a lock");
    require(noises > 0 && width_noise.shape(0) == locks && rate_noise.shape(0) == locks && hand.shape(0) == locks &&
                width_noise.shape(1) == noises && rate_noise.shape(1) == noises,
            "the noises need one row a lock");
    require(width_ramp.size() > 0 && rate_ramp.size() > 0 && count >= 2, "ramps need a value, and locks 2 points");
    const CurlSettings settings{.axis = vectors<Vec3>(axis),
                                .radius = view(radius),
                                .turns = view(turns),
                                .phase = view(phase),
                                .start = view(start),
                                .width_ramp = view(width_ramp),
                                .rate_ramp = view(rate_ramp),
                                .width_noise = numbers(width_noise),
                                .rate_noise = numbers(rate_noise),
                                .hand = numbers(hand),
                                .noise_count = static_cast<int>(noises),
                                .flatness = flatness,
                                .keep_length = keep_length};
    std::vector<Vec3> result;
    {
        nb::gil_scoped_release release;
        result = curl(shapes, settings, count);
    }
    return to_numpy<double>(std::move(result), {locks * static_cast<size_t>(count), 3});
}

nb::ndarray<nb::numpy, double> push_out_curves(const Array3<double> &points, const Array1<int> &offsets,
                                               const Array3<double> &body_points, const Array3<int> &body_triangles,
                                               double margin) {
    const CurveView curves{vectors<Vec3>(points), view(offsets)};
    const TriangleMesh body{vectors<Vec3>(body_points), vectors<Triangle>(body_triangles)};
    require(!body.triangles.empty(), "the body has no triangles");
    std::vector<Vec3> result;
    {
        nb::gil_scoped_release release;
        result = push_out(curves, body, margin);
    }
    return to_numpy<double>(std::move(result), {curves.points.size(), 3});
}

nb::ndarray<nb::numpy, float> warp(const Array3<float> &lock_points, const Array1<int> &lock_offsets,
                                   const Array3<double> &axis, const Array3<float> &root, const Array1<int> &first,
                                   const Table<float> &offset, const Array1<float> &tip, const Table<float> &frizz,
                                   const Array1<float> &profile, const Array1<float> &hold) {
    const size_t locks = lock_offsets.size() - 1, points = profile.size(), hairs = first.data()[locks];
    require(first.size() == locks + 1 && axis.shape(0) == locks, "first and axis need one row a lock");
    require(root.shape(0) == hairs && offset.size() == 2 * hairs && tip.size() == hairs && frizz.shape(0) == hairs,
            "root, offset, tip and frizz need one row a hair");
    require(frizz.shape(1) >= 4 && frizz.shape(1) % 2 == 0, "frizz needs at least 2 knots of two numbers");
    require(hold.size() == points && points >= 2, "profile and hold need one value a point");
    const HairLayout layout{.first = view(first),
                            .offset = numbers(offset),
                            .tip = view(tip),
                            .frizz = numbers(frizz),
                            .knots = static_cast<int>(frizz.shape(1) / 2),
                            .profile = view(profile),
                            .hold = view(hold)};
    // Not a std::vector, which would first write zeros all over what is written next.
    auto *result = new float[3 * hairs * points];
    nb::capsule owner(result, [](void *p) noexcept { delete[] static_cast<float *>(p); });
    {
        nb::gil_scoped_release release;
        warp_hairs(vectors<Vec3f>(lock_points), view(lock_offsets), vectors<Vec3>(axis), {root.data(), 3 * hairs}, layout,
                   {result, 3 * hairs * points});
    }
    return nb::ndarray<nb::numpy, float>(result, {hairs * points, 3}, owner);
}

} // namespace

void bind_groom(nb::module_ &module) {
    module.def(
        "thin_out", &thin_out_samples, "candidates"_a, "area"_a, "count"_a,
        "Indices of count evenly spread samples out of a dense cloud of candidates (n, 3) on a surface of that area [m2].");
    module.def("curl_curves", &curl_curves, "points"_a, "offsets"_a, nb::kw_only(), "axis"_a, "radius"_a, "turns"_a, "phase"_a,
               "start"_a, "width_ramp"_a, "rate_ramp"_a, "width_noise"_a, "rate_noise"_a, "hand"_a, "flatness"_a,
               "keep_length"_a, "count"_a,
               "Winds each shape curve into a curl of count evenly spaced points; see groom/curl.h.");
    module.def("push_out", &push_out_curves, "points"_a, "offsets"_a, "body_points"_a, "body_triangles"_a, "margin"_a,
               "The points of curves moved out of a body, to a margin [m]; roots stay.");
    module.def("warp_hairs", &warp, "lock_points"_a, "lock_offsets"_a, nb::kw_only(), "axis"_a, "root"_a, "first"_a, "offset"_a,
               "tip"_a, "frizz"_a, "profile"_a, "hold"_a,
               "Points of all hairs (hairs * points, 3) around locks where they are now; see groom/hairs.h.");
}
