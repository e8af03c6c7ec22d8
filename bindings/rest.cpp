// ringlet._core: what strands must hold inside, and the shapes of their joints.
#include "arrays.h"

#include "ringlet/rest/balance.h"

#include <stdexcept>

using namespace nanobind::literals;
using namespace ringlet;
using namespace ringlet::bindings;

namespace {

using Pairs = nb::ndarray<const double, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;

// work(first vertex, count of vertices) for each strand, in parallel.
template <class Work> void for_each_strand(View<int> offsets, const Work &work) {
    const nb::gil_scoped_release release;
#pragma omp parallel for schedule(static)
    for (int s = 0; s < int(offsets.size()) - 1; ++s) work(offsets[s], offsets[s + 1] - offsets[s]);
}

void check(View<int> offsets, std::initializer_list<size_t> sizes) {
    for (const size_t size : sizes)
        if (offsets.empty() || int(size) != offsets.back())
            throw std::invalid_argument("strands: offsets and arrays do not fit");
    for (size_t s = 1; s < offsets.size(); ++s)
        if (offsets[s] - offsets[s - 1] < 3) throw std::invalid_argument("strands: one has fewer than 3 vertices");
}

} // namespace

void bind_rest(nb::module_ &module) {
    module.def(
        "balance",
        [](Array1<int> offsets, int held, Array3<double> points, Array3<double> directors, Array3<double> loads,
           Array1<double> twisting) {
            const size_t n = points.shape(0);
            check(view(offsets), {n, directors.shape(0), loads.shape(0), twisting.shape(0)});
            if (held < 3) throw std::invalid_argument("balance: held must be at least 3");
            std::vector<double> length(n), bend(2 * n), twist(n);
            for_each_strand(view(offsets), [&](int first, int count) {
                RINGLET_DISPATCH(balance, count, held, points.data() + 3 * first, directors.data() + 3 * first,
                                 loads.data() + 3 * first, twisting.data() + first,
                                 JointRows<double>{&length[first], &bend[2 * first], &twist[first]});
            });
            return nb::make_tuple(to_numpy<double>(std::move(length), {n}), to_numpy<double>(std::move(bend), {n, 2}),
                                  to_numpy<double>(std::move(twist), {n}));
        },
        "offsets"_a, "held"_a, "points"_a, "directors"_a, "loads"_a, "twisting"_a,
        "Forces along edges [N], moments at corners and about edges [N m] that balance loads; see rest/inverse_statics.py.");

    module.def(
        "shape_of_joints",
        [](Array1<int> offsets, Array1<double> length, Pairs bend, Array1<double> twist, Array3<double> points,
           Array3<double> directors) {
            const size_t n = points.shape(0);
            check(view(offsets), {n, directors.shape(0), length.shape(0), bend.shape(0), twist.shape(0)});
            std::vector<Vec3> made(n), frames(n);
            for_each_strand(view(offsets), [&](int first, int count) {
                const JointRows<const double> joints{length.data() + first, bend.data() + 2 * first, twist.data() + first};
                RINGLET_DISPATCH(shape_of, count, joints, points.data() + 3 * first, directors.data() + 3 * first,
                                 made[first].data(), frames[first].data());
            });
            return nb::make_tuple(to_numpy<double>(std::move(made), {n, 3}), to_numpy<double>(std::move(frames), {n, 3}));
        },
        "offsets"_a, "length"_a, "bend"_a, "twist"_a, "points"_a, "directors"_a,
        "Points [m] and directors, shapes (n, 3), of strands of such joints; see rest/rod_strains.py.");
}
