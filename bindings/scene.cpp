// ringlet._core: scenes of strands, cloths and bodies that touch.
#include "arrays.h"
#include "cloth.h"
#include "strand.h"

#include "ringlet/scene/scene.h"

#include <nanobind/stl/array.h>
#include <nanobind/stl/vector.h>

namespace nb = nanobind;
using namespace nb::literals;
using namespace ringlet;
using namespace ringlet::bindings;

namespace {

template <class Element, class Scalar, class Array> std::vector<Element> copied(const Array &array) {
    const View<Element> rows = vectors<Element>(array);
    return {rows.begin(), rows.end()};
}

constexpr size_t values_of_friction = 3; // slip
constexpr size_t values_of_overlap = 3;  // gap, force, activation distance

using Rows = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

nb::dict memory_of(const SceneMemory &memory) {
    std::vector<uint64_t> overlapping, lagged, sticking;
    std::vector<double> overlaps, forces, friction, heights;
    std::vector<int> penetrating, lagging;
    std::vector<Vec3> places;
    for (const InitialOverlap &of : memory.overlaps) {
        overlapping.push_back(of.name);
        overlaps.insert(overlaps.end(), {of.gap, of.force, of.activation});
    }
    for (const FrictionState &of : memory.friction) {
        sticking.push_back(of.name);
        friction.insert(friction.end(), of.slip.begin(), of.slip.end());
    }
    for (const auto &[name, force] : memory.lagged_forces) {
        lagged.push_back(name);
        forces.push_back(force);
    }
    for (const auto &[vertex, height] : memory.penetrations) {
        penetrating.push_back(vertex);
        heights.push_back(height);
    }
    for (const auto &[vertex, place] : memory.lagging) {
        lagging.push_back(vertex);
        places.push_back(place);
    }
    nb::dict arrays;
    const auto add = [&]<class Scalar>(const char *name, std::vector<Scalar> values, size_t columns) {
        const size_t rows = values.size() / columns;
        arrays[name] = columns == 1 ? nb::cast(to_numpy<Scalar>(std::move(values), {rows}))
                                    : nb::cast(to_numpy<Scalar>(std::move(values), {rows, columns}));
    };
    add("begun", std::vector<int>{memory.begun}, 1);
    arrays["bodies"] = to_numpy<double>(std::vector<Vec3>(memory.bodies), {memory.bodies.size(), 3});
    add("overlap_pairs", std::move(overlapping), 1);
    add("overlap_values", std::move(overlaps), values_of_overlap);
    add("lagged_pairs", std::move(lagged), 1);
    add("lagged_forces", std::move(forces), 1);
    add("loads", memory.loads, 1);
    add("friction_pairs", std::move(sticking), 1);
    add("friction_slips", std::move(friction), values_of_friction);
    add("penetrating_vertices", std::move(penetrating), 1);
    add("penetrating_heights", std::move(heights), 1);
    add("lagging_vertices", std::move(lagging), 1);
    arrays["lagging_places"] = to_numpy<double>(std::move(places), {memory.lagging.size(), 3});
    add("touched", memory.touched, 1);
    return arrays;
}

SceneMemory memory_from(const nb::dict &arrays) {
    const auto list = [&]<class Scalar>(const char *name, Scalar) {
        const View<Scalar> values = view(nb::cast<Array1<Scalar>>(arrays[name]));
        return std::vector<Scalar>(values.begin(), values.end());
    };
    const auto rows = [&](const char *name, size_t columns, size_t count) {
        const auto values = nb::cast<Rows>(arrays[name]);
        if (values.shape(0) != count || values.shape(1) != columns)
            throw std::invalid_argument("scene: what is to be recalled does not fit together");
        return values;
    };
    const std::vector<uint64_t> overlapping = list("overlap_pairs", uint64_t()), lagged = list("lagged_pairs", uint64_t()),
                                sticking = list("friction_pairs", uint64_t());
    const std::vector<double> forces = list("lagged_forces", 0.0), heights = list("penetrating_heights", 0.0);
    const std::vector<int> penetrating = list("penetrating_vertices", 0), begun = list("begun", 0);
    const Rows overlaps = rows("overlap_values", values_of_overlap, overlapping.size()),
               friction = rows("friction_slips", values_of_friction, sticking.size());
    if (lagged.size() != forces.size() || penetrating.size() != heights.size() || begun.size() != 1)
        throw std::invalid_argument("scene: what is to be recalled does not fit together");
    SceneMemory memory;
    memory.begun = begun[0] != 0;
    memory.bodies = copied<Vec3, double>(nb::cast<Array3<double>>(arrays["bodies"]));
    memory.loads = list("loads", 0.0);
    memory.touched = list("touched", 0);
    const std::vector<int> lagging = list("lagging_vertices", 0);
    const std::vector<Vec3> places = copied<Vec3, double>(nb::cast<Array3<double>>(arrays["lagging_places"]));
    if (lagging.size() != places.size()) throw std::invalid_argument("scene: what is to be recalled does not fit together");
    for (size_t k = 0; k < places.size(); ++k) memory.lagging.emplace_back(lagging[k], places[k]);
    for (size_t k = 0; k < overlapping.size(); ++k) {
        const double *values = overlaps.data() + values_of_overlap * k;
        memory.overlaps.push_back({overlapping[k], values[0], values[1], values[2]});
    }
    for (size_t k = 0; k < lagged.size(); ++k) memory.lagged_forces.push_back({lagged[k], forces[k]});
    for (size_t k = 0; k < sticking.size(); ++k) {
        const double *values = friction.data() + values_of_friction * k;
        memory.friction.push_back({sticking[k], Vec3(values)});
    }
    for (size_t k = 0; k < penetrating.size(); ++k) memory.penetrations.emplace_back(penetrating[k], heights[k]);
    return memory;
}

// All rows of several arrays.
std::vector<Vec3> joined(std::initializer_list<View<Vec3>> arrays) {
    std::vector<Vec3> all;
    for (const View<Vec3> rows : arrays) all.insert(all.end(), rows.begin(), rows.end());
    return all;
}

// Vertices (k, 4), and weights, normal, distance and force (k, 9).
nb::tuple arrays_of(View<Contact> contacts) {
    std::vector<int> vertices;
    std::vector<double> values;
    for (const Contact &c : contacts) {
        vertices.insert(vertices.end(), c.at.vertex.begin(), c.at.vertex.end());
        values.insert(values.end(), c.at.weight.begin(), c.at.weight.end());
        values.insert(values.end(), c.barrier.normal.data(), c.barrier.normal.data() + 3);
        values.insert(values.end(), {c.barrier.d_hat, c.force()});
    }
    const size_t count = contacts.size();
    return nb::make_tuple(to_numpy<int>(std::move(vertices), {count, 4}), to_numpy<double>(std::move(values), {count, 9}));
}

} // namespace

