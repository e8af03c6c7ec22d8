// Stepping a group of strands, one per lane. Built once per instruction set: plain pointers only (see cmake/Simd.cmake).
#include "ringlet/dynamics/newton.h"
#include "ringlet/scene/strand_arrays.h"
#include "ringlet/scene/strand_objective.h"

namespace ringlet::RINGLET_SIMD {
namespace {

// Everything that a group's step works in, laid out in one block of memory.
struct Workspace {
    StrandRow<Pack> *rows;
    StrandShape<Pack> *shapes;
    Vec<Pack> *start, *velocity, *x; // positions and velocities as the step begins, positions
    NewtonSpace<Pack> newton;

    static size_t bytes(int vertices) {
        return vertices * (sizeof(StrandRow<Pack>) + sizeof(StrandShape<Pack>)) +
               (6 * size_t(vertices) + Banded<Pack>::padding) * sizeof(Vec<Pack>) +
               Banded<Pack>::entries(vertices) * sizeof(Pack);
    }

    Workspace(void *memory, int vertices) {
        char *next = static_cast<char *>(memory);
        const auto take = [&next]<class Type>(Type *&place, int count) {
            place = reinterpret_cast<Type *>(next);
            next += count * sizeof(Type);
        };
        take(rows, vertices);
        take(shapes, vertices);
        take(start, vertices);
        take(velocity, vertices);
        take(x, vertices);
        take(newton.trial, vertices);
        take(newton.gradient, vertices);
        take(newton.direction, vertices + Banded<Pack>::padding);
        take(newton.band, Banded<Pack>::entries(vertices));
    }
};

// How the root moves in this step, as a rigid motion: p → to + R (p − from).
struct RootMotion {
    Vec<Pack> from, to;
    Vec<Pack> rotation[3]; // rows of R
    Vec<Pack> turn(Vec<Pack> v) const { return {dot(rotation[0], v), dot(rotation[1], v), dot(rotation[2], v)}; }
    Vec<Pack> move(Vec<Pack> p) const { return to + turn(p - from); }
};

Vec<Pack> load_vector(const double *values, int row, int lane, Vec<Pack> into) {
    for (int k = 0; k < 3; ++k) set_lane(into[k], lane, values[3 * row + k]);
    return into;
}

class Group {
public:
    Group(const StrandArrays &arrays, const StrandStep &step, StrandGroup group, int vertices, void *memory)
        : arrays_(arrays), step_(step), group_(group), vertices_(vertices), space_(memory, vertices),
          objective_(step.continuation, vertices, space_.rows, space_.shapes) {
        for (int lane = 0; lane < lanes; ++lane) load(lane);
        objective_.evaluate(space_.start);
        remember_start();
    }

    void step(StrandReport *reports) {
        const RootMotion root = root_motion();
        for (int i = 0; i < vertices_; ++i) carry(root, i);
        resist_rates();
        add_inertia();
        guess(root);
        const NewtonResult<Pack> result =
            newton(objective_, space_.x, vertices_, {step_.newton, step_.tolerance}, space_.newton);
        objective_.evaluate(space_.x);
        for (int lane = 0; lane < group_.count; ++lane) reports[lane] = unload(lane, result);
    }

    // Elastic energy, gradient and Hessian of the first lane's strand at other positions, without inertia or damping.
    double energy(const double *positions, double *gradient, double *hessian) {
        const int first = arrays_.offsets[group_.strands[0]];
        for (int i = 0; i < vertices_; ++i) {
            for (int k = 0; k < 3; ++k) space_.x[i][k] = constant<Pack>(positions[3 * (first + i) + k]);
            space_.rows[i].inertia = Pack{};
            space_.rows[i].inertial = Vec<Pack>{};
        }
        const double value = lane(objective_.evaluate(space_.x), 0);
        Banded<Pack> band(space_.newton.band, vertices_);
        objective_.assemble(space_.newton.gradient, band);
        const int size = 3 * vertices_;
        for (int i = 0; i < size; ++i) gradient[i] = lane(space_.newton.gradient[i / 3][i % 3], 0);
        for (int c = 0; hessian && c < size; ++c)
            for (int r = c; r < size && r < c + Banded<Pack>::band; ++r)
                hessian[r * size + c] = hessian[c * size + r] = lane(band.entry(c)[r - c], 0);
        return value;
    }

private:
    int strand(int lane) const { return group_.strands[lane < group_.count ? lane : 0]; }

