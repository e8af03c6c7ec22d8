// ringlet._core: scenes of strands, cloths and bodies that touch.
#include "arrays.h"
#include "cloth.h"
#include "strands.h"

#include "ringlet/scene/scene.h"

#include <map>
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

constexpr size_t values_of_hold = 6;      // shear, normal
constexpr size_t values_of_beginning = 3; // how near, what it bears, from where on it pushes

using Rows = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

nb::dict memory_of(const SceneMemory &memory) {
    std::vector<uint64_t> pairs, bearing;
    std::vector<double> beginnings, heights, forces;
    std::vector<int> embedded;
    for (const auto &[pair, of] : std::map<uint64_t, ContactSet::Beginning>(memory.early.begin(), memory.early.end())) {
        pairs.push_back(pair);
        beginnings.insert(beginnings.end(), {of.apart, of.bears, of.push});
    }
    std::vector<uint64_t> held_pairs;
    std::vector<double> held_values;
    for (const Hold &hold : memory.held) {
        held_pairs.push_back(hold.pair);
        held_values.insert(held_values.end(), hold.shear.begin(), hold.shear.end());
        held_values.insert(held_values.end(), hold.normal.begin(), hold.normal.end());
    }
    for (const auto &[pair, force] : memory.expected) {
        bearing.push_back(pair);
        forces.push_back(force);
    }
    for (const auto &[vertex, height] : memory.embedded) {
        embedded.push_back(vertex);
        heights.push_back(height);
    }
    const size_t early = pairs.size(), inside = embedded.size(), bodies = memory.bodies.size(), cloths = memory.touched.size(),
                 expected = bearing.size();
    nb::dict arrays;
    arrays["begun"] = to_numpy<int>(std::vector<int>{memory.begun}, {1});
    arrays["bodies"] = to_numpy<double>(std::vector<Vec3>(memory.bodies), {bodies, 3});
    arrays["early_pairs"] = to_numpy<uint64_t>(std::move(pairs), {early});
    arrays["expected_pairs"] = to_numpy<uint64_t>(std::move(bearing), {expected});
    arrays["expected_forces"] = to_numpy<double>(std::move(forces), {expected});
    arrays["borne"] = to_numpy<double>(std::vector<double>(memory.borne), {memory.borne.size()});
    arrays["early_values"] = to_numpy<double>(std::move(beginnings), {early, values_of_beginning});
    arrays["held_pairs"] = to_numpy<uint64_t>(std::move(held_pairs), {memory.held.size()});
    arrays["held_values"] = to_numpy<double>(std::move(held_values), {memory.held.size(), values_of_hold});
    arrays["embedded_vertices"] = to_numpy<int>(std::move(embedded), {inside});
    arrays["embedded_heights"] = to_numpy<double>(std::move(heights), {inside});
    arrays["touched"] = to_numpy<int>(std::vector<int>(memory.touched), {cloths});
    return arrays;
}

SceneMemory memory_from(const nb::dict &arrays) {
    const auto pairs = nb::cast<Array1<uint64_t>>(arrays["early_pairs"]);
    const auto bearing = nb::cast<Array1<uint64_t>>(arrays["expected_pairs"]);
    const auto forces = nb::cast<Array1<double>>(arrays["expected_forces"]);
    const View<double> borne = view(nb::cast<Array1<double>>(arrays["borne"]));
    const auto beginnings = nb::cast<Rows>(arrays["early_values"]);
    const auto held_pairs = nb::cast<Array1<uint64_t>>(arrays["held_pairs"]);
    const auto held = nb::cast<Rows>(arrays["held_values"]);
    const auto vertices = nb::cast<Array1<int>>(arrays["embedded_vertices"]);
    const auto heights = nb::cast<Array1<double>>(arrays["embedded_heights"]);
    const View<int> begun = view(nb::cast<Array1<int>>(arrays["begun"])),
                    touched = view(nb::cast<Array1<int>>(arrays["touched"]));
    if (pairs.shape(0) != beginnings.shape(0) || beginnings.shape(1) != values_of_beginning ||
        vertices.shape(0) != heights.shape(0) || bearing.shape(0) != forces.shape(0) || begun.size() != 1 ||
        held.shape(0) != held_pairs.shape(0) || held.shape(1) != values_of_hold)
        throw std::invalid_argument("scene: what is to be recalled does not fit together");
    SceneMemory memory;
    memory.begun = begun[0] != 0;
    memory.bodies = copied<Vec3, double>(nb::cast<Array3<double>>(arrays["bodies"]));
    for (size_t k = 0; k < bearing.shape(0); ++k) memory.expected.push_back({bearing.data()[k], forces.data()[k]});
    memory.borne.assign(borne.begin(), borne.end());
    for (size_t k = 0; k < pairs.shape(0); ++k) {
        const double *values = beginnings.data() + values_of_beginning * k;
        memory.early[pairs.data()[k]] = {values[0], values[1], values[2]};
    }
    for (size_t k = 0; k < held.shape(0); ++k) {
        const double *values = held.data() + values_of_hold * k;
        memory.held.push_back({held_pairs.data()[k], Vec3(values), Vec3(values + 3)});
    }
    for (size_t k = 0; k < vertices.shape(0); ++k) memory.embedded.emplace_back(vertices.data()[k], heights.data()[k]);
    memory.touched.assign(touched.begin(), touched.end());
    return memory;
}

