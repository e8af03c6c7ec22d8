// ringlet._core: strands and their steps.
#include "strand.h"
#include "arrays.h"
#include "ringlet/scene/scene.h"

#include <cmath>
#include <cstring>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

namespace nb = nanobind;
using namespace nb::literals;
using namespace ringlet;
using namespace ringlet::bindings;

namespace {

template <auto column> nb::ndarray<nb::numpy, const double> column_view(nb::object self) {
    const std::vector<double> &values = nb::cast<Strands &>(self).model.*column;
    return {values.data(), {values.size()}, self};
}

// work(name, rows, columns) for everything that a state holds.
template <class State, class Work> void for_memory(State &state, const Work &work) {
    work("positions", state.positions, 3);
    work("velocities", state.velocities, 3);
    work("normals", state.normals, 3);
    work("twist", state.twist, 1);
    work("directors", state.directors, 3);
    work("last_positions", state.last_positions, 3);
    work("last_velocities", state.last_velocities, 3);
    work("last_strains", state.last_strains, 4);
    work("last_dt", state.last_dt, 1);
}

nb::dict memory_of(const StrandState &state) {
    nb::dict memory;
    for_memory(state, [&](const char *name, const auto &rows, size_t columns) {
        memory[name] = to_numpy<double>(std::remove_cvref_t<decltype(rows)>(rows), {rows.size(), columns});
    });
    return memory;
}

// All or nothing.
void recall(StrandState &state, const nb::dict &memory) {
    StrandState found = state;
    for_memory(found, [&](const char *name, auto &rows, size_t columns) {
        const auto values = nb::cast<nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>>(memory[name]);
        if (values.shape(0) != rows.size() || values.shape(1) != columns)
            throw std::invalid_argument(std::string("strands: ") + name + " to be recalled is of other strands");
        std::memcpy(static_cast<void *>(rows.data()), values.data(), values.size() * sizeof(double));
    });
    state = std::move(found);
}

} // namespace

