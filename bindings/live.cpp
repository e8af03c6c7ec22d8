// ringlet._core: hair that moves live.
#include "arrays.h"

#include "ringlet/live/body_planes.h"
#include "ringlet/live/carried_locks.h"
#include "ringlet/live/shared_velocities.h"

using namespace nanobind::literals;
using namespace ringlet;
using namespace ringlet::bindings;

namespace {

using Matrix4 = nb::ndarray<const double, nb::shape<4, 4>, nb::c_contig, nb::device::cpu>;

Pose pose_of(const Matrix4 &matrix) {
    const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> m(matrix.data());
    return {m.topLeftCorner<3, 3>(), m.topRightCorner<3, 1>()};
}

Vec3 vector_of(const Array1<double> &array) {
    if (array.shape(0) != 3) throw std::invalid_argument("a place has three coordinates");
    return {array(0), array(1), array(2)};
}

nb::ndarray<nb::numpy, const double> numbers_view(nb::handle owner, const std::vector<double> &values) {
    return {values.data(), {values.size()}, owner};
}

// Velocities that the solver itself holds: writable.
using Velocities = nb::ndarray<double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;

} // namespace

void bind_live(nb::module_ &module) {
    nb::class_<VelocityGrid>(module, "VelocityGrid", "A grid in the frame of the head, through which neighbours share motion.")
        .def(
            "__init__",
            [](VelocityGrid *grid, const Array1<double> &low, const Array1<double> &high, double cell) {
                new (grid) VelocityGrid(vector_of(low), vector_of(high), cell);
            },
            "low"_a, "high"_a, "cell"_a)
        .def(
            "share",
            [](VelocityGrid &grid, const Array3<double> &positions, const Array1<double> &masses,
               const Array1<unsigned char> &held, const Matrix4 &from, const Matrix4 &to, double dt, double share, double keep,
               const Velocities &velocities) {
                const nb::gil_scoped_release release;
                grid.share(vectors<Vec3>(positions), view(masses), view(held), pose_of(from), pose_of(to), dt, {share, keep},
                           {reinterpret_cast<Vec3 *>(velocities.data()), velocities.shape(0)});
            },
            "positions"_a, "masses"_a, "held"_a, "start"_a, "end"_a, "dt"_a, "share"_a, "keep"_a, "velocities"_a,
            "Velocities (n, 3) [m/s], changed in place, go towards those of neighbours, relative to a head that went from the\n"
            "pose start to end, (4, 4) each, in dt [s].");

    nb::class_<DistanceGrid>(module, "DistanceGrid", "Signed distance to a triangle mesh [m] on a grid, negative inside.")
        .def(
            "__init__",
            [](DistanceGrid *grid, const Solid &solid, const Array1<double> &low, const Array1<double> &high, double cell,
               double band) {
                const Vec3 from = vector_of(low), to = vector_of(high);
                const nb::gil_scoped_release release;
                new (grid) DistanceGrid(solid, from, to, cell, band);
            },
            "solid"_a, "low"_a, "high"_a, "cell"_a, "band"_a)
        .def(
            "at",
            [](const DistanceGrid &grid, const Array3<double> &places) {
                const View<Vec3> at = vectors<Vec3>(places);
                std::vector<double> distance(at.size());
                std::vector<Vec3> gradient(at.size());
                for (size_t i = 0; i < at.size(); ++i) {
                    const DistanceGrid::Sample sample = grid.at(at[i]);
                    distance[i] = sample.distance;
                    gradient[i] = sample.gradient;
                }
                const size_t count = at.size();
                return nb::make_tuple(to_numpy<double>(std::move(distance), {count}),
                                      to_numpy<double>(std::move(gradient), {count, 3}));
            },
            "places"_a, "Distance (k,) [m] at places (k, 3), infinite outside the grid; and its gradient (k, 3), of length 1.");

    nb::class_<BodyPlanes>(module, "BodyPlanes", "Planes that keep vertices outside bodies at the end of a step.")
        .def(nb::init<size_t>(), "vertices"_a)
        .def(
            "add",
            [](BodyPlanes &planes, const DistanceGrid &body, const Matrix4 &from, const Matrix4 &to,
               const Array3<double> &positions, const Array1<double> &clearance) {
                planes.add(body, pose_of(from), pose_of(to), vectors<Vec3>(positions), view(clearance));
            },
            "body"_a, "start"_a, "end"_a, "positions"_a, "clearance"_a,
            "Takes a body that goes from one pose (4, 4) to another, with vertices (n, 3) [m] where they start the step, and\n"
            "how far each stays away from it, (n,) [m].")
        .def(
            "add_ball",
            [](BodyPlanes &planes, const Array1<double> &from, const Array1<double> &to, double radius, double most,
               const Array3<double> &positions, const Array1<double> &clearance) {
                planes.add_ball(vector_of(from), vector_of(to), radius, most, vectors<Vec3>(positions), view(clearance));
            },
            "start"_a, "end"_a, "radius"_a, "most"_a, "positions"_a, "clearance"_a,
            "Takes a ball whose centre (3,) goes from one place to another; what is inside comes out by `most` [m] at most.")
        .def_prop_ro(
            "normals", [](nb::object self) { return state_view(self, nb::cast<BodyPlanes &>(self).normal); },
            "Normals of the planes, shape (n, 3).")
        .def_prop_ro(
            "offsets", [](nb::object self) { return numbers_view(self, nb::cast<BodyPlanes &>(self).offset); },
            "Distances of the planes from the origin along their normals [m], shape (n,).")
        .def_prop_ro(
            "gaps", [](nb::object self) { return numbers_view(self, nb::cast<BodyPlanes &>(self).gap); },
            "Gap of each vertex from its plane at the start [m], shape (n,); infinite where there is no plane.");

    nb::class_<CarriedLocks>(module, "CarriedLocks", "Locks of many points that rods of few vertices carry.")
        .def(
            "__init__",
            [](CarriedLocks *locks, const Array3<double> &points, const Array1<int> &vertex, const Array1<double> &weight,
               const Array3<double> &rods, const Array1<int> &offsets, const Array3<double> &axes,
               const Array1<double> &rises) {
                new (locks) CarriedLocks(vectors<Vec3>(points), view(vertex), view(weight),
                                         {vectors<Vec3>(rods), view(offsets)}, vectors<Vec3>(axes), view(rises));
            },
            "points"_a, "vertex"_a, "weight"_a, "rods"_a, "offsets"_a, "axes"_a, "rises"_a,
            "points (n, 3) and rods (r, 3) as groomed [m]; of each point the vertex of a rod before it and the weight of the\n"
            "one behind, (n,); a direction across the root of each rod, (count, 3), and its length by that of its lock, "
            "(count,).")
        .def(
            "at",
            [](const CarriedLocks &locks, const Array3<double> &rods, const Matrix4 &head) {
                std::vector<Vec3> points(locks.size());
                {
                    const nb::gil_scoped_release release;
                    const std::vector<VertexMotion> motions = locks.motions(vectors<Vec3>(rods), pose_of(head).rotation);
                    locks.carry(View<VertexMotion>(motions), std::span(points));
                }
                return to_numpy<double>(std::move(points), {locks.size(), 3});
            },
            "rods"_a, "head"_a, "Points (n, 3) [m] where the rods (r, 3) are now, with the head in the pose (4, 4).")
        .def(
            "motions",
            [](const CarriedLocks &locks, const Array3<double> &rods, const Matrix4 &head) {
                const std::vector<VertexMotion> motions = locks.motions(vectors<Vec3>(rods), pose_of(head).rotation);
                std::vector<double> rows;
                rows.reserve(12 * motions.size());
                for (const VertexMotion &motion : motions)
                    for (int k = 0; k < 3; ++k) {
                        for (int c = 0; c < 3; ++c) rows.push_back(motion.linear(k, c));
                        rows.push_back(motion.shift[k]);
                    }
                return to_numpy<double>(std::move(rows), {motions.size(), 3, 4});
            },
            "rods"_a, "head"_a, "Motions [A t] of the vertices of rods since they were groomed, shape (r, 3, 4).");
}
