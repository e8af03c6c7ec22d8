// ringlet._core: direct solver for sparse systems.
#include "arrays.h"

#include "ringlet/linear/direct.h"

#include <nanobind/stl/string.h>
#include <stdexcept>
#include <string>

namespace nb = nanobind;
using namespace nb::literals;
using namespace ringlet;
using namespace ringlet::bindings;

namespace {

using Blocks = nb::ndarray<const double, nb::ndim<3>, nb::c_contig, nb::device::cpu>;

// A solver and the pattern that it analysed.
struct Direct {
    DirectSolver solver;
    std::shared_ptr<const SparsePattern> pattern;
};

} // namespace

void bind_linear(nb::module_ &module) {
    nb::enum_<DirectMethod>(module, "DirectMethod", "Factorisation of a direct solver.")
        .value("automatic", DirectMethod::automatic)
        .value("builtin", DirectMethod::builtin)
        .value("pardiso", DirectMethod::pardiso);

    module.def(
        "open_pardiso", [](const std::string &path) { return open_pardiso(path); }, "path"_a = "",
        "Opens MKL's libmkl_rt at this path, or by its name; returns whether PARDISO can be used.");

    nb::class_<Direct>(module, "DirectSolver", "Direct solver for sparse symmetric positive definite systems of one pattern.")
        .def(
            "__init__",
            [](Direct *self, Array1<int> i, Array1<int> j, int rows, int block, DirectMethod method) {
                DirectSolver solver(method);
                auto pattern = std::make_shared<const SparsePattern>(rows, block, view(i), view(j));
                {
                    nb::gil_scoped_release release;
                    solver.analyse(pattern);
                }
                new (self) Direct{std::move(solver), std::move(pattern)};
            },
            "i"_a, "j"_a, "rows"_a, "block"_a, "method"_a = DirectMethod::automatic,
            "i, j: block rows and columns of the triplets, (k,) int32; an off-diagonal one also stands for its transpose.")
        .def_prop_ro("method", [](const Direct &self) { return self.solver.method(); })
        .def_prop_ro(
            "entries", [](const Direct &self) { return self.solver.entries(); }, "Nonzeros of the factor.")
        .def(
            "factor",
            [](Direct &self, Blocks triplets) {
                const nb::gil_scoped_release release;
                return self.solver.factor({triplets.data(), triplets.size()});
            },
            "triplets"_a, "Blocks of the triplets, shape (k, block, block). Returns whether the matrix is positive definite.")
        .def(
            "solve",
            [](const Direct &self, Array1<double> b) {
                std::vector<double> x(b.shape(0));
                double residual = 0;
                {
                    const nb::gil_scoped_release release;
                    residual = self.solver.solve(view(b), x);
                }
                const size_t size = x.size();
                return nb::make_tuple(to_numpy<double>(std::move(x), {size}), residual);
            },
            "b"_a, "After factor(): x, and the relative residual of the solution.");
}
