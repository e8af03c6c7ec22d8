#include "arrays.h"

#include "ringlet/groom/curl.h"
#include "ringlet/groom/hairs.h"
#include "ringlet/groom/keep_beside.h"
#include "ringlet/groom/push_out.h"
#include "ringlet/groom/repair.h"
#include "ringlet/groom/sample.h"

#include <cstdint>
#include <iterator>
#include <nanobind/stl/optional.h>
#include <stdexcept>
#include <string>

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

// Array among the keyword arguments; valid as long as they are.
template <class Scalar> View<Scalar> named(const nb::dict &arrays, const char *name) {
    if (!arrays.contains(name)) throw std::invalid_argument(std::string(name) + " is missing");
    const auto array = nb::cast<nb::ndarray<const Scalar, nb::c_contig, nb::device::cpu>>(arrays[name], false);
    return {array.data(), array.size()};
}

nb::ndarray<nb::numpy, double> curl_curves(const Array3<double> &points, const Array1<int> &offsets, const Array3<double> &axis,
                                           const Array1<int> &leader, bool counted, bool keep_length, int count,
                                           const nb::kwargs &arrays) {
    const CurveView shapes{vectors<Vec3>(points), view(offsets)};
    const size_t locks = shapes.count();
    require(axis.shape(0) == locks && leader.size() == locks && count >= 2,
            "axis and leader need a value a lock, locks 2 points");
    for (const int i : view(leader)) require(i >= 0 && static_cast<size_t>(i) < locks, "a leader is not one of the locks");
    CurlSettings settings{.axis = vectors<Vec3>(axis), .leader = view(leader), .counted = counted, .keep_length = keep_length};
    if (locks > 0) {
        settings.noise_count = static_cast<int>(named<double>(arrays, "sway").size() / locks);
        settings.event_count = static_cast<int>(named<double>(arrays, "skips").size() / locks);
    }
    require(settings.noise_count > 0, "sway needs a value a lock");
    for (const auto &[name, array, kind] : curl_fields) {
        const View<double> values = settings.*array = named<double>(arrays, name);
        const auto rows_of = [&](size_t columns) { return values.size() == locks * columns; };
        const bool fits = kind == CurlArray::ramp     ? !values.empty()
                          : kind == CurlArray::noise  ? rows_of(settings.noise_count)
                          : kind == CurlArray::events ? rows_of(settings.event_count)
                                                      : rows_of(1);
        if (!fits) throw std::invalid_argument(std::string(name) + " has another size than the locks ask for");
    }
    require(arrays.size() == std::size(curl_fields), "an array is not one of a curl");
    std::vector<Vec3> result;
    {
        nb::gil_scoped_release release;
        result = curl(shapes, settings, count);
    }
    return to_numpy<double>(std::move(result), {locks * static_cast<size_t>(count), 3});
}

std::vector<const Solid *> solids(const nb::list &bodies) {
    std::vector<const Solid *> result;
    for (const nb::handle body : bodies) result.push_back(nb::cast<const Solid *>(body));
    return result;
}

nb::ndarray<nb::numpy, double> push_out_curves(const Array3<double> &points, const Array1<int> &offsets, const nb::list &bodies,
                                               double margin) {
    const CurveView curves{vectors<Vec3>(points), view(offsets)};
    const std::vector<const Solid *> all = solids(bodies);
    std::vector<Vec3> result;
    {
        nb::gil_scoped_release release;
        result = push_out(curves, all, margin);
    }
    return to_numpy<double>(std::move(result), {curves.points.size(), 3});
}

// (body (k,), point (k,), triangle (k,), place (k, 3), depth (k,)) of places in a body.
nb::tuple sunk_places(const Array3<double> &points, const Array1<int> &offsets, const nb::list &bodies, double root_depth,
                      double root_length) {
    const CurveView curves{vectors<Vec3>(points), view(offsets)};
    const std::vector<const Solid *> all = solids(bodies);
    std::vector<Penetration> found;
    {
        nb::gil_scoped_release release;
        found = find_penetrations(curves, all, {root_depth, root_length, 0.0});
    }
    const size_t count = found.size();
    std::vector<int> body, point, triangle;
    std::vector<Vec3> place;
    std::vector<double> depth;
    for (const Penetration &one : found) {
        body.push_back(one.body);
        point.push_back(one.point);
        triangle.push_back(one.triangle);
        place.push_back(one.place);
        depth.push_back(one.depth);
    }
    return nb::make_tuple(to_numpy<int>(std::move(body), {count}), to_numpy<int>(std::move(point), {count}),
                          to_numpy<int>(std::move(triangle), {count}), to_numpy<double>(std::move(place), {count, 3}),
                          to_numpy<double>(std::move(depth), {count}));
}