    // Lanes hold strands of different lengths: behind a strand's tip follow vertices that nothing acts on, on a straight line.
    void load(int lane) {
        const int first = arrays_.offsets[strand(lane)], count = arrays_.offsets[strand(lane) + 1] - first;
        for (int i = 0; i < vertices_; ++i) {
            StrandRow<Pack> &row = space_.rows[i];
            const bool real = i < count;
            const int at = first + (real ? i : count - 1);
            const auto value = [&](Pack &into, const double *from, double otherwise) {
                set_lane(into, lane, real ? from[at] : otherwise);
            };
            set_lane(row.free, lane, real && !arrays_.held[at] ? 1.0 : 0.0);
            value(row.stretch, arrays_.stretch_stiffness, 0.0);
            value(row.rest_length, arrays_.rest_length, 1.0);
            value(row.bend, arrays_.bend_stiffness, 0.0);
            value(row.rest_angle, arrays_.rest_angle, 0.0);
            value(row.twist, arrays_.twist_stiffness, 0.0);
            value(row.rest_dihedral, arrays_.rest_dihedral, 0.0);
            value(row.damping, arrays_.damping, 0.0);
            value(row.reference.delta, arrays_.twist, 0.0);
            row.reference.normal = load_vector(arrays_.normals, at, lane, row.reference.normal);
            space_.start[i] = load_vector(arrays_.positions, at, lane, space_.start[i]);
            space_.velocity[i] = load_vector(arrays_.velocities, at, lane, space_.velocity[i]);
            space_.x[i] = load_vector(arrays_.targets, at, lane, space_.x[i]); // of held vertices
            const double beyond = real ? 0.0 : i - count + 1;
            set_lane(space_.start[i].x, lane, space_.start[i].x[lane] + beyond);
            set_lane(space_.x[i].x, lane, space_.x[i].x[lane] + beyond);
            row.damped_strain = Pack{};
        }
        for (int i = 0; i < vertices_; ++i) {
            StrandRow<Pack> &row = space_.rows[i];
            row.damped_length = row.rest_length;
            row.damped_angle = row.rest_angle;
        }
        for (int i = 0; i + 1 < vertices_; ++i) { // the references are of this very state: nothing to carry yet
            const Vec<Pack> edge = space_.start[i + 1] - space_.start[i];
            space_.rows[i].reference.tangent = (1.0 / max(norm(edge), constant<Pack>(1e-30))) * edge;
        }
    }

    bool is_hinge(int i) const { return i > 0 && i + 2 < vertices_; }

    void remember_start() {
        for (int i = 0; i < vertices_; ++i) {
            StrandRow<Pack> &row = space_.rows[i];
            const StrandShape<Pack> &s = space_.shapes[i];
            row.start_sigma = s.sigma;
            row.start_turns = s.turns;
            row.reference.fade =
                is_hinge(i) ? straightness_fade(s.corner.angle) * straightness_fade(space_.shapes[i + 1].corner.angle) : Pack{};
            if (is_hinge(i) && step_.continuation == Continuation::history) { // evaluated before the fades were known
                space_.shapes[i].strain = row.reference.fade * s.delta;
                space_.shapes[i].by_dihedral = row.reference.fade;
            }
        }
    }

    // The rigid motion from the held vertices at the start of the step to where they are at its end. Three of them give a
    // rotation; with fewer the root only translates.
    RootMotion root_motion() const {
        const Vec<Pack> *a = space_.start, *b = space_.x;
        RootMotion motion{a[0], b[0], {}};
        const Vec<Pack> t0 = unit(a[1] - a[0]), t1 = unit(b[1] - b[0]);
        const Corner<Pack> from = corner(t0, unit(a[2] - a[1])), to = corner(t1, unit(b[2] - b[1]));
        const Vec<Pack> side0 = cross(from.normal, t0), side1 = cross(to.normal, t1);
        const auto rigid = (space_.rows[2].free == 0.0) & (from.sine > 1e-6) & (to.sine > 1e-6);
        for (int k = 0; k < 3; ++k) {
            const Vec<Pack> row = t1[k] * t0 + to.normal[k] * from.normal + side1[k] * side0;
            Vec<Pack> same{};
            same[k] = constant<Pack>(1.0);
            motion.rotation[k] = select<Pack>(rigid, row, same);
        }
        return motion;
    }

