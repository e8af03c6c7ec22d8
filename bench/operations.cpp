// Counts the floating-point operations of one Newton iteration of a strand, per vertex: the kernels are run on numbers that
// count.
//   g++ -std=c++20 -O1 -I src bench/operations.cpp -o operations && ./operations
#include "ringlet/math/pack.h"

static long operations = 0; // additions, products, quotients and roots; comparisons and signs are not counted

namespace ringlet::baseline {

struct Counted {
    double value = 0;
    Counted() = default;
    Counted(double v) : value(v) {}
};

inline Counted counted(double value) {
    ++operations;
    return value;
}
inline Counted operator+(Counted a, Counted b) { return counted(a.value + b.value); }
inline Counted operator-(Counted a, Counted b) { return counted(a.value - b.value); }
inline Counted operator*(Counted a, Counted b) { return counted(a.value * b.value); }
inline Counted operator/(Counted a, Counted b) { return counted(a.value / b.value); }
inline Counted sqrt(Counted x) { return counted(__builtin_sqrt(x.value)); }
inline Counted operator-(Counted a) { return -a.value; }
inline Counted &operator+=(Counted &a, Counted b) { return a = a + b; }
inline Counted &operator-=(Counted &a, Counted b) { return a = a - b; }
inline Counted &operator*=(Counted &a, Counted b) { return a = a * b; }
inline bool operator<(Counted a, Counted b) { return a.value < b.value; }
inline bool operator>(Counted a, Counted b) { return a.value > b.value; }
inline bool operator<=(Counted a, Counted b) { return a.value <= b.value; }
inline Counted select(bool mask, Counted a, Counted b) { return mask ? a : b; }

template <> struct Traits<Counted> {
    using Mask = bool;
    static constexpr int lanes = 1;
};

} // namespace ringlet::baseline

#include "ringlet/strand/rod_objective.h"

#include <cmath>
#include <cstdio>
#include <vector>

using namespace ringlet::baseline;

int main() {
    using Objective = RodObjective<Counted>;
    using Matrix = Objective::Matrix;
    const int vertices = 60, unknowns = 4 * vertices;
    std::vector<StrandRow<Counted>> rows(vertices);
    std::vector<StrandShape<Counted>> shapes(vertices);
    std::vector<Counted> x(unknowns), gradient(unknowns), direction(unknowns + Matrix::padding);
    for (int i = 0; i < vertices; ++i) { // a coil, pulled a little; three vertices are held
        const double turn = 2 * pi * i / 12;
        x[4 * i] = 2.5e-3 * std::cos(turn);
        x[4 * i + 1] = -3.3e-3 * i / 12;
        x[4 * i + 2] = 2.5e-3 * std::sin(turn);
        rows[i].free = rows[i].frame_free = i > 2 ? 1.0 : 0.0;
        rows[i].inertia = 1e-4;
        rows[i].stretch_stiffness = 100.0;
        rows[i].rest_length = rows[i].damped_length = 1.3e-3;
        rows[i].bend_stiffness = rows[i].twist_stiffness = 1e-6;
        rows[i].rest_angle = 0.5;
        rows[i].rest_dihedral = 0.2;
        rows[i].reference.normal = {1.0, 0.0, 0.0};
        rows[i].reference.tangent = {0.0, -1.0, 0.0};
    }
    Objective objective(vertices, rows.data(), shapes.data());
    std::vector<Counted> band(Matrix::entries(unknowns));
    Matrix hessian(band.data(), unknowns);
    const auto tell = [&](const char *what) {
        std::printf("%-9s %5.0f\n", what, double(operations) / vertices);
        operations = 0;
    };
    objective.evaluate(x.data());
    tell("evaluate");
    objective.assemble(gradient.data(), hessian);
    tell("assemble");
    hessian.factor();
    tell("factor");
    for (int i = 0; i < unknowns; ++i) direction[i] = -gradient[i];
    hessian.solve(direction.data());
    tell("solve");
    const size_t bytes = sizeof(StrandRow<double>) + sizeof(StrandShape<double>) + 3 * sizeof(Vec<double>) +
                         (4 * 4 + Matrix::layout.begin(4)) * sizeof(double);
    std::printf("bytes worked in %zu\n", bytes);
}
