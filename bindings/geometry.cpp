#include "arrays.h"

#include "ringlet/geometry/orientation.h"
#include "ringlet/geometry/resample.h"
#include "ringlet/geometry/solid.h"
#include "ringlet/geometry/triangle_tree.h"

#include <nanobind/stl/optional.h>
#include <optional>
#include <stdexcept>

namespace nb = nanobind;
using namespace nb::literals;
using namespace ringlet;
using namespace ringlet::bindings;

namespace {

void check_triangles(View<int> triangles, const TriangleMesh &mesh) {
    for (const int t : triangles)
        if (t < 0 || t >= static_cast<int>(mesh.triangles.size())) throw std::out_of_range("there is no such triangle");
}

// (triangle (k,), barycentric (k, 3), distance (k,)) of the point of the mesh closest to each root.
nb::tuple bind_roots(const Array3<double> &points, const Array3<int> &triangles, const Array3<double> &roots,
                     const std::optional<Array1<int>> &allowed) {
    const TriangleMesh mesh = mesh_of(points, triangles);
    if (allowed) check_triangles(view(*allowed), mesh);
    if ((allowed ? allowed->shape(0) : triangles.shape(0)) == 0)
        throw std::invalid_argument("there are no triangles to bind to");
    const View<Vec3> places = vectors<Vec3>(roots);
    const size_t count = places.size();
    std::vector<int> triangle(count);
    std::vector<Vec3> barycentric(count);
    std::vector<double> distance(count);
    {
        nb::gil_scoped_release release;
        const TriangleTree tree =
            allowed ? TriangleTree(mesh, {view(*allowed).begin(), view(*allowed).end()}) : TriangleTree(mesh);
#pragma omp parallel for schedule(dynamic, 64)
        for (size_t i = 0; i < count; ++i) {
            const SurfacePoint found = tree.closest(places[i]);
            triangle[i] = found.triangle;
            barycentric[i] = found.barycentric;
            distance[i] = found.distance;
        }
    }
    return nb::make_tuple(to_numpy<int>(std::move(triangle), {count}), to_numpy<double>(std::move(barycentric), {count, 3}),
                          to_numpy<double>(std::move(distance), {count}));
}

// (distance (k,), closest point (k, 3), normal (k, 3), triangle (k,)) of the surface for each place.
nb::tuple signed_distances(const Solid &solid, const Array3<double> &places) {
    const View<Vec3> at = vectors<Vec3>(places);
    const size_t count = at.size();
    std::vector<double> distance(count);
    std::vector<Vec3> closest(count), normal(count);
    std::vector<int> triangle(count);
    {
        nb::gil_scoped_release release;
#pragma omp parallel for schedule(dynamic, 64)
        for (size_t i = 0; i < count; ++i) {
            const SignedDistance found = solid.signed_distance(at[i]);
            distance[i] = found.distance;
            closest[i] = found.closest;
            normal[i] = found.normal;
            triangle[i] = found.triangle;
        }
    }
    return nb::make_tuple(to_numpy<double>(std::move(distance), {count}), to_numpy<double>(std::move(closest), {count, 3}),
                          to_numpy<double>(std::move(normal), {count, 3}), to_numpy<int>(std::move(triangle), {count}));
}

using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using Matrices3 = nb::ndarray<const double, nb::shape<-1, 3, 3>, nb::c_contig, nb::device::cpu>;

// (positions (k, 3), frames (k, 3, 3)) of roots on the current mesh.
nb::tuple root_frames(const Array3<double> &points, const Array3<int> &triangles, const Array1<int> &root_triangle,
                      const Array3<double> &root_barycentric) {
    const TriangleMesh mesh = mesh_of(points, triangles);
    const View<int> triangle = view(root_triangle);
    const View<Vec3> barycentric = vectors<Vec3>(root_barycentric);
    check_triangles(triangle, mesh);
    const size_t count = triangle.size();
    if (barycentric.size() != count) throw std::invalid_argument("root_triangle and root_barycentric differ in length");
    std::vector<Vec3> positions(count);
    std::vector<RowMajor3> frames(count);
    {
        nb::gil_scoped_release release;
        std::vector<unsigned char> wanted(mesh.points.size(), 0);
        for (const int t : triangle)
            for (const int vertex : mesh.triangles[t]) wanted[vertex] = 1;
        const std::vector<Vec3> normals = vertex_normals(mesh, wanted);
#pragma omp parallel for schedule(static)
        for (size_t i = 0; i < count; ++i) {
            positions[i] = mesh.at(triangle[i], barycentric[i]);
            frames[i] = surface_frame(mesh, normals, triangle[i], barycentric[i]);
        }
    }
    return nb::make_tuple(to_numpy<double>(std::move(positions), {count, 3}),
                          to_numpy<double>(std::move(frames), {count, 3, 3}));
}

// Mask (m,) of degenerate triangles.
nb::ndarray<nb::numpy, bool> flat_triangles(const Array3<double> &points, const Array3<int> &triangles) {
    const TriangleMesh mesh = mesh_of(points, triangles);
    std::vector<unsigned char> flat(mesh.triangles.size());
    {
        nb::gil_scoped_release release;
#pragma omp parallel for schedule(static)
        for (size_t i = 0; i < flat.size(); ++i) flat[i] = is_flat(mesh, int(i));
    }
    return to_numpy<bool>(std::move(flat), {mesh.triangles.size()});
}

CurveView curves_of(const Array3<double> &points, const Array1<int> &offsets) {
    const CurveView curves{vectors<Vec3>(points), view(offsets)};
    if (curves.offsets.empty() || curves.offsets.front() != 0 ||
        curves.offsets.back() != static_cast<int>(curves.points.size()))
        throw std::invalid_argument("offsets do not fit the points");
    for (int i = 0; i < curves.count(); ++i)
        if (curves.offsets[i + 1] - curves.offsets[i] < 2) throw std::invalid_argument("a curve has fewer than 2 points");
    return curves;
}

nb::ndarray<nb::numpy, double> carry_curves(const Array3<double> &points, const Array1<int> &offsets, const Matrices3 &turns,
                                            const Array3<double> &from_places, const Array3<double> &to_places) {
    const CurveView curves = curves_of(points, offsets);
    const View<Vec3> from = vectors<Vec3>(from_places), to = vectors<Vec3>(to_places);
    const size_t count = curves.count();
    if (turns.shape(0) != count || from.size() != count || to.size() != count)
        throw std::invalid_argument("turns and places need one row a curve");
    std::vector<Vec3> carried(curves.points.size());
    {
        nb::gil_scoped_release release;
#pragma omp parallel for schedule(static)
        for (size_t i = 0; i < count; ++i) {
            const Mat3 turn = Eigen::Map<const RowMajor3>(turns.data() + 9 * i);
            for (int k = curves.offsets[i]; k < curves.offsets[i + 1]; ++k)
                carried[k] = to[i] + turn * (curves.points[k] - from[i]);
        }
    }
    return to_numpy<double>(std::move(carried), {carried.size(), 3});
}

// Frames (n, 3, 3) along curves; columns: axis, tangent × axis, tangent.
nb::ndarray<nb::numpy, double> curve_frames(const Array3<double> &points, const Array1<int> &offsets,
                                            const Array3<double> &axis) {
    const CurveView curves = curves_of(points, offsets);
    const View<Vec3> first = vectors<Vec3>(axis);
    if (static_cast<int>(first.size()) != curves.count()) throw std::invalid_argument("axis needs one row a curve");
    const size_t n = curves.points.size();
    std::vector<RowMajor3> frames(n);
    {
        nb::gil_scoped_release release;
        std::vector<Vec3> tangent(n), moved(n);
#pragma omp parallel for schedule(static)
        for (int i = 0; i < curves.count(); ++i) {
            const size_t begin = curves.offsets[i], count = curves[i].size();
            const std::span<Vec3> t = std::span(tangent).subspan(begin, count), a = std::span(moved).subspan(begin, count);
            tangents(curves[i], t);
            transport(curves[i], t, first[i], a);
            for (size_t k = 0; k < count; ++k) frames[begin + k] << a[k], t[k].cross(a[k]), t[k];
        }
    }
    return to_numpy<double>(std::move(frames), {n, 3, 3});
}

nb::ndarray<nb::numpy, double> resample_curves(const Array3<double> &points, const Array1<int> &offsets, int count) {
    const CurveView curves = curves_of(points, offsets);
    if (count < 2) throw std::invalid_argument("count must be at least 2");
    const size_t n = static_cast<size_t>(curves.count()) * count;
    std::vector<Vec3> result(n);
    {
        nb::gil_scoped_release release;
#pragma omp parallel for schedule(static)
        for (int i = 0; i < curves.count(); ++i)
            resample(curves[i], std::span(result).subspan(static_cast<size_t>(i) * count, count));
    }
    return to_numpy<double>(std::move(result), {n, 3});
}

nb::ndarray<nb::numpy, double> points_on_splines(const Array3<double> &points, const Array1<int> &offsets,
                                                 const Array1<double> &along) {
    const CurveView curves = curves_of(points, offsets);
    const View<double> lengths{along.data(), along.size()};
    const size_t curve_count = curves.count(), each = curve_count ? lengths.size() / curve_count : 0;
    if (each * curve_count != lengths.size()) throw std::invalid_argument("along needs as many lengths for every curve");
    std::vector<Vec3> result(lengths.size());
    {
        nb::gil_scoped_release release;
#pragma omp parallel for schedule(static)
        for (size_t i = 0; i < curve_count; ++i)
            on_spline(curves[static_cast<int>(i)], lengths.subspan(i * each, each), std::span(result).subspan(i * each, each));
    }
    return to_numpy<double>(std::move(result), {lengths.size(), 3});
}

} // namespace