    static Vec<Pack> unit(Vec<Pack> v) { return (1.0 / max(norm(v), constant<Pack>(1e-30))) * v; }

    void carry(const RootMotion &root, int i) {
        Reference<Pack> &reference = space_.rows[i].reference;
        reference.normal = root.turn(reference.normal);
        reference.tangent = root.turn(reference.tangent);
    }

    // Damping of the strains' rates, as stiffer energies about rest values between the groom's and the present ones.
    void resist_rates() {
        for (int i = 0; i + 1 < vertices_; ++i) {
            StrandRow<Pack> &row = space_.rows[i];
            const StrandShape<Pack> &s = space_.shapes[i];
            const Pack b = row.damping / step_.dt, part = 1.0 / (1.0 + b);
            row.damped_length = part * (row.rest_length + b * s.length);
            if (i > 0) row.damped_angle = part * (row.rest_angle + b * s.sigma * s.corner.angle);
            if (is_hinge(i)) row.damped_strain = part * b * s.strain;
            row.stretch *= 1.0 + b;
            row.bend *= 1.0 + b;
            row.twist *= 1.0 + b;
        }
    }

    void add_inertia() {
        const double h = step_.dt;
        for (int lane = 0; lane < lanes; ++lane) {
            const int first = arrays_.offsets[strand(lane)], count = arrays_.offsets[strand(lane) + 1] - first;
            for (int i = 0; i < vertices_; ++i) {
                const double mass = i < count ? arrays_.mass[first + i] : 0.0,
                             drag = i < count ? arrays_.drag[first + i] / h : 0.0;
                const double moving = mass / (h * h), held = arrays_.mass_damping * mass / h, sum = moving + held + drag;
                set_lane(space_.rows[i].inertia, lane, sum);
                for (int k = 0; k < 3; ++k) {
                    const double start = space_.start[i][k][lane];
                    const double free_flight = start + h * space_.velocity[i][k][lane] + h * h * step_.gravity[k];
                    const double with_wind = start + h * step_.wind[k];
                    const double force = i < count ? arrays_.forces[3 * (first + i) + k] : 0.0;
                    const double y = sum > 0 ? (moving * free_flight + held * start + drag * with_wind + force) / sum : 0.0;
                    set_lane(space_.rows[i].inertial[k], lane, y);
                }
            }
        }
    }

    // Newton starts from the least energetic of: staying, flying on, moving rigidly with the root. Staying is among them, so a
    // step with a still root can never gain energy.
    void guess(const RootMotion &root) {
        const auto place = [this](int i, Vec<Pack> p) { return select<Pack>(space_.rows[i].free > 0.0, p, space_.x[i]); };
        Vec<Pack> *trial = space_.newton.trial, *best = space_.x;
        for (int i = 0; i < vertices_; ++i) best[i] = place(i, space_.start[i]);
        Pack least = objective_.evaluate(best);
        for (int attempt = 0; attempt < 2; ++attempt) {
            for (int i = 0; i < vertices_; ++i)
                trial[i] = place(i, attempt == 0 ? root.move(space_.start[i])
                                                 : space_.start[i] + constant<Pack>(step_.dt) * space_.velocity[i]);
            const Pack energy = objective_.evaluate(trial);
            const auto better = energy < least;
            for (int i = 0; i < vertices_; ++i) best[i] = select<Pack>(better, trial[i], best[i]);
            least = select(better, energy, least);
        }
    }