// (first points of the two segments (k, 2), midpoint between them (k, 3), distance (k,)) of overlapping pairs.
nb::tuple crossings(const Array3<double> &points, const Array1<int> &offsets, const Array1<double> &radius) {
    const CurveView curves{vectors<Vec3>(points), view(offsets)};
    std::vector<Overlap> found;
    {
        nb::gil_scoped_release release;
        found = find_overlaps(curves, view(radius));
    }
    const size_t count = found.size();
    std::vector<std::array<int, 2>> pair;
    std::vector<Vec3> place;
    std::vector<double> distance;
    for (const Overlap &one : found) {
        pair.push_back({one.a, one.b});
        place.push_back((1.0 - one.s) * curves.points[one.a] + one.s * curves.points[one.a + 1] + 0.5 * one.separation);
        distance.push_back(one.distance);
    }
    return nb::make_tuple(to_numpy<int>(std::move(pair), {count, 2}), to_numpy<double>(std::move(place), {count, 3}),
                          to_numpy<double>(std::move(distance), {count}));
}

// The curl of hairs from its arrays by name, valid as long as they are.
HairCurl curl_of_hairs(const nb::dict &arrays, size_t hairs, size_t knots, size_t points) {
    const struct {
        const char *name;
        View<float> HairCurl::*array;
        size_t size;
    } fields[] = {{"slip", &HairCurl::slip, knots * hairs},  {"escape", &HairCurl::escape, 2 * hairs},
                  {"relax", &HairCurl::relax, hairs},        {"family", &HairCurl::family, 2 * hairs},
                  {"coil", &HairCurl::coil, 4 * hairs},      {"phase", &HairCurl::phase, knots * hairs},
                  {"escaping", &HairCurl::escaping, points}, {"relaxing", &HairCurl::relaxing, points},
                  {"tight", &HairCurl::tight, points},       {"opening", &HairCurl::opening, points}};
    HairCurl curl;
    for (const auto &field : fields) {
        curl.*field.array = named<float>(arrays, field.name);
        require((curl.*field.array).size() == field.size, field.name);
    }
    return curl;
}

void warp(const Array3<float> &lock_points, const Array1<int> &lock_offsets,
          nb::ndarray<float, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu> result, const Array3<double> &axis,
          const Array3<float> &root, const Array1<int> &first, const Table<float> &offset, const Array1<float> &tip,
          const Array1<float> &join, const Array1<float> &flat, const Array1<float> &taper, const Table<float> &frizz,
          const Array1<float> &profile, const Array1<float> &hold, const Array1<float> &pace, const Array1<int> &other,
          const Array1<float> &share, const Array1<float> &blend, const Array1<int> &window, const nb::dict &curl) {
    const size_t locks = lock_offsets.size() - 1, points = profile.size(), hairs = first.data()[locks];
    require(first.size() == locks + 1 && axis.shape(0) == locks, "first and axis need one row a lock");
    require(root.shape(0) == hairs && offset.size() == 2 * hairs && tip.size() == hairs && join.size() == hairs &&
                flat.size() == hairs && taper.size() == hairs && frizz.shape(0) == hairs,
            "root, offset, tip, join, flat, taper and frizz need one row a hair");
    require(frizz.shape(1) >= 4 && frizz.shape(1) % 2 == 0, "frizz needs at least 2 knots of two numbers");
    require(hold.size() == points && pace.size() == points && blend.size() == points && points >= 2,
            "profile, hold, pace and blend need one value a point");
    require(other.size() == share.size() && (other.size() == 0 || other.size() == hairs),
            "other and share need a value a hair");
    for (const int lock : view(other)) require(lock >= 0 && static_cast<size_t>(lock) < locks, "other is not one of the locks");
    require(window.size() == (curl.size() ? locks : 0), "a curl of hairs needs a window a lock");
    require(result.shape(0) == hairs * points, "the result needs one row a point of a hair");
    HairLayout layout{.first = view(first),
                      .offset = numbers(offset),
                      .tip = view(tip),
                      .join = view(join),
                      .flat = view(flat),
                      .taper = view(taper),
                      .frizz = numbers(frizz),
                      .knots = static_cast<int>(frizz.shape(1) / 2),
                      .profile = view(profile),
                      .hold = view(hold),
                      .pace = view(pace),
                      .other = view(other),
                      .share = view(share),
                      .blend = view(blend),
                      .curl = {}};
    if (curl.size()) layout.curl = curl_of_hairs(curl, hairs, layout.knots, points);
    layout.curl.window = view(window);
    nb::gil_scoped_release release;
    warp_hairs(vectors<Vec3f>(lock_points), view(lock_offsets), vectors<Vec3>(axis), {root.data(), 3 * hairs}, layout,
               {result.data(), 3 * hairs * points});
}