void bind_strand(nb::module_ &module) {
    nb::enum_<System>(module, "System", "How the linear system of a step is solved.")
        .value("conjugate_gradient", System::conjugate_gradient)
        .value("direct", System::direct);

    nb::enum_<Continuation>(module, "Continuation", "How signs and turns of a curl are carried from step to step.")
        .value("history", Continuation::history)
        .value("least_energy", Continuation::least_energy)
        .value("material_frame", Continuation::material_frame);

    nb::enum_<Integrator>(module, "Integrator", "How velocities and rates follow from positions.")
        .value("backward_euler", Integrator::backward_euler)
        .value("bdf2", Integrator::bdf2);

    nb::class_<Safeguards>(module, "Safeguards", "Which safeguards of `history` are on; all to begin with.")
        .def(nb::init<>())
        .def_rw("flip_history", &Safeguards::flip_history)
        .def_rw("winding_number", &Safeguards::winding_number)
        .def_rw("straight_fade", &Safeguards::straight_fade);

    nb::class_<SceneStep> step(module, "StepSettings", "Length, forces and solver of a time step (SI units).");
    step.def(nb::init<>());
    // They stand in structures of their own; Python sees them side by side.
    const auto setting = [&]<class Group, class Value>(const char *name, Group SceneStep::*group, Value Group::*member) {
        step.def_prop_rw(
            name, [=](const SceneStep &self) { return self.*group.*member; },
            [=](SceneStep &self, Value value) { self.*group.*member = value; });
    };
    const auto vector = [&](const char *name, double (StrandStep::*member)[3]) {
        step.def_prop_rw(
            name, [=](const SceneStep &self) { return std::to_array(self.strands.*member); },
            [=](SceneStep &self, std::array<double, 3> value) { std::copy(value.begin(), value.end(), self.strands.*member); });
    };
    setting("dt", &SceneStep::strands, &StrandStep::dt);
    vector("gravity", &StrandStep::gravity);
    vector("wind", &StrandStep::wind);
    setting("newton", &SceneStep::strands, &StrandStep::newton);
    setting("tolerance", &SceneStep::strands, &StrandStep::tolerance);
    setting("continuation", &SceneStep::strands, &StrandStep::continuation);
    setting("integrator", &SceneStep::strands, &StrandStep::integrator);
    setting("safeguards", &SceneStep::strands, &StrandStep::safeguards);
    setting("system", &SceneStep::linear, &LinearSettings::system);
    setting("linear_tolerance", &SceneStep::linear, &LinearSettings::tolerance);
    setting("linear_iterations", &SceneStep::linear, &LinearSettings::max_iterations);
    step.def_rw("extra", &SceneStep::extra);

    nb::class_<StrandMaterial> material(module, "StrandMaterial", "What a lock is made of (SI units); a hair's values.");
    material.def(nb::init<>());
    for (const auto &[name, member] : strand_material_settings)
        std::visit([&, name = name](auto setting) { material.def_rw(name, setting); }, member);

    nb::class_<Strands>(module, "Strands", "Strands at rest in their rest shape, ready to be stepped.")
        .def(
            "__init__",
            [](Strands *self, Array1<int> offsets, Array3<double> rest, Array1<unsigned char> held,
               const StrandMaterial &material, Array1<double> radius, Array1<double> stretch, Array1<double> bend,
               Array1<double> twist, Array1<double> damping, Array1<double> drag) {
                const StrandVariation variation{view(radius), view(stretch), view(bend),
                                                view(twist),  view(damping), view(drag)};
                StrandModel model = make_strand_model(view(offsets), vectors<Vec3>(rest), view(held), material, variation);
                new (self) Strands(std::move(model), vectors<Vec3>(rest));
            },
            "offsets"_a, "rest"_a, "held"_a, "material"_a, "radius"_a, "stretch"_a, "bend"_a, "twist"_a, "damping"_a, "drag"_a,
            "offsets: shape (count + 1,) int32; rest: rest shape [m], shape (n, 3); held: 1 where a vertex follows its target, "
            "(n,) uint8; "
            "then factors on the material, each of shape (n,) or empty.")
        .def_prop_ro(
            "positions", [](nb::object self) { return state_view(self, nb::cast<Strands &>(self).state().positions); },
            "Positions [m], shape (n, 3): the solver's own memory, changed by step().")
        .def_prop_ro(
            "velocities", [](nb::object self) { return state_view(self, nb::cast<Strands &>(self).state().velocities); },
            "Velocities [m/s], shape (n, 3): the solver's own memory.")
        .def_prop_ro(
            "directors", [](nb::object self) { return state_view(self, nb::cast<Strands &>(self).state().directors); },
            "Directors of the material frame, one per edge from the second of each strand on, shape (n, 3): the solver's own "
            "memory.")
        .def_prop_ro("masses", column_view<&StrandModel::mass>, "Masses [kg], shape (n,).")
        .def_prop_ro("drag", column_view<&StrandModel::drag>, "Air drag [kg/s], shape (n,).")
        .def_prop_ro("stretch_stiffness", column_view<&StrandModel::stretch_stiffness>,
                     "EA / l̄ of the edge that begins at each vertex [N/m], shape (n,).")
        .def_prop_ro("bend_stiffness", column_view<&StrandModel::bend_stiffness>, "EI / l̄ at each vertex [N m], shape (n,).")
        .def_prop_ro("twist_stiffness", column_view<&StrandModel::twist_stiffness>,
                     "c EI / l̄ of the edge that begins at each vertex [N m], shape (n,).")
        .def(
            "place",
            [](Strands &self, Array3<double> positions, const std::optional<Array3<double>> &directors) {
                self.place(vectors<Vec3>(positions), directors ? vectors<Vec3>(*directors) : View<Vec3>{});
            },
            "positions"_a, "directors"_a = nb::none(),
            "Puts the strands at rest at these positions [m], shape (n, 3), and forgets their history. The directors of\n"
            "their material frames there are found where none are given.")
        .def(
            "step",
            [](Strands &self, Array3<double> targets, Array3<double> forces, const SceneStep &settings,
               const std::optional<std::tuple<Array3<double>, Array1<double>, Array1<double>>> &planes,
               const std::optional<std::tuple<Array3<double>, Array1<double>>> &springs) {
                StrandPlanes at;
                StrandSprings pull;
                if (planes) at = {vectors<Vec3>(std::get<0>(*planes)), view(std::get<1>(*planes)), view(std::get<2>(*planes))};
                if (springs) pull = {vectors<Vec3>(std::get<0>(*springs)), view(std::get<1>(*springs))};
                {
                    nb::gil_scoped_release release;
                    step_strands(self.model, self.state(), vectors<Vec3>(targets), vectors<Vec3>(forces), settings.strands,
                                 self.reports, at, pull);
                }
                const size_t rows = self.reports.size();
                return to_numpy<double>(std::vector<StrandReport>(self.reports), {rows, column_count<StrandReport>});
            },
            "targets"_a, "forces"_a, "settings"_a, "planes"_a = nb::none(), "springs"_a = nb::none(),
            "One time step; targets: where held vertices are at its end [m], shape (n, 3); planes: normals (n, 3), offsets "
            "[m]\n"
            "and stiffnesses [N/m], (n,), of one in front of each vertex; springs: targets (n, 3) [m] and stiffnesses (n,)\n"
            "[N/m]. Returns one report row per strand (REPORT).")
        .def_prop_ro(
            "memory", [](Strands &self) { return memory_of(self.state()); },
            "All that the next step depends on besides the model, as arrays by name.")
        .def(
            "recall", [](Strands &self, const nb::dict &memory) { recall(self.any_state(), memory); }, "memory"_a,
            "Goes back to a memory of the same strands.")
        .def(
            "stabilising_stiffness",
            [](Strands &self, Array1<double> left, double most) {
                std::vector<double> factors;
                {
                    nb::gil_scoped_release release;
                    factors = stabilising_stiffness(self.model, self.state(), view(left), most);
                }
                const size_t count = factors.size();
                return to_numpy<double>(std::move(factors), {count});
            },
            "left"_a, "most"_a,
            "Least factor on the stiffness of bend and twist with which each strand is stable where it is, and keeps the "
            "fraction "
            "`left`, shape (count,), of its stiffness without load; infinite where `most` is not enough.")
        .def(
            "energy",
            [](Strands &self, Array3<double> positions, Continuation continuation, bool hessian) {
                std::vector<Vec3> gradient;
                std::vector<double> dense;
                const double energy = strand_energy(self.model, self.state(), continuation, vectors<Vec3>(positions), gradient,
                                                    hessian ? &dense : nullptr);
                const size_t n = positions.shape(0), size = hessian ? size_t(std::lround(std::sqrt(double(dense.size())))) : 0;
                return nb::make_tuple(energy, to_numpy<double>(std::move(gradient), {n, 3}),
                                      to_numpy<double>(std::move(dense), {size, size}));
            },
            "positions"_a, "continuation"_a, "hessian"_a = false,
            "Elastic energy [J], its gradient [N] and the clamped Hessian of a single strand, with signs and turns carried "
            "from the state.");

    module.attr("REPORT") = columns_of<StrandReport>();
}