    // Writes one strand's state back and says what happened to it.
    StrandReport unload(int lane, const NewtonResult<Pack> &result) {
        const int first = arrays_.offsets[strand(lane)], count = arrays_.offsets[strand(lane) + 1] - first;
        StrandReport report{};
        report.newton = result.iterations[lane];
        report.cuts = result.cuts[lane];
        report.residual = result.residual[lane];
        report.unconverged = result.residual[lane] > step_.tolerance;
        double sum = 0;
        for (int i = 0; i < count; ++i)
            for (int k = 0; k < 3; ++k) sum += space_.x[i][k][lane];
        if (!(sum - sum == 0)) { // not finite: keep the last good state, at rest
            report.nan = 1;
            for (int i = 3 * first; i < 3 * (first + count); ++i) arrays_.velocities[i] = 0;
            return report;
        }
        for (int i = 0; i < count; ++i) {
            const StrandRow<Pack> &row = space_.rows[i];
            const StrandShape<Pack> &s = space_.shapes[i];
            const int at = first + i;
            const bool free = row.free[lane] > 0, edge = i + 1 < count, corner = edge && i > 0, hinge = i > 0 && i + 2 < count;
            const bool edge_free = edge && space_.rows[i + 1].free[lane] > 0,
                       hinge_free = hinge && space_.rows[i + 2].free[lane] > 0;
            double speed2 = 0;
            for (int k = 0; k < 3; ++k) {
                const double x = space_.x[i][k][lane], v = (x - arrays_.positions[3 * at + k]) / step_.dt;
                arrays_.positions[3 * at + k] = x;
                arrays_.velocities[3 * at + k] = v;
                speed2 += v * v;
                report.gravity -= arrays_.mass[at] * step_.gravity[k] * x * free;
            }
            report.kinetic += 0.5 * arrays_.mass[at] * speed2 * free;
            if (edge_free) {
                const double strain = s.length[lane] / arrays_.rest_length[at] - 1.0;
                report.stretch += stretch_energy(s.length[lane], arrays_.rest_length[at], arrays_.stretch_stiffness[at]);
                report.max_stretch = max(report.max_stretch, abs(strain));
            }
            if (corner) {
                report.bend +=
                    bend_energy(s.corner.angle[lane], s.sigma[lane], arrays_.rest_angle[at], arrays_.bend_stiffness[at]);
                report.flips += s.sigma[lane] != row.start_sigma[lane];
                remember_normal(lane, i, at);
            }
            if (hinge) {
                report.twist += twist_energy(s.strain[lane], arrays_.twist_stiffness[at]);
                report.winding_changes += s.turns[lane] != row.start_turns[lane];
                report.too_straight += hinge_free && s.by_dihedral[lane] == 0.0;
                arrays_.twist[at] = s.delta[lane];
            }
        }
        return report;
    }

    // A nearly straight corner has no normal of its own: it keeps the one it had, carried along.
    void remember_normal(int lane, int i, int at) {
        const StrandRow<Pack> &row = space_.rows[i];
        const StrandShape<Pack> &s = space_.shapes[i];
        const bool bent = s.corner.sine[lane] > 2.6e-3;
        const Vec<Pack> normal =
            bent ? s.sigma * s.corner.normal : transport(row.reference.normal, row.reference.tangent, s.tangent);
        for (int k = 0; k < 3; ++k) arrays_.normals[3 * at + k] = normal[k][lane];
    }

    const StrandArrays &arrays_;
    const StrandStep &step_;
    StrandGroup group_;
    int vertices_;
    Workspace space_;
    StrandObjective<Pack> objective_;
};

int longest(const StrandArrays &arrays, StrandGroup group) {
    int most = 3;
    for (int k = 0; k < group.count; ++k) {
        const int count = arrays.offsets[group.strands[k] + 1] - arrays.offsets[group.strands[k]];
        most = count > most ? count : most;
    }
    return most;
}

} // namespace

int strand_lanes() { return lanes; }

size_t strand_workspace(int vertices) { return Workspace::bytes(vertices); }

void step_strand_group(const StrandArrays &arrays, const StrandStep &step, StrandGroup group, void *workspace,
                       StrandReport *reports) {
    Group(arrays, step, group, longest(arrays, group), workspace).step(reports);
}

double strand_group_energy(const StrandArrays &arrays, const StrandStep &step, int strand, const double *positions,
                           void *workspace, double *gradient, double *hessian) {
    const StrandGroup group{&strand, 1};
    return Group(arrays, step, group, longest(arrays, group), workspace).energy(positions, gradient, hessian);
}

} // namespace ringlet::RINGLET_SIMD
