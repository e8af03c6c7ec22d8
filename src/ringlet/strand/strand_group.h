// A group of strands, one per lane: taken in from the arrays, stepped alone or in phases, and written back.
#pragma once

#include "ringlet/dynamics/newton.h"
#include "ringlet/strand/strand_arrays.h"
#include "ringlet/strand/strand_objective.h"

#include <cmath>

namespace ringlet::RINGLET_SIMD {

// Everything that a group's step works in, laid out in one block of memory.
template <class Objective> struct Workspace {
    using Matrix = typename Objective::Matrix;

    StrandRow<Pack> *rows;
    StrandShape<Pack> *shapes;
    Vec<Pack> *start, *velocity, *target; // positions and velocities as the step begins, where held vertices end
    Pack *x;                              // the unknowns
    NewtonSpace<Pack> newton;

    static size_t bytes(int vertices) {
        const int unknowns = Objective::freedoms * vertices;
        return vertices * (sizeof(StrandRow<Pack>) + sizeof(StrandShape<Pack>) + 3 * sizeof(Vec<Pack>)) +
               (4 * size_t(unknowns) + Matrix::padding + Matrix::entries(unknowns)) * sizeof(Pack);
    }

    Workspace(void *memory, int vertices) {
        char *next = static_cast<char *>(memory);
        const auto take = [&next]<class Type>(Type *&place, int count) {
            place = reinterpret_cast<Type *>(next);
            next += count * sizeof(Type);
        };
        const int unknowns = Objective::freedoms * vertices;
        take(rows, vertices);
        take(shapes, vertices);
        take(start, vertices);
        take(velocity, vertices);
        take(target, vertices);
        take(x, unknowns);
        take(newton.trial, unknowns);
        take(newton.gradient, unknowns);
        take(newton.direction, unknowns + Matrix::padding);
        take(newton.band, Matrix::entries(unknowns));
    }
};

// How the root moves in this step, as a rigid motion: p → to + R (p − from).
struct RootMotion {
    Vec<Pack> from, to;
    Vec<Pack> rotation[3]; // rows of R
    Vec<Pack> turn(Vec<Pack> v) const { return {dot(rotation[0], v), dot(rotation[1], v), dot(rotation[2], v)}; }
    Vec<Pack> move(Vec<Pack> p) const { return to + turn(p - from); }
};

inline Vec<Pack> unit(Vec<Pack> v) { return (1.0 / max(norm(v), constant<Pack>(1e-30))) * v; }

// A group whose step is solved from outside, whatever its model.
struct OpenGroup {
    virtual ~OpenGroup() = default;
    virtual StrandGroupSystem begin() = 0;
    virtual void energy(const Pack *x, double *energies) = 0;
    virtual void evaluate(const Pack *x, double *energies) = 0;
    virtual void assemble(const Pack *x) = 0;
    virtual void factor() = 0;
    virtual void solve(Pack *b) = 0;
    virtual void worth_going(const Pack *x, const Pack *direction, double *parts) const = 0;
    virtual void turn(const Pack *x, const Pack *direction, Pack *to) const = 0;
    virtual void end(const Pack *x, const StrandEffort &effort, StrandReport *reports) = 0;
};

template <class Objective> class Group final : public OpenGroup {
    using Matrix = typename Objective::Matrix;
    static constexpr bool frames = Objective::freedoms == 4;

public:
    Group(const StrandArrays &arrays, const StrandStep &step, StrandGroup group, int vertices, void *memory)
        : arrays_(arrays), step_(step), group_(group), vertices_(vertices), space_(memory, vertices),
          objective_(vertices, space_.rows, space_.shapes, step.safeguards) {
        load();
        for (int i = 0; i < vertices_; ++i) place(space_.x, i, space_.start[i]);
        start_energy_ = objective_.evaluate(space_.x);
        objective_.remember_start();
    }

    void step(StrandReport *reports) {
        prepare();
        const NewtonResult<Pack> result = newton(objective_, space_.x, {step_.newton, step_.tolerance}, space_.newton);
        objective_.evaluate(space_.x);
        undamp();
        for (int lane = 0; lane < group_.count; ++lane) {
            reports[lane] = unload(lane, {result.iterations[lane], result.cuts[lane], result.residual[lane]});
            if (reports[lane].unconverged > 0 && is_left_alone(lane)) keep_energy(lane, reports[lane]);
        }
    }

    StrandGroupSystem begin() override {
        prepare();
        const auto plain = [](Pack *values) { return reinterpret_cast<double *>(values); };
        return {plain(space_.x), plain(space_.newton.gradient), plain(space_.newton.band), Matrix::layout, lanes, vertices_,
                Matrix::padding};
    }

    void energy(const Pack *x, double *energies) override { put_lanes(objective_.energy(x), energies); }
    void evaluate(const Pack *x, double *energies) override { put_lanes(objective_.evaluate(x), energies); }

    void assemble(const Pack *x) override {
        Matrix hessian = matrix();
        objective_.find_at(x);
        objective_.assemble(space_.newton.gradient, hessian);
    }

    void factor() override { matrix().factor(); }
    void solve(Pack *b) override { matrix().solve(b); }

    void worth_going(const Pack *x, const Pack *direction, double *parts) const override {
        put_lanes(objective_.worth_going(x, direction), parts);
    }
    void turn(const Pack *x, const Pack *direction, Pack *to) const override {
        objective_.move(x, constant<Pack>(1.0), direction, to);
    }

    void end(const Pack *x, const StrandEffort &effort, StrandReport *reports) override {
        for (int i = 0; i < objective_.size(); ++i) space_.x[i] = x[i];
        objective_.evaluate(space_.x);
        undamp();
        for (int lane = 0; lane < group_.count; ++lane) reports[lane] = unload(lane, effort);
    }

    // Turns the material frames to where they cost least at the present positions; says how much that is [J].
    void relax_frames(double *energies) {
        const Pack energy = relax();
        for (int lane = 0; lane < group_.count; ++lane) {
            energies[lane] = energy[lane];
            for (int i = 1; i + 1 < count(lane); ++i) keep_normal(lane, i);
        }
    }

    // Elastic energy, gradient and Hessian of the first lane's strand at other positions, without inertia or damping; frames
    // take the turns that cost least there.
    double energy(const double *positions, double *gradient, double *hessian) {
        for (int i = 0; i < vertices_; ++i) {
            Vec<Pack> p;
            for (int k = 0; k < 3; ++k) p[k] = constant<Pack>(positions[3 * (first(0) + i) + k]);
            place(space_.x, i, p);
        }
        const double value = lane(relax(), 0);
        typename Objective::Matrix band(space_.newton.band, objective_.size());
        objective_.assemble(space_.newton.gradient, band);
        const int size = objective_.size();
        for (int i = 0; i < 3 * vertices_; ++i)
            gradient[i] = lane(space_.newton.gradient[Objective::freedoms * (i / 3) + i % 3], 0);
        for (int c = 0; hessian && c < size; ++c)
            for (int r = c; r < size && r < c + Matrix::rows(c); ++r)
                hessian[r * size + c] = hessian[c * size + r] = lane(band.entry(c)[r - c], 0);
        return value;
    }

private:
    void put_lanes(Pack energy, double *energies) const {
        for (int lane = 0; lane < lanes; ++lane) energies[lane] = lane < group_.count ? energy[lane] : 0.0;
    }

    Matrix matrix() { return {space_.newton.band, objective_.size()}; }

    void prepare() {
        const RootMotion root = root_motion();
        resist_rates();
        carry(root);
        add_inertia();
        guess(root);
    }

    int strand(int lane) const { return group_.strands[lane < group_.count ? lane : 0]; }
    int first(int lane) const { return arrays_.offsets[strand(lane)]; }
    int count(int lane) const { return arrays_.offsets[strand(lane) + 1] - first(lane); }

    void place(Pack *x, int i, Vec<Pack> position) {
        for (int k = 0; k < 3; ++k) x[Objective::freedoms * i + k] = position[k];
        if (frames) x[Objective::freedoms * i + 3] = Pack{};
    }

    static void load_vector(const double *values, int row, int lane, Vec<Pack> &into) {
        for (int k = 0; k < 3; ++k) set_lane(into[k], lane, values[3 * row + k]);
    }

    // Lanes hold strands of different lengths: behind a strand's tip follow vertices that nothing acts on, on a straight line.
    void load() {
        for (int lane = 0; lane < lanes; ++lane) {
            const bool carries = step_.integrator == Integrator::bdf2 && arrays_.last_dt[strand(lane)] == step_.dt;
            set_lane(part_, lane, carries ? 1.0 / 3 : 0.0);
        }
        for (int i = 0; i < vertices_; ++i) {
            for (int lane = 0; lane < lanes; ++lane) load(i, lane);
            StrandRow<Pack> &row = space_.rows[i];
            row.damped_length = row.rest_length;
            row.damped_angle = row.rest_angle;
            row.damped_bend = Vec<Pack>{};
            row.damped_strain = Pack{};
            row.undamped = constant<Pack>(1.0);
            row.inertia = Pack{};
            row.inertial = Vec<Pack>{};
        }
        for (int i = 0; i + 1 < vertices_; ++i) // the references are of this very state: nothing to carry yet
            space_.rows[i].reference.tangent = unit(space_.start[i + 1] - space_.start[i]);
    }

    void load(int i, int lane) {
        StrandRow<Pack> &row = space_.rows[i];
        const int n = count(lane);
        const bool real = i < n;
        const int at = first(lane) + (real ? i : n - 1);
        const auto value = [&](Pack &into, const double *from, double otherwise) {
            set_lane(into, lane, real ? from[at] : otherwise);
        };
        const bool held = !real || arrays_.held[at], next_held = i + 1 >= n || arrays_.held[at + 1];
        set_lane(row.free, lane, held ? 0.0 : 1.0);
        set_lane(row.frame_free, lane, i > 0 && i + 1 < n && !(held && next_held) ? 1.0 : 0.0);
        value(row.stretch, arrays_.stretch_stiffness, 0.0);
        value(row.rest_length, arrays_.rest_length, 1.0);
        if (i + 1 >= n) set_lane(row.rest_length, lane, 1.0); // no edge begins at the tip
        value(row.bend, arrays_.bend_stiffness, 0.0);
        value(row.rest_angle, arrays_.rest_angle, 0.0);
        value(row.twist, arrays_.twist_stiffness, 0.0);
        value(row.rest_dihedral, arrays_.rest_dihedral, 0.0);
        value(row.damping, arrays_.damping, 0.0);
        value(row.reference.delta, arrays_.twist, 0.0);
        load_vector(frames ? arrays_.directors : arrays_.normals, at, lane, row.reference.normal);
        load_vector(arrays_.positions, at, lane, space_.start[i]);
        load_vector(arrays_.velocities, at, lane, space_.velocity[i]);
        load_vector(arrays_.targets, at, lane, space_.target[i]);
        const double beyond = real ? 0.0 : i - n + 1;
        set_lane(space_.start[i].x, lane, space_.start[i].x[lane] + beyond);
        set_lane(space_.target[i].x, lane, space_.target[i].x[lane] + beyond);
    }

    // Newton on the frames alone: all vertices are held (which were free is kept in `start`, which is not needed any more).
    Pack relax() {
        if (!frames) return objective_.evaluate(space_.x);
        for (int i = 0; i < vertices_; ++i) {
            space_.start[i].x = space_.rows[i].free;
            space_.rows[i].free = Pack{};
        }
        newton(objective_, space_.x, {100, 1e-14}, space_.newton);
        for (int i = 0; i < vertices_; ++i) space_.rows[i].free = space_.start[i].x;
        return objective_.evaluate(space_.x);
    }

    void keep_normal(int lane, int i) {
        const Vec<Pack> normal = objective_.normal_to_keep(i);
        for (int k = 0; k < 3; ++k) (frames ? arrays_.directors : arrays_.normals)[3 * (first(lane) + i) + k] = normal[k][lane];
    }

    // The rigid motion from the held vertices at the start of the step to where they are at its end. Three of them give a
    // rotation; with fewer the root only translates.
    RootMotion root_motion() const {
        const Vec<Pack> *a = space_.start, *b = space_.target;
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

    void carry(const RootMotion &root) {
        for (int i = 0; i < vertices_; ++i) {
            Reference<Pack> &reference = space_.rows[i].reference;
            reference.normal = root.turn(reference.normal);
            reference.tangent = root.turn(reference.tangent);
        }
    }

    // Damping of the strains' rates, as stiffer energies about rest values between the groom's and the carried ones.
    void resist_rates() {
        const Pack h = step_.dt * (1.0 - part_);
        for (int i = 0; i + 1 < vertices_; ++i) {
            StrandRow<Pack> &row = space_.rows[i];
            const Pack b = row.damping / h;
            const Strains<Pack> carried = carried_strains(i);
            row.undamped = 1.0 / (1.0 + b);
            row.damped_length = row.undamped * (row.rest_length + b * carried.length());
            if (i > 0) objective_.damp(i, b, carried);
            row.stretch *= 1.0 + b;
            row.bend *= 1.0 + b;
            row.twist *= 1.0 + b;
        }
    }

    void undamp() {
        for (int i = 0; i + 1 < vertices_; ++i) {
            StrandRow<Pack> &row = space_.rows[i];
            row.stretch *= row.undamped;
            row.bend *= row.undamped;
            row.twist *= row.undamped;
        }
    }

    // x̂ of the strains, whose present values are kept for the next step. Twist is known up to turns, and so is its change.
    Strains<Pack> carried_strains(int i) {
        Strains<Pack> now = objective_.strains(i);
        if (step_.integrator == Integrator::backward_euler) return now;
        Strains<Pack> last = now;
        for (int lane = 0; lane < group_.count; ++lane) {
            if (i + 1 >= count(lane)) continue;
            double *kept = arrays_.last_strains + Strains<Pack>::count * (first(lane) + i);
            for (int k = 0; k < Strains<Pack>::count; ++k) {
                if (part_[lane] > 0) set_lane(last[k], lane, kept[k]);
                kept[k] = now[k][lane];
            }
        }
        for (int k = 0; k < 3; ++k) now[k] += part_ * (now[k] - last[k]);
        now[3] += part_ * wrap(now.twist() - last.twist());
        return now;
    }

    // x̂ of the integrator, of a quantity that was `last` a step ago.
    double carried(double now, const double *last, int at, int lane) const {
        return part_[lane] > 0 ? now + part_[lane] * (now - last[at]) : now;
    }

    void add_inertia() {
        for (int lane = 0; lane < lanes; ++lane) {
            const int begin = first(lane), n = count(lane);
            const double h = step_.dt * (1.0 - part_[lane]);
            for (int i = 0; i < n; ++i) {
                const int at = begin + i;
                const double mass = arrays_.mass[at], drag = arrays_.drag[at] / h;
                const double moving = mass / (h * h), held = arrays_.mass_damping * mass / h, sum = moving + held + drag;
                set_lane(space_.rows[i].inertia, lane, sum);
                for (int k = 0; k < 3; ++k) {
                    const double start = carried(space_.start[i][k][lane], arrays_.last_positions, 3 * at + k, lane);
                    const double velocity = carried(space_.velocity[i][k][lane], arrays_.last_velocities, 3 * at + k, lane);
                    const double free_flight = start + h * velocity + h * h * step_.gravity[k];
                    const double with_wind = start + h * step_.wind[k];
                    const double force = arrays_.forces[3 * at + k];
                    const double y = sum > 0 ? (moving * free_flight + held * start + drag * with_wind + force) / sum : 0.0;
                    set_lane(space_.rows[i].inertial[k], lane, y);
                }
            }
        }
    }

    // Newton starts from the least energetic of: staying, flying on, moving rigidly with the root.
    void guess(const RootMotion &root) {
        Pack *trial = space_.newton.trial, *best = space_.x;
        Pack least{};
        for (int attempt = 0; attempt < 3; ++attempt) {
            Pack *x = attempt == 0 ? best : trial;
            for (int i = 0; i < vertices_; ++i) {
                const Vec<Pack> start = space_.start[i];
                const Vec<Pack> to = attempt == 0   ? start
                                     : attempt == 1 ? root.move(start)
                                                    : start + constant<Pack>(step_.dt) * space_.velocity[i];
                place(x, i, select<Pack>(space_.rows[i].free > 0.0, to, space_.target[i]));
            }
            const Pack energy = objective_.energy(x);
            if (attempt == 0) {
                least = energy;
                continue;
            }
            const auto better = energy < least;
            for (int i = 0; i < objective_.size(); ++i) best[i] = select(better, trial[i], best[i]);
            least = select(better, energy, least);
        }
    }

    // Writes one strand's state back and says what happened to it.
    StrandReport unload(int lane, const StrandEffort &effort) {
        const int begin = first(lane), n = count(lane);
        StrandReport report{};
        report.newton = effort.iterations;
        report.cuts = effort.cuts;
        report.residual = effort.residual;
        report.unconverged = effort.residual > step_.tolerance;
        const auto coordinate = [&](int i, int k) { return space_.x[Objective::freedoms * i + k][lane]; };
        double sum = 0;
        for (int i = 0; i < n; ++i)
            for (int k = 0; k < 3; ++k) sum += coordinate(i, k);
        if (!(sum - sum == 0)) { // not finite: keep the last good state, at rest
            report.nan = 1;
            for (int i = 3 * begin; i < 3 * (begin + n); ++i) arrays_.velocities[i] = 0;
            arrays_.last_dt[strand(lane)] = 0;
            return report;
        }
        arrays_.last_dt[strand(lane)] = step_.integrator == Integrator::bdf2 ? step_.dt : 0.0;
        const double h = step_.dt * (1.0 - part_[lane]);
        for (int i = 0; i < n; ++i) {
            const StrandRow<Pack> &row = space_.rows[i];
            const StrandShape<Pack> &s = space_.shapes[i];
            const int at = begin + i;
            const bool free = row.free[lane] > 0, edge = i + 1 < n, corner = edge && i > 0, hinge = i > 0 && i + 2 < n;
            const bool edge_free = edge && space_.rows[i + 1].free[lane] > 0;
            const bool hinge_free = hinge && space_.rows[i + 2].free[lane] > 0;
            double speed2 = 0;
            for (int k = 0; k < 3; ++k) {
                double &position = arrays_.positions[3 * at + k], &velocity = arrays_.velocities[3 * at + k];
                const double x = coordinate(i, k), v = (x - carried(position, arrays_.last_positions, 3 * at + k, lane)) / h;
                if (step_.integrator == Integrator::bdf2) {
                    arrays_.last_positions[3 * at + k] = position;
                    arrays_.last_velocities[3 * at + k] = velocity;
                }
                position = x;
                velocity = v;
                speed2 += v * v;
                report.gravity -= arrays_.mass[at] * step_.gravity[k] * x * free;
            }
            report.kinetic += 0.5 * arrays_.mass[at] * speed2 * free;
            if (edge_free) {
                const double strain = s.length[lane] / arrays_.rest_length[at] - 1.0;
                report.stretch += stretch_energy(s.length[lane], arrays_.rest_length[at], arrays_.stretch_stiffness[at]);
                report.max_stretch = max(report.max_stretch, abs(strain));
                report.clamped += objective_.clamped(i)[lane];
            }
            if (corner) {
                report.bend += objective_.bend_energy_at(i)[lane];
                report.flips += objective_.flipped(i)[lane];
                keep_normal(lane, i);
            }
            if (hinge) {
                report.twist += objective_.twist_energy_at(i)[lane];
                report.winding_changes += objective_.wound(i)[lane];
                report.too_straight += hinge_free * objective_.too_straight(i)[lane];
                if (!frames) arrays_.twist[at] = s.delta[lane];
            }
        }
        return report;
    }

    // Nothing does work on it but gravity and forces: what is held rests, and the air does.
    bool is_left_alone(int lane) const {
        bool alone = step_.integrator == Integrator::backward_euler;
        for (int k = 0; k < 3; ++k) alone = alone && step_.wind[k] == 0.0;
        for (int i = 0; i < count(lane); ++i)
            for (int k = 0; k < 3; ++k)
                alone = alone && (space_.rows[i].free[lane] > 0 || space_.target[i][k][lane] == space_.start[i][k][lane]);
        return alone;
    }

    // A converged step loses energy; one that is not may gain some. The strand is slowed down to what it may have.
    void keep_energy(int lane, StrandReport &report) {
        const int begin = first(lane), n = count(lane);
        double most = start_energy_[lane] - report.stretch - report.bend - report.twist;
        for (int i = 0; i < n; ++i) {
            if (!(space_.rows[i].free[lane] > 0)) { // the report leaves out what is held at both ends
                const double length = i > 0 ? space_.shapes[i - 1].length[lane] : 0.0;
                if (i > 0)
                    most -=
                        stretch_energy(length, arrays_.rest_length[begin + i - 1], arrays_.stretch_stiffness[begin + i - 1]);
                continue;
            }
            for (int k = 0; k < 3; ++k) {
                const int at = 3 * (begin + i) + k;
                const double velocity = space_.velocity[i][k][lane], way = arrays_.positions[at] - space_.start[i][k][lane];
                most += 0.5 * arrays_.mass[begin + i] * velocity * velocity;
                most += (arrays_.mass[begin + i] * step_.gravity[k] + arrays_.forces[at]) * way;
            }
        }
        if (!(report.kinetic > most)) return;
        const double share = most > 0 ? most / report.kinetic : 0.0;
        for (int i = 3 * begin; i < 3 * (begin + n); ++i) arrays_.velocities[i] *= std::sqrt(share);
        report.kinetic *= share;
    }

    const StrandArrays &arrays_;
    const StrandStep &step_;
    StrandGroup group_;
    int vertices_;
    Workspace<Objective> space_;
    Objective objective_;
    Pack start_energy_{}; // elastic
    Pack part_{};         // ⅓ in lanes that take a step of BDF-2, else 0 (strand_objective.h)
};

} // namespace ringlet::RINGLET_SIMD
