// How arrays cross the border: inputs are borrowed views, outputs hand their memory to numpy; nothing is copied.
#pragma once

#include "ringlet/geometry/triangle_mesh.h"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <stdexcept>
#include <utility>
#include <vector>

namespace ringlet::bindings {

namespace nb = nanobind;

template <class Scalar> using Array1 = nb::ndarray<const Scalar, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
template <class Scalar> using Array3 = nb::ndarray<const Scalar, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;

template <class Scalar> View<Scalar> view(const Array1<Scalar> &array) { return {array.data(), array.shape(0)}; }

// A (n, 3) array seen as n vectors.
template <class Vector, class Scalar> View<Vector> vectors(const Array3<Scalar> &array) {
    static_assert(sizeof(Vector) == 3 * sizeof(Scalar));
    return {reinterpret_cast<const Vector *>(array.data()), array.shape(0)};
}

// Vectors of the core as a writable (n, 3) array; `owner` keeps them alive.
inline nb::ndarray<nb::numpy, double> state_view(nb::handle owner, std::vector<Vec3> &values) {
    return {values.data()->data(), {values.size(), 3}, owner};
}

inline TriangleMesh mesh_of(const Array3<double> &points, const Array3<int> &triangles) {
    const TriangleMesh mesh{vectors<Vec3>(points), vectors<Triangle>(triangles)};
    for (const Triangle &t : mesh.triangles)
        if (t.minCoeff() < 0 || t.maxCoeff() >= static_cast<int>(mesh.points.size()))
            throw std::out_of_range("a triangle names a point that the mesh does not have");
    return mesh;
}

// Gives a vector's memory to numpy, with the given shape.
template <class Scalar, class Element>
nb::ndarray<nb::numpy, Scalar> to_numpy(std::vector<Element> &&values, std::initializer_list<size_t> shape) {
    auto *owned = new std::vector<Element>(std::move(values));
    nb::capsule owner(owned, [](void *p) noexcept { delete static_cast<std::vector<Element> *>(p); });
    return nb::ndarray<nb::numpy, Scalar>(reinterpret_cast<Scalar *>(owned->data()), shape, owner);
}

// The names of the columns of rows (math/row.h), and their number.
template <class Row> nb::object columns_of() { return nb::tuple(nb::str(Row::columns).attr("split")(", ")); }
template <class Row> constexpr size_t column_count = sizeof(Row) / sizeof(double);

} // namespace ringlet::bindings
