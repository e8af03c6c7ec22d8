#include "ringlet/rest/stability.h"

#include "ringlet/energy/strand/frame.h"
#include "ringlet/energy/strand/stretch.h"
#include "ringlet/linear/banded.h"
#include "ringlet/math/dual.h"

namespace ringlet::RINGLET_SIMD {
namespace {

constexpr int dofs = 4;                  // of a vertex: its position, and the rotation of the director of its edge [rad]
constexpr double bisection_error = 0.01; // relative error of the least factor
using Matrix = Banded<double, dofs, joint_dofs>;

Vec<double> row(const double *values, int i) { return {values[3 * i], values[3 * i + 1], values[3 * i + 2]}; }
Vec<Dual> known_row(Vec<double> v) { return {dual_constant(v.x), dual_constant(v.y), dual_constant(v.z)}; }

// An edge with its director; the variables of the dual numbers are its vector and the rotation of the director.
struct Edge {
    Vec<Dual> before, tangent; // current tangent as a constant, and as a function of the variables
    Dual length;
    Vec<Dual> director, across; // across: tangent × director

    Edge(Vec<double> vector, Vec<double> at, int number, int turn) {
        const Vec<Dual> e{dual_variable(vector.x, number), dual_variable(vector.y, number + 1),
                          dual_variable(vector.z, number + 2)};
        length = norm(e);
        tangent = (1.0 / length) * e;
        before = known_row({tangent.x.value, tangent.y.value, tangent.z.value});
        const Vec<Dual> carried = transport(known_row(at), before, tangent);
        director = carried + dual_variable(0.0, turn) * cross(tangent, carried); // first order is enough for the derivative
        across = cross(tangent, director);
    }
    Vec<Dual> spin_of() const { return spin(before, tangent, length); }
};

// Residual r of one energy term of a joint. The dual numbers of its gradient hold the second derivatives.
struct Residual {
    double value;
    std::array<Dual, joint_dofs> gradient;
};

// Two consecutive edges: the residuals of bend at the corner between them and of twist of the first.
class Joint {
public:
    Joint(const StaticStrands &strands, int i)
        : strands_(strands), i_(i), e0_(edge(i), row(strands.directors, i), 0, 6),
          e1_(edge(i + 1), row(strands.directors, i + 1), 3, 7), corner_(corner(e0_.tangent, e1_.tangent)),
          turning_(turning(corner_, e0_.tangent, e1_.tangent)) {}

    Residual across() const { return bend(e1_.director, dot(turning_, e1_.across), strands_.rest_angle[i_ + 1]); }
    Residual along() const { return bend(e1_.across, -dot(turning_, e1_.director), 0.0); }

    Residual twist() const {
        const auto g = frame_twist_gradient(corner_, e0_.tangent, e1_.tangent, e0_.length, e1_.length);
        const Dual angle = frame_twist(e0_.director, e0_.tangent, e1_.director, e1_.tangent);
        return {
            wrap(angle.value - strands_.rest_dihedral[i_]),
            joint_gradient<Dual>({g.first - e0_.spin_of(), g.second + e1_.spin_of()}, dual_constant(-1.0), dual_constant(1.0))};
    }

private:
    Vec<double> edge(int i) const { return row(strands_.positions, i + 1) - row(strands_.positions, i); }

    Residual bend(Vec<Dual> axis, Dual by_turn, double rest) const {
        const auto g = turning_gradient(corner_, e0_.tangent, e1_.tangent, e0_.length, e1_.length, axis);
        return {dot(turning_, axis).value - rest,
                joint_gradient<Dual>({g.first, g.second + by_turn * e1_.spin_of()}, dual_constant(0.0), by_turn)};
    }

    const StaticStrands &strands_;
    int i_;
    Edge e0_, e1_;
    Corner<Dual> corner_;
    Vec<Dual> turning_;
};

// Hessian s A + B of a strand. `growing_` is A, the material stiffness of bend and twist. `fixed_` is B, their geometric
// stiffness and the Hessian of stretch.
class StabilityTest {
public:
    StabilityTest(const StaticStrands &strands, int strand, double *room)
        : strands_(strands), begin_(strands.offsets[strand]), count_(strands.offsets[strand + 1] - begin_),
          growing_(room, size()), fixed_(room + entries(), size()), sum_(room + 2 * entries(), size()) {}

    static size_t room(int vertices) { return 3 * size_t(Matrix::entries(dofs * vertices)); }