void bind_geometry(nb::module_ &module) {
    nb::class_<Solid>(module, "Solid",
                      "Signed distance to a triangle mesh, with a BVH of its triangles; keeps a copy of the mesh.")
        .def(
            "__init__",
            [](Solid *solid, const Array3<double> &points, const Array3<int> &triangles) {
                if (triangles.shape(0) == 0) throw std::invalid_argument("a solid needs triangles");
                new (solid) Solid(mesh_of(points, triangles));
            },
            "points"_a, "triangles"_a)
        .def("above", &signed_distances, "places"_a,
             "Signed distance (k,) [m], negative inside; closest point (k, 3), outward normal (k, 3) and triangle (k,) there.");
    module.def("bind_roots", &bind_roots, "points"_a, "triangles"_a, "roots"_a, "allowed_triangles"_a = nb::none(),
               "Closest point of a triangle mesh to each root: triangle (k,), barycentric (k, 3), distance (k,) [m].\n"
               "points (n, 3) [m], triangles (m, 3), roots (k, 3) [m], allowed_triangles: indices to search, or None for all.");
    module.def(
        "root_frames", &root_frames, "points"_a, "triangles"_a, "root_triangle"_a, "root_barycentric"_a,
        "Roots on the current mesh: positions (k, 3) [m] and frames (k, 3, 3), whose columns are tangent, bitangent and\n"
        "normal. The frame moves with the material: now @ rest.T rotates what grows there from rest to now.");
    module.def(
        "parts_facing_inside",
        [](const Array3<double> &points, const Array3<int> &triangles) {
            const TriangleMesh mesh = mesh_of(points, triangles);
            return to_numpy<int>(parts_facing_inside(mesh), {mesh.triangles.size()});
        },
        "points"_a, "triangles"_a,
        "For each triangle of points (n, 3) and triangles (m, 3) that faces the inside of what its surface encloses the "
        "number\n"
        "of its connected part, and -1 for the others, shape (m,).");
    module.def("flat_triangles", &flat_triangles, "points"_a, "triangles"_a,
               "Mask (m,) of triangles that are thinner than a billionth of their length, or not finite.");
    module.def("carry_curves", &carry_curves, "points"_a, "offsets"_a, "turns"_a, "from_places"_a, "to_places"_a,
               "Curves (n, 3) [m] after a rigid motion of each: to + turn (x - from), with one turn and two places a curve.");
    module.def("curve_frames", &curve_frames, "points"_a, "offsets"_a, "axis"_a,
               "Rotation-minimising frames (n, 3, 3) along curves (Wang et al. 2008), with columns axis, tangent x axis and\n"
               "tangent. The first axis of each curve is axis (count, 3) made orthogonal to its first tangent.");
    module.def("points_on_splines", &points_on_splines, "points"_a, "offsets"_a, "along"_a,
               "Points of the cubic spline through each curve at lengths along its polyline [m], as many for every curve:\n"
               "along (curves * k,), result (curves * k, 3) [m]. Beyond the ends they are on the tangents there.");
    module.def("resample_curves", &resample_curves, "points"_a, "offsets"_a, "count"_a,
               "Points evenly spaced along the cubic spline through each curve, shape (curves * count, 3) [m].");
}