void bind_scene(nb::module_ &module) {
    nb::exception<FactorisationError>(module, "FactorisationError", PyExc_RuntimeError);
    nb::class_<SceneContact>(module, "SceneContact", "Contact in a scene (SI units).")
        .def(nb::init<>())
        .def_rw("strand_radius", &SceneContact::strand_radius)
        .def_rw("strand_radii", &SceneContact::strand_radii)
        .def(
            "set_ties",
            [](SceneContact &self, nb::ndarray<const int, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu> vertices,
               Array1<double> lengths, Array1<double> stiffness) {
                const size_t count = vertices.shape(0);
                if (lengths.shape(0) != count || stiffness.shape(0) != count)
                    throw std::invalid_argument("scene: as many lengths and stiffnesses as ties");
                self.ties.clear();
                for (size_t k = 0; k < count; ++k)
                    self.ties.emplace_back(vertices(k, 0), vertices(k, 1), view(lengths)[k], view(stiffness)[k]);
            },
            "vertices"_a, "lengths"_a, "stiffness"_a,
            "Ties vertices of strands: pairs (k, 2) int32, their distances at rest [m] and spring constants [N/m], shape (k,).")
        .def_rw("strand_material", &SceneContact::strand_material)
        .def_rw("friction", &SceneContact::friction)
        .def_rw("stiffness", &SceneContact::stiffness)
        .def_rw("creep_speed", &SceneContact::creep_speed)
        .def_rw("parting_speed", &SceneContact::parting_speed);

    nb::class_<BodyModel>(module, "BodyModel", "A surface whose motion is prescribed.")
        .def(
            "__init__",
            [](BodyModel *self, Array3<double> rest, Array3<int> triangles, double thickness, int material) {
                new (self) BodyModel{copied<Vec3, double>(rest), copied<Triangle, int>(triangles), thickness, material};
            },
            "rest"_a, "triangles"_a, "thickness"_a, "material"_a);

    nb::class_<SceneCloth>(module, "SceneCloth",
                           "A cloth in a scene, with its material there and the body that it is pinned to.")
        .def(
            "__init__",
            [](SceneCloth *self, Cloth &cloth, int material, int pinned_to) {
                new (self) SceneCloth{cloth.model.get(), &cloth.state, material, pinned_to};
            },
            "cloth"_a, "material"_a, "pinned_to"_a, nb::keep_alive<1, 2>());

    nb::class_<Scene>(module, "Scene", "Strands, cloths and bodies that touch. Strands and cloths must outlive it.")
        .def(
            "__init__",
            [](Scene *self, Strands &strands, const std::vector<SceneCloth> &cloths, const std::vector<BodyModel> &bodies,
               const std::vector<int> &rooted_in, const SceneContact &contact) {
                new (self) Scene(strands.model, strands.state(), cloths, bodies, rooted_in, contact);
            },
            "strands"_a, "cloths"_a, "bodies"_a, "rooted_in"_a, "contact"_a, nb::keep_alive<1, 2>())
        .def(
            "step",
            [](Scene &self, Array3<double> targets, Array3<double> forces, Array3<double> cloth_targets,
               Array3<double> cloth_forces, Array3<double> body_targets, const SceneStep &settings) {
                const std::vector<Vec3> all_targets =
                    joined({vectors<Vec3>(targets), vectors<Vec3>(cloth_targets), vectors<Vec3>(body_targets)});
                const std::vector<Vec3> all_forces = joined({vectors<Vec3>(forces), vectors<Vec3>(cloth_forces)});
                std::vector<StrandReport> of_strands;
                std::vector<ClothReport> of_cloths;
                SceneReport report{};
                {
                    nb::gil_scoped_release release;
                    report = self.step({all_targets, all_forces}, settings, of_strands, of_cloths);
                }
                const size_t strands = of_strands.size(), cloths = of_cloths.size();
                return nb::make_tuple(to_numpy<double>(std::vector<SceneReport>{report}, {column_count<SceneReport>}),
                                      to_numpy<double>(std::move(of_strands), {strands, column_count<StrandReport>}),
                                      to_numpy<double>(std::move(of_cloths), {cloths, column_count<ClothReport>}));
            },
            "targets"_a, "forces"_a, "cloth_targets"_a, "cloth_forces"_a, "body_targets"_a, "settings"_a,
            "One time step. Returns the scene's report (SCENE_REPORT), one report row per strand (REPORT) and one per cloth "
            "(CLOTH_REPORT).")
        .def_prop_ro(
            "positions",
            [](const Scene &self) {
                const View<Vec3> all = self.positions();
                return to_numpy<double>(std::vector<Vec3>(all.begin(), all.end()), {all.size(), 3});
            },
            nb::rv_policy::automatic, "Positions [m] of all vertices, strands, cloths, bodies, shape (n, 3).")
        .def(
            "allow_penetration",
            [](Scene &self, Array1<int> vertices, int body) {
                for (const int vertex : view(vertices)) self.allow_penetration(vertex, body);
            },
            "vertices"_a, "body"_a,
            "Exempts vertices of strands, shape (k,) int32, from contact with a body until they have come out of it.")
        .def_prop_ro("penetrating", &Scene::penetrating, "Number of vertices that are still exempt.")
        .def_prop_ro(
            "coincident",
            [](const Scene &self) {
                std::vector<int> vertices;
                for (const auto &[a, b] : self.coincident()) vertices.insert(vertices.end(), {a, b});
                return to_numpy<int>(std::move(vertices), {self.coincident().size(), 2});
            },
            nb::rv_policy::automatic, "A vertex of each of the two primitives of exempt coincident pairs, shape (k, 2).")
        .def("place", &Scene::place, "Takes the positions of strands and cloths that were placed since the last step.")
        .def_prop_ro(
            "memory", [](const Scene &self) { return memory_of(self.memory()); },
            "All that the next step depends on besides the memories of strands and cloths, as arrays by name.")
        .def(
            "recall", [](Scene &self, const nb::dict &memory) { self.recall(memory_from(memory)); }, "memory"_a,
            "Goes back to a memory of a scene that was made in the same way.")
        .def("record", &Scene::record, "on"_a, "Keeps the path of each step from now on.")
        .def_prop_ro(
            "path",
            [](const Scene &self) {
                std::vector<Vec3> all;
                for (const std::vector<Vec3> &stop : self.path()) all.insert(all.end(), stop.begin(), stop.end());
                const size_t stops = self.path().size(), vertices = self.positions().size();
                return to_numpy<double>(std::move(all), {stops, vertices, 3});
            },
            nb::rv_policy::automatic,
            "Positions [m] of all vertices at the start of the last step, moved rigidly to the frame of its end, "
            "and after each move, shape (k, n, 3).")
        .def_prop_ro(
            "contacts", [](const Scene &self) { return arrays_of(self.contacts()); }, nb::rv_policy::automatic,
            "Of the last step's end: vertices (k, 4), and weights, normal, distance and force (k, 9).")
        .def(
            "set_initial_forces",
            [](Scene &self, nb::ndarray<const int, nb::shape<-1, 4>, nb::c_contig, nb::device::cpu> vertices,
               Array3<double> forces) {
                if (vertices.shape(0) != forces.shape(0)) throw std::invalid_argument("scene: as many forces as pairs");
                std::vector<InitialForce> initial;
                for (size_t k = 0; k < vertices.shape(0); ++k) {
                    const int *of = vertices.data() + 4 * k;
                    initial.push_back({{of[0], of[1], of[2], of[3]}, vectors<Vec3>(forces)[k]});
                }
                self.set_initial_forces(std::move(initial));
            },
            "vertices"_a, "forces"_a,
            "Before the first step: the forces of pairs of four vertices on the first of the two [N], shape (k, 3): along the "
            "normal; tangential, towards the last vertex from the one before; along the cross product of both.")
        .def(
            "touching",
            [](Scene &self) {
                std::vector<Contact> found;
                {
                    nb::gil_scoped_release release;
                    found = self.touching();
                }
                return arrays_of(found);
            },
            "Contacts at the present positions, without a step; their forces have no meaning.");

    module.attr("SCENE_REPORT") = columns_of<SceneReport>();
}