int keep_hairs(const Array3<float> &lock_points, const Array1<int> &lock_offsets,
               nb::ndarray<float, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu> hairs, const Array3<double> &points,
               const Array3<int> &triangles, double margin, const Array1<int> &first, const Array1<float> &tip,
               const Array1<float> &join, const Array1<float> &flat, const Array1<float> &hold, const Array1<float> &pace,
               std::optional<nb::ndarray<std::uint8_t, nb::shape<-1, -1>, nb::c_contig, nb::device::cpu>> shares) {
    const size_t locks = lock_offsets.size() - 1, count = first.data()[locks];
    require(first.size() == locks + 1, "first needs one row a lock");
    require(tip.size() == count && join.size() == count && flat.size() == count, "tip, join and flat need a value a hair");
    require(hold.size() >= 2 && pace.size() == hold.size() && hairs.shape(0) == count * hold.size(),
            "the hairs need one row a point");
    require(!shares || shares->size() == hairs.shape(0), "shares need one row a hair");
    HairLayout layout;
    layout.first = view(first), layout.tip = view(tip), layout.join = view(join), layout.flat = view(flat);
    layout.hold = view(hold), layout.pace = view(pace);
    const std::span<std::uint8_t> left = shares ? std::span{shares->data(), shares->size()} : std::span<std::uint8_t>{};
    const TriangleMesh surface = mesh_of(points, triangles);
    nb::gil_scoped_release release;
    return keep_beside(vectors<Vec3f>(lock_points), view(lock_offsets), layout, surface, margin,
                       {hairs.data(), 3 * count * hold.size()}, left);
}

} // namespace

void bind_groom(nb::module_ &module) {
    module.def("thin_out", &thin_out_samples, "candidates"_a, "area"_a, "count"_a,
               "Indices of count blue-noise samples out of a dense cloud of candidates (n, 3) on a surface of that area [m2].");
    module.def("curl_curves", &curl_curves, "points"_a, "offsets"_a, nb::kw_only(), "axis"_a, "leader"_a, "counted"_a,
               "keep_length"_a, "count"_a, "arrays"_a,
               "Winds each shape curve into a curl of count evenly spaced points; the arrays are those of groom/curl.h.");
    module.def("push_out", &push_out_curves, "points"_a, "offsets"_a, "bodies"_a, "margin"_a,
               "Points of curves that are moved out of Solids, to a distance of margin [m]; roots stay.");
    module.def("sunk_places", &sunk_places, "points"_a, "offsets"_a, "bodies"_a, "root_depth"_a, "root_length"_a,
               "Places of curves inside Solids: body (k,), point before it (k,), triangle (k,), place (k, 3), depth (k,) [m].");
    module.def("crossings", &crossings, "points"_a, "offsets"_a, "radius"_a,
               "Pairs of segments nearer than the sum of the radii (n,) at their first points [m]: first points (k, 2), "
               "midpoints (k, 3), distances (k,) [m].");
    nb::class_<Repair>(module, "Repair", "Moves curves out of Solids and out of one another; see groom/repair.h.")
        .def(
            "__init__",
            [](Repair *repair, const Array3<double> &points, const Array1<int> &offsets, const nb::list &bodies,
               double root_depth, double root_length, double thickness) {
                const CurveView curves{vectors<Vec3>(points), view(offsets)};
                const std::vector<const Solid *> all = solids(bodies);
                nb::gil_scoped_release release;
                new (repair) Repair(curves, all, {root_depth, root_length, thickness});
            },
            "points"_a, "offsets"_a, "bodies"_a, "root_depth"_a, "root_length"_a, "thickness"_a, nb::keep_alive<1, 4>())
        .def("round", &Repair::round, nb::call_guard<nb::gil_scoped_release>(),
             "Returns the number of violations, and moves the curves if there are any.")
        .def(
            "points",
            [](const Repair &repair) {
                std::vector<Vec3> points = repair.points();
                const size_t count = points.size();
                return to_numpy<double>(std::move(points), {count, 3});
            },
            "Points (n, 3) [m] with the fewest violations so far.");
    module.def("warp_hairs", &warp, "lock_points"_a, "lock_offsets"_a, "result"_a, nb::kw_only(), "axis"_a, "root"_a, "first"_a,
               "offset"_a, "tip"_a, "join"_a, "flat"_a, "taper"_a, "frizz"_a, "profile"_a, "hold"_a, "pace"_a, "other"_a,
               "share"_a, "blend"_a, "window"_a, "curl"_a,
               "Writes the points of all hairs (hairs * points, 3) around the current locks; see groom/hairs.h.");
    module.def(
        "keep_beside", &keep_hairs, "lock_points"_a, "lock_offsets"_a, "hairs"_a, "points"_a, "triangles"_a, "margin"_a,
        nb::kw_only(), "first"_a, "tip"_a, "join"_a, "flat"_a, "hold"_a, "pace"_a, "shares"_a = nb::none(),
        "Keeps hairs, in place, on their lock's side of triangles; see groom/keep_beside.h. Returns how many hairs moved.");
}
