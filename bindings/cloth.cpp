// ringlet._core: cloth and its steps.
#include "cloth.h"
#include "arrays.h"

namespace nb = nanobind;
using namespace nb::literals;
using namespace ringlet;
using namespace ringlet::bindings;

namespace {

// Elastic energy, gradient and dense Hessian at positions, whatever the cloth is doing.
nb::tuple elastic(const Cloth &self, const Array3<double> &positions, bool hessian) {
    const size_t n = self.model->mass.size();
    if (positions.shape(0) != n) throw std::invalid_argument("cloth: positions do not fit the model");
    ClothObjective objective(*self.model);
    std::vector<Vec3> gradient(n);
    BlockMatrix blocks = objective.pattern();
    const double energy = objective.energy(vectors<Vec3>(positions));
    objective.assemble(vectors<Vec3>(positions), gradient, blocks);
    const size_t size = hessian ? 3 * n : 0;
    std::vector<double> dense(size * size, 0.0);
    const ScalarRows rows = hessian ? blocks.scalar_rows() : ScalarRows{};
    for (size_t r = 0; r < size; ++r)
        for (int k = rows.starts[r]; k < rows.starts[r + 1]; ++k) dense[r * size + rows.columns[k]] = rows.values[k];
    return nb::make_tuple(energy, to_numpy<double>(std::move(gradient), {n, 3}),
                          to_numpy<double>(std::move(dense), {size, size}));
}

} // namespace

void bind_cloth(nb::module_ &module) {
    nb::class_<ClothMaterial>(module, "ClothMaterial", "What cloth is made of (SI units).")
        .def(nb::init<>())
        .def_rw("density", &ClothMaterial::density)
        .def_rw("stretch_warp", &ClothMaterial::stretch_warp)
        .def_rw("stretch_weft", &ClothMaterial::stretch_weft)
        .def_rw("shear", &ClothMaterial::shear)
        .def_rw("bend", &ClothMaterial::bend)
        .def_rw("damping", &ClothMaterial::damping)
        .def_rw("mass_damping", &ClothMaterial::mass_damping)
        .def_rw("drag", &ClothMaterial::drag)
        .def_rw("thickness", &ClothMaterial::thickness);

    nb::class_<Cloth>(module, "Cloth", "Cloth at rest in its rest shape, ready to be stepped.")
        .def(
            "__init__",
            [](Cloth *self, Array3<int> triangles, Array3<double> rest, Array3<double> warp, Array1<unsigned char> held,
               Array1<double> attachment, const ClothMaterial &material) {
                new (self) Cloth(make_cloth_model(vectors<Triangle>(triangles), vectors<Vec3>(rest), vectors<Vec3>(warp),
                                                  view(held), view(attachment), material),
                                 vectors<Vec3>(rest));
            },
            "triangles"_a, "rest"_a, "warp"_a, "held"_a, "attachment"_a, "material"_a,
            "triangles: shape (m, 3) int32; rest: rest shape [m], shape (n, 3); warp: its direction per triangle, (m, 3); "
            "held: 1 "
            "where a vertex follows its target, (n,) uint8; attachment: springs to the targets [N/m], (n,) or empty.")
        .def_prop_ro(
            "positions", [](nb::object self) { return state_view(self, nb::cast<Cloth &>(self).state.positions); },
            "Positions [m], shape (n, 3): the solver's own memory, changed by step().")
        .def_prop_ro(
            "velocities", [](nb::object self) { return state_view(self, nb::cast<Cloth &>(self).state.velocities); },
            "Velocities [m/s], shape (n, 3): the solver's own memory.")
        .def_prop_ro(
            "masses",
            [](nb::object self) {
                const std::vector<double> &mass = nb::cast<Cloth &>(self).model->mass;
                return nb::ndarray<nb::numpy, const double>(mass.data(), {mass.size()}, self);
            },
            "Masses [kg], shape (n,).")
        .def(
            "scale_rest", [](Cloth &self, double scale) { scale_rest(*self.model, scale); }, "scale"_a,
            "From now on the rest shape is `scale` times what it was given as.")
        .def(
            "step",
            [](Cloth &self, Array3<double> targets, Array3<double> forces, const SceneStep &settings) {
                std::vector<ClothReport> report(1);
                {
                    nb::gil_scoped_release release;
                    report[0] = self.alone().step({vectors<Vec3>(targets), vectors<Vec3>(forces)}, settings);
                }
                return to_numpy<double>(std::move(report), {column_count<ClothReport>});
            },
            "targets"_a, "forces"_a, "settings"_a,
            "One time step; targets: where held and attached vertices are at its end [m], shape (n, 3); forces [N], shape (n, "
            "3). "
            "Returns a report row (CLOTH_REPORT).")
        .def("energy", &elastic, "positions"_a, "hessian"_a = false,
             "Elastic energy [J], its gradient [N] and the clamped Hessian; held vertices have no gradient.");

    module.attr("CLOTH_REPORT") = columns_of<ClothReport>();
}