// Vertices (k, 4), and weights, normal, distance and force (k, 9).
nb::tuple arrays_of(const std::vector<Contact> &contacts) {
    std::vector<int> vertices;
    std::vector<double> values;
    for (const Contact &c : contacts) {
        vertices.insert(vertices.end(), c.vertex.begin(), c.vertex.end());
        values.insert(values.end(), c.weight.begin(), c.weight.end());
        values.insert(values.end(), c.normal.data(), c.normal.data() + 3);
        values.insert(values.end(), {c.distance, c.force});
    }
    const size_t count = contacts.size();
    return nb::make_tuple(to_numpy<int>(std::move(vertices), {count, 4}), to_numpy<double>(std::move(values), {count, 9}));
}

} // namespace

void bind_contact(nb::module_ &module) {
    nb::exception<CoupledError>(module, "CoupledError", PyExc_ValueError);
    nb::enum_<System>(module, "System", "How the linear system of a step is solved.")
        .value("automatic", System::automatic)
        .value("banded", System::banded)
        .value("conjugate_gradient", System::conjugate_gradient)
        .value("direct", System::direct);

    nb::class_<SceneContact>(module, "SceneContact", "Contact in a scene (SI units).")
        .def(nb::init<>())
        .def_rw("strand_radius", &SceneContact::strand_radius)
        .def_rw("strand_material", &SceneContact::strand_material)
        .def_rw("friction", &SceneContact::friction)
        .def_rw("stiffness", &SceneContact::stiffness)
        .def_rw("creep_speed", &SceneContact::creep_speed)
        .def_rw("parting_speed", &SceneContact::parting_speed);

    nb::class_<BodyModel>(module, "BodyModel", "A surface that moves as it is told.")
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
               Array3<double> cloth_forces, Array3<double> body_targets, double dt, std::array<double, 3> gravity,
               std::array<double, 3> wind, int newton, double tolerance, Continuation continuation, Integrator integrator,
               const Safeguards &safeguards, System system, double linear_tolerance, int extra) {
                SceneStep step;
                step.strands.dt = dt;
                std::copy(gravity.begin(), gravity.end(), step.strands.gravity);
                std::copy(wind.begin(), wind.end(), step.strands.wind);
                step.strands.newton = newton;
                step.strands.tolerance = tolerance;
                step.strands.continuation = continuation;
                step.strands.integrator = integrator;
                step.strands.safeguards = safeguards;
                step.system = system;
                step.linear_tolerance = linear_tolerance;
                step.extra = extra;
                const SceneInput input{vectors<Vec3>(targets), vectors<Vec3>(forces), vectors<Vec3>(cloth_targets),
                                       vectors<Vec3>(cloth_forces), vectors<Vec3>(body_targets)};
                std::vector<StrandReport> of_strands;
                std::vector<ClothReport> of_cloths;
                SceneReport report;
                {
                    nb::gil_scoped_release release;
                    report = self.step(input, step, of_strands, of_cloths);
                }
                const size_t strands = of_strands.size(), cloths = of_cloths.size();
                return nb::make_tuple(to_numpy<double>(std::vector<SceneReport>{report}, {size_t(scene_report_columns)}),
                                      to_numpy<double>(std::move(of_strands), {strands, size_t(strand_report_columns)}),
                                      to_numpy<double>(std::move(of_cloths), {cloths, size_t(cloth_report_columns)}));
            },
            "targets"_a, "forces"_a, "cloth_targets"_a, "cloth_forces"_a, "body_targets"_a, "dt"_a, "gravity"_a, "wind"_a,
            "newton"_a, "tolerance"_a, "continuation"_a, "integrator"_a, "safeguards"_a, "system"_a, "linear_tolerance"_a,
            "extra"_a,
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
            "excuse",
            [](Scene &self, Array1<int> vertices, int body) {
                for (const int vertex : view(vertices)) self.excuse(vertex, body);
            },
            "vertices"_a, "body"_a,
            "Vertices of strands, shape (k,) int32, may be inside a body until they have been pushed out of it.")
        .def_prop_ro("excused", &Scene::excused, "How many vertices still are.")
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
            "Positions [m] of all vertices at the start and after each move of the last step, shape (k, n, 3).")
        .def_prop_ro(
            "contacts", [](const Scene &self) { return arrays_of(self.contacts()); }, nb::rv_policy::automatic,
            "Of the last step's end: vertices (k, 4), and weights, normal, distance and force (k, 9).")
        .def(
            "bear",
            [](Scene &self, nb::ndarray<const int, nb::shape<-1, 4>, nb::c_contig, nb::device::cpu> vertices,
               Array3<double> forces) {
                if (vertices.shape(0) != forces.shape(0)) throw std::invalid_argument("scene: as many forces as pairs");
                std::vector<ContactSet::Bearing> bearing;
                for (size_t k = 0; k < vertices.shape(0); ++k) {
                    const int *of = vertices.data() + 4 * k;
                    bearing.push_back({{of[0], of[1], of[2], of[3]}, vectors<Vec3>(forces)[k]});
                }
                self.bear(std::move(bearing));
            },
            "vertices"_a, "forces"_a,
            "Before the first step: what pairs of four vertices, as they touch, push the first of the two with [N], shape (k, "
            "3): away from the second; towards the last vertex from the one before, as far as that is across; across both.")
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
            "The same of where everything is now, without a step; forces are of no meaning.");

    module.attr("SCENE_REPORT") =
        nb::make_tuple("newton", "cuts", "residual", "unconverged", "linear_iterations", "linear_residual", "candidates",
                       "contacts", "closest", "violations", "zone_vertices", "substeps", "fraction", "time_pairs",
                       "time_assemble", "time_solve", "time_search", "time_filter");
}