    void assemble() {
        growing_.set_zero();
        fixed_.set_zero();
        for (int i = 0; i + 1 < count_; ++i) add_stretch(i);
        for (int i = 0; i + 2 < count_; ++i) {
            const Joint joint(strands_, begin_ + i);
            const double bend = strands_.bend_stiffness[begin_ + i + 1], twist = strands_.twist_stiffness[begin_ + i];
            add(i, joint.across(), bend);
            add(i, joint.along(), bend);
            if (twist > 0.0) add(i, joint.twist(), twist);
            growing_.entry(dofs * (i + 1) + 3)[0] += 1e-9 * bend; // a director without any resistance
        }
        prescribe();
    }

    // Least factor in 1 … most for which (factor − left) A + B is positive definite, by bisection; infinite if there is none.
    double least(double left, double most) {
        if (is_stable(1.0 - left)) return 1.0;
        if (!is_stable(most - left)) return __builtin_inf();
        double unstable = 1.0;
        while (most > (1.0 + bisection_error) * unstable) {
            const double middle = __builtin_sqrt(most * unstable);
            (is_stable(middle - left) ? most : unstable) = middle;
        }
        return most;
    }

private:
    int size() const { return dofs * count_; }
    int entries() const { return Matrix::entries(size()); }
    bool held(int i) const { return strands_.held[begin_ + i] != 0; }

    // Directors rotate from the second edge on, except those of edges with two prescribed vertices.
    bool is_free(int unknown) const {
        const int i = unknown / dofs;
        if (unknown % dofs < 3) return !held(i);
        return i > 0 && i + 1 < count_ && !(held(i) && held(i + 1));
    }

    void add_stretch(int i) {
        const int at = begin_ + i;
        const Vec<double> e = row(strands_.positions, at + 1) - row(strands_.positions, at);
        const double length = norm(e), k = strands_.stretch_stiffness[at];
        const double across = k * (1.0 - strands_.rest_length[at] / length);
        const Vec<double> tangent = (1.0 / length) * e;
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b) {
                const double value = (k - across) * tangent[a] * tangent[b] + (a == b ? across : 0.0);
                for (int p = 0; p < 2; ++p)
                    for (int q = 0; q < 2; ++q)
                        add_lower(fixed_, dofs * (i + p) + a, dofs * (i + q) + b, p == q ? value : -value);
            }
    }

    void add(int i, const Residual &residual, double stiffness) {
        const double force = stiffness * residual.value;
        for (int r = 0; r < joint_dofs; ++r) {
            const Dual &by_dof = residual.gradient[r];
            const Dual::Derivatives &by = by_dof.by;
            const auto second = joint_gradient<double>({{by[0], by[1], by[2]}, {by[3], by[4], by[5]}}, by[6], by[7]);
            for (int c = 0; c <= r; ++c) {
                add_lower(growing_, dofs * i + r, dofs * i + c, stiffness * by_dof.value * residual.gradient[c].value);
                add_lower(fixed_, dofs * i + r, dofs * i + c, force * second[c]);
            }
        }
    }

    // Adds to the lower triangle, which is all that is stored.
    static void add_lower(Matrix &matrix, int r, int c, double value) {
        if (r >= c) matrix.entry(c)[r - c] += value;
    }

    // Replaces the rows and columns of prescribed degrees of freedom by those of the identity in B.
    void prescribe() {
        for (int c = 0; c < size(); ++c) {
            const bool free = is_free(c);
            for (int k = 0; k < Matrix::rows(c); ++k)
                if (!free || !(c + k < size() && is_free(c + k))) growing_.entry(c)[k] = fixed_.entry(c)[k] = 0.0;
            if (!free) fixed_.entry(c)[0] = 1.0;
        }
    }

    // Whether factor · A + B is positive definite: all pivots of its factorisation are positive.
    bool is_stable(double factor) {
        for (int k = 0; k < entries(); ++k) sum_.entry(0)[k] = factor * growing_.entry(0)[k] + fixed_.entry(0)[k];
        sum_.factor();
        for (int c = 0; c < size(); ++c)
            if (!(sum_.entry(c)[0] > 0.0)) return false;
        return true;
    }

    const StaticStrands &strands_;
    int begin_, count_;
    Matrix growing_, fixed_, sum_;
};

} // namespace

size_t stability_scratch(int vertices) { return StabilityTest::room(vertices); }

double stabilising_stiffness(const StaticStrands &strands, int strand, double left, double most, double *room) {
    StabilityTest test(strands, strand, room);
    test.assemble();
    return test.least(left, most);
}

} // namespace ringlet::RINGLET_SIMD
