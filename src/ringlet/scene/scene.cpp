#include "ringlet/scene/scene.h"

#include "ringlet/contact/impact.h"
#include "ringlet/scene/coupled_strands.h"
#include "ringlet/scene/embedded.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>

namespace ringlet {
namespace {

class Stopwatch {
public:
    explicit Stopwatch(double &sum) : sum_(sum), start_(std::chrono::steady_clock::now()) {}
    ~Stopwatch() { sum_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

private:
    double &sum_;
    std::chrono::steady_clock::time_point start_;
};

// The affine motion of a triangle, its unit normal included: a rigid motion where the triangle moves rigidly.
Vec3 carried_by_triangle(const Vec3 from[3], const Vec3 to[3], const Vec3 &point) {
    const auto frame = [](const Vec3 t[3]) {
        Mat3 axes;
        axes << t[1] - t[0], t[2] - t[0], (t[1] - t[0]).cross(t[2] - t[0]).normalized();
        return axes;
    };
    const Mat3 before = frame(from);
    Vec3 translated = point + to[0] - from[0];
    if (std::abs(before.determinant()) < 1e-30) return translated;
    const Vec3 carried = to[0] + frame(to) * before.inverse() * (point - from[0]);
    return carried.allFinite() ? carried : translated;
}

} // namespace

struct Scene::Parts {
    const StrandModel &model;
    StrandState &state;
    SceneContact settings;
    int strand_vertices;
    CoupledStrands strands;
    CollisionMesh mesh;
    ContactMaterial material;
    std::unique_ptr<BroadPhase> broad_phase;
    std::vector<int> strand_of;          // per vertex; −1: of a body
    std::vector<Triangle> some_triangle; // per vertex: one that moves rigidly with it, if it is kinematic
    std::vector<double> mass;            // per vertex
    std::vector<int> body_begin;         // first vertex of each body, and the end
    std::vector<int> root_body;          // per strand; −1: none
    std::vector<int> rigid;              // per vertex: the body that it goes along with as one in this step; −1: none
    std::vector<Vec3> positions;         // of all vertices

    std::vector<Embedded::Body> embedded_bodies; // per body
    Embedded embedded;
    bool recording = false, begun = false;
    std::vector<std::vector<Vec3>> path;

    // Within a step
    Candidates candidates;
    ContactSet contacts;
    std::vector<ContactValue> values; // of the contacts
    std::vector<std::array<Vec3, 2>> pushes;
    std::vector<unsigned char> coupled;  // per group: something couples it to another
    std::vector<unsigned char> together; // per strand: something that moves touches it
    AlignedVector x, trial, direction, residual, solved, searched, image;

    Parts(const StrandModel &model_, StrandState &state_, const std::vector<BodyModel> &bodies,
          const std::vector<int> &rooted_in, const SceneContact &contact)
        : model(model_), state(state_), settings(contact), strand_vertices(model.vertex_count()), strands(model) {
        collect(bodies, rooted_in);
        broad_phase = std::make_unique<BroadPhase>(mesh);
    }

    void collect(const std::vector<BodyModel> &bodies, const std::vector<int> &rooted_in);
    SceneReport step(View<Vec3> strand_targets, View<Vec3> strand_forces, View<Vec3> body_targets, const SceneStep &step,
                     std::vector<StrandReport> &reports);
    double advance(View<Vec3> strand_targets, View<Vec3> strand_forces, View<Vec3> body_targets, const SceneStep &scene_step,
                   StrandStep &step, SceneReport &report, std::vector<StrandReport> &reports);

    void carry_rigidly(std::vector<Vec3> &to);
    void resize();
    bool is_coupled(int group) const { return coupled[group]; }
    Vec3 position(const AlignedVector &at, int v) const {
        if (strand_of[v] < 0) return positions_end[v];
        const size_t slot = strands.slot(v), stride = strands.stride();
        return {at[slot], at[slot + stride], at[slot + 2 * stride]};
    }
    void gather(const AlignedVector &at, std::vector<Vec3> &into) const {
#pragma omp parallel for schedule(static)
        for (int v = 0; v < strand_vertices; ++v) into[v] = position(at, v);
    }
    Vec3 separation_at(const Contact &c, const AlignedVector &at) const {
        Vec3 sum = Vec3::Zero();
        for (int i = 0; i < 4; ++i)
            if (c.weight[i] != 0.0) sum += c.weight[i] * position(at, c.vertex[i]);
        return sum;
    }

    void set_stiffness(double dt);
    double move(std::vector<Vec3> &now, std::vector<Vec3> &to, bool still, SceneReport &report);
    void find_contacts(View<Vec3> now, SceneReport &report);
    void scatter(View<Vec3> from, AlignedVector &into) const;
    double energies(const AlignedVector &at, const std::vector<unsigned char> &groups, std::vector<double> &of_strands);
    void assemble();
    void couple(const AlignedVector &p, AlignedVector &q);
    void solve(const SceneStep &step, SceneReport &report);
    bool search(SceneReport &report, double tolerance, double &moved);
    Vec3 carried(int vertex, const Vec3 &point) const;

    template <class Work> void for_groups(bool coupled_only, const Work &work) const {
#pragma omp parallel for schedule(dynamic)
        for (int g = 0; g < strands.group_count(); ++g)
            if (!coupled_only || coupled[g]) work(g);
    }
    // Σ over groups of what `of` says, in a fixed order.
    template <class Of> double sum(bool coupled_only, const Of &of) const {
        std::vector<double> parts(strands.group_count(), 0.0);
        for_groups(coupled_only, [&](int g) { parts[g] = of(g); });
        return std::accumulate(parts.begin(), parts.end(), 0.0);
    }
    double dot(int group, const AlignedVector &a, const AlignedVector &b) const {
        double value = 0.0;
        for (size_t i = strands.group_begin(group); i < strands.group_end(group); ++i) value += a[i] * b[i];
        return value;
    }

    std::vector<Vec3> positions_end; // of bodies and held vertices in this step
    std::vector<double> group_energy;
};

void Scene::Parts::collect(const std::vector<BodyModel> &bodies, const std::vector<int> &rooted_in) {
    const auto add_vertex = [&](const Vec3 &now, const Vec3 &rest, double radius, bool moves, int object, int anchor,
                                double weight, int of_material, int strand) {
        positions.push_back(now);
        mesh.rest.push_back(rest);
        mesh.radius.push_back(radius);
        mesh.moves.push_back(moves);
        mesh.object.push_back(object);
        mesh.anchor.push_back(anchor);
        mass.push_back(weight);
        material.material.push_back(of_material);
        strand_of.push_back(strand);
    };
    const int strand_count = model.strand_count();
    for (int s = 0; s < strand_count; ++s) {
        const int first = model.offsets[s];
        int held = 0;
        while (first + held < model.offsets[s + 1] && model.held[first + held]) ++held;
        for (int v = first; v < model.offsets[s + 1]; ++v) {
            const int body = s < int(rooted_in.size()) ? rooted_in[s] : -1;
            add_vertex(state.positions[v], state.positions[v], settings.strand_radius, !model.held[v], s,
                       model.held[v] && body >= 0 ? strand_count + body : -1, model.mass[v], settings.strand_material, s);
            some_triangle.push_back(held >= 3 ? Triangle(first, first + 1, first + 2) : Triangle(v, v, v));
            mesh.points.push_back(v);
            if (v > first) mesh.edges.push_back({v - 1, v});
        }
    }
    // Only the shape matters of what is taken for rest here: distances within an object.
    for (int b = 0; b < int(bodies.size()); ++b) {
        const int base = int(positions.size());
        body_begin.push_back(base);
        embedded_bodies.push_back({base, int(bodies[b].rest.size()), strand_count + b, bodies[b].triangles});
        for (const Vec3 &rest : bodies[b].rest) {
            add_vertex(rest, rest, bodies[b].thickness, false, strand_count + b, -1, 0.0, bodies[b].material, -1);
            some_triangle.emplace_back(0, 0, 0);
        }
        std::set<std::array<int, 2>> edges;
        for (const Triangle &t : bodies[b].triangles) {
            const Triangle moved = t + Triangle::Constant(base);
            mesh.triangles.push_back({moved[0], moved[1], moved[2]});
            for (int k = 0; k < 3; ++k) {
                some_triangle[moved[k]] = moved;
                edges.insert({std::min(moved[k], moved[(k + 1) % 3]), std::max(moved[k], moved[(k + 1) % 3])});
            }
        }
        mesh.edges.insert(mesh.edges.end(), edges.begin(), edges.end());
    }
    body_begin.push_back(int(positions.size()));
    root_body = rooted_in;
    positions_end = positions;
    material.materials = int(std::lround(std::sqrt(double(settings.friction.size()))));
    if (material.materials * material.materials != int(settings.friction.size()))
        throw std::invalid_argument("scene: friction must have a row and a column for each material");
    material.friction = settings.friction;
}

void Scene::Parts::set_stiffness(double dt) {
    material.stiffness.assign(positions.size(), std::numeric_limits<double>::infinity());
    material.creep = settings.creep_speed * dt;
    for (int v = 0; v < strand_vertices; ++v) {
        if (model.held[v]) continue;
        const double length = std::max(model.rest_length[v], model.rest_length[v - 1]);
        const double bend = std::max(model.bend_stiffness[v], model.bend_stiffness[v - 1]) / (length * length);
        material.stiffness[v] = settings.stiffness * (model.mass[v] / (dt * dt) + bend + 0.1 * model.stretch_stiffness[v - 1]);
    }
}

void Scene::Parts::resize() {
    const size_t size = strands.size();
    if (x.size() == size) return;
    for (AlignedVector *vector : {&x, &trial, &direction, &residual, &solved, &searched, &image}) *vector = AlignedVector(size);
}

void Scene::Parts::scatter(View<Vec3> from, AlignedVector &into) const {
#pragma omp parallel for schedule(static)
    for (int v = 0; v < strand_vertices; ++v)
        for (int k = 0; k < 3; ++k) into[strands.slot(v) + k * strands.stride()] = from[v][k];
}

// Everything goes from `now` to `to`, or as near as nothing passes through anything; says what part of the way that is.
double Scene::Parts::move(std::vector<Vec3> &now, std::vector<Vec3> &to, bool still, SceneReport &report) {
    const Stopwatch watch(report.time_filter);
    const FilterScene scene{mesh,
                            mass,
                            View<int>(model.offsets),
                            [this](int vertex, const Vec3 &point) { return carried(vertex, point); },
                            still ? View<int>() : View<int>(rigid),
                            still};
    const bool as_one = !still && !rigid.empty() && rigid[0] >= 0 &&
                        std::all_of(rigid.begin(), rigid.end(), [&](int body) { return body == rigid[0]; });
    const FilterReport filtered = as_one ? FilterReport{} : filter_step(scene, *broad_phase, now, to, candidates);
    report.candidates = filtered.candidates;
    report.violations += filtered.violations;
    report.zone_vertices += filtered.zone_vertices;
    now = to;
    if (recording) path.push_back(now);
    return filtered.fraction;
}

void Scene::Parts::find_contacts(View<Vec3> now, SceneReport &report) {
    const Stopwatch watch(report.time_pairs);
    contacts.find(mesh, material, candidates, positions, now);
    values.resize(contacts.contacts().size());
    pushes.resize(values.size());
    coupled.assign(strands.group_count(), 0);
    together.assign(model.strand_count(), 0);
    for (const Contact &c : contacts.contacts()) {
        const int a = strand_of[c.vertex[0]], b = strand_of[c.vertex[3]];
        if (a < 0 || b < 0) continue;
        coupled[strands.group_of(a)] = coupled[strands.group_of(b)] = 1;
        together[a] = together[b] = 1;
    }
}

// Energies of strands, each with its share of those of the contacts; `groups` says which groups to ask again.
double Scene::Parts::energies(const AlignedVector &at, const std::vector<unsigned char> &groups, std::vector<double> &of) {
    for_groups(false, [&](int g) {
        if (!groups[g]) return;
        double energy[16];
        strands.evaluate(g, at, energy);
        const StrandGroup group = strands.strands_of(g);
        for (int lane = 0; lane < group.count; ++lane) group_energy[group.strands[lane]] = energy[lane];
    });
    of = group_energy;
    const std::vector<Contact> &all = contacts.contacts();
    std::vector<double> energy(all.size());
#pragma omp parallel for schedule(static)
    for (int c = 0; c < int(all.size()); ++c) energy[c] = contact_energy(all[c], separation_at(all[c], at));
    for (int c = 0; c < int(all.size()); ++c) {
        const int a = strand_of[all[c].vertex[0]], b = strand_of[all[c].vertex[3]];
        if (a >= 0) of[a] += b >= 0 ? 0.5 * energy[c] : energy[c];
        if (b >= 0) of[b] += a >= 0 ? 0.5 * energy[c] : energy[c];
    }
    return std::accumulate(of.begin(), of.end(), 0.0);
}

// The gradient and the matrix of every group at x; what contacts do to each side alone is added to them.
void Scene::Parts::assemble() {
    for_groups(false, [&](int g) { strands.assemble(g); });
    const std::vector<Contact> &all = contacts.contacts();
#pragma omp parallel for schedule(static)
    for (int c = 0; c < int(all.size()); ++c) values[c] = contact_value(all[c], separation_at(all[c], x));
    const std::vector<int> &touched = contacts.vertices();
#pragma omp parallel for schedule(static)
    for (int k = 0; k < int(touched.size()); ++k) {
        const int v = touched[k], strand = strand_of[v], group = strands.group_of(strand);
        Vec3 force = Vec3::Zero();
        Mat3 diagonal = Mat3::Zero(), next = Mat3::Zero();
        for (const ContactSet::Role &role : contacts.of(v)) {
            const Contact &c = all[role.contact];
            const ContactValue &value = values[role.contact];
            force += c.weight[role.as] * value.gradient;
            diagonal += c.weight[role.as] * c.weight[role.as] * value.hessian;
            const int other = role.as ^ 1; // of the same edge
            if (c.of_edges() && c.vertex[other] == v + 1 && mesh.moves[v + 1])
                next += c.weight[role.as] * c.weight[other] * value.hessian;
        }
        const StrandGroupSystem &system = strands.system(group);
        const size_t slot = strands.slot(v) - strands.group_begin(group);
        for (int i = 0; i < 3; ++i) system.gradient[slot + i * strands.stride()] += force[i];
        strands.add_block(strand, v, v, diagonal);
        if (v + 1 < model.offsets[strand + 1] && mesh.moves[v + 1]) strands.add_block(strand, v + 1, v, next);
    }
}

// q += C p: what contacts do from one side to the other.
void Scene::Parts::couple(const AlignedVector &p, AlignedVector &q) {
    const std::vector<Contact> &all = contacts.contacts();
#pragma omp parallel for schedule(static)
    for (int c = 0; c < int(all.size()); ++c) {
        Vec3 side[2] = {Vec3::Zero(), Vec3::Zero()};
        for (int i = 0; i < 4; ++i)
            if (mesh.moves[all[c].vertex[i]]) side[i >= all[c].first] += all[c].weight[i] * position(p, all[c].vertex[i]);
        pushes[c] = {values[c].hessian * side[1], values[c].hessian * side[0]};
    }
    const std::vector<int> &touched = contacts.vertices();
#pragma omp parallel for schedule(static)
    for (int k = 0; k < int(touched.size()); ++k) {
        Vec3 force = Vec3::Zero();
        for (const ContactSet::Role &role : contacts.of(touched[k])) {
            const Contact &c = all[role.contact];
            force += c.weight[role.as] * pushes[role.contact][role.as >= c.first];
        }
        const size_t slot = strands.slot(touched[k]), stride = strands.stride();
        for (int i = 0; i < 3; ++i) q[slot + i * stride] += force[i];
    }
}

// A = P + C: P the strands' own matrices with what contacts do to each side alone, which is factored exactly; C what they do
// from side to side. Conjugate gradients preconditioned by P; P p follows from P z = r by the same recursion as p from z, so
// that no product with P is ever formed.
void Scene::Parts::solve(const SceneStep &step, SceneReport &report) {
    const Stopwatch watch(report.time_solve);
    const auto each = [&](int g, const auto &work) {
        for (size_t i = strands.group_begin(g); i < strands.group_end(g); ++i) work(i);
    };
    for_groups(false, [&](int g) {
        strands.factor(g);
        const StrandGroupSystem &system = strands.system(g);
        const size_t unknowns = size_t(system.freedoms) * system.vertices * system.lanes, begin = strands.group_begin(g);
        each(g, [&](size_t i) { residual[i] = i - begin < unknowns ? -system.gradient[i - begin] : 0.0; });
        each(g, [&](size_t i) { solved[i] = residual[i]; });
        strands.solve(g, solved);
        each(g, [&](size_t i) { direction[i] = coupled[g] ? 0.0 : solved[i]; });
        if (coupled[g]) each(g, [&](size_t i) { searched[i] = solved[i], image[i] = residual[i]; });
    });
    double rho = sum(true, [&](int g) { return dot(g, residual, solved); });
    const double enough = step.system_tolerance * step.system_tolerance * rho;
    constexpr int most = 2000;
    int iteration = 0;
    for (; rho > enough && iteration < most; ++iteration) {
        for_groups(true, [&](int g) { each(g, [&](size_t i) { trial[i] = image[i]; }); });
        couple(searched, trial);
        const double curvature = sum(true, [&](int g) { return dot(g, searched, trial); });
        if (!(curvature > 0.0)) break;
        const double alpha = rho / curvature;
        const double next = sum(true, [&](int g) {
            each(g, [&](size_t i) {
                direction[i] += alpha * searched[i];
                residual[i] -= alpha * trial[i];
                solved[i] = residual[i];
            });
            strands.solve(g, solved);
            return dot(g, residual, solved);
        });
        const double beta = next / rho;
        rho = next;
        for_groups(true, [&](int g) {
            each(g, [&](size_t i) {
                searched[i] = solved[i] + beta * searched[i];
                image[i] = residual[i] + beta * image[i];
            });
        });
    }
    report.linear_iterations += iteration;
    report.linear_residual = enough > 0.0 ? step.system_tolerance * std::sqrt(std::max(rho, 0.0) / enough) : 0.0;
}

// Goes along the direction, every strand as far as is good for it. One that touches nothing that moves goes half as far until
// its energy falls as it should. The energies of those that touch, contacts shared out evenly, need only fall in sum; where
// they do not, those whose own rises go half as far.
bool Scene::Parts::search(SceneReport &report, double tolerance, double &moved) {
    const Stopwatch watch(report.time_search);
    constexpr double least_decrease = 1e-4, rounding = 1e-13;
    constexpr int most_cuts = 20;
    const int count = model.strand_count();
    std::vector<double> step(count, 1.0), slope(count, 0.0), now, before;
    std::vector<unsigned char> changed(strands.group_count(), 0);
    energies(x, changed, before); // groups were evaluated at x already
    std::vector<double> largest(strands.group_count(), 0.0);
    for_groups(false, [&](int g) {
        const StrandGroupSystem &system = strands.system(g);
        const size_t begin = strands.group_begin(g);
        const int rows = system.freedoms * system.vertices;
        for (int lane = 0; lane < strands.strands_of(g).count; ++lane) {
            double sum = 0.0;
            for (int i = 0; i < rows; ++i) {
                const double d = direction[begin + size_t(i) * system.lanes + lane];
                sum += system.gradient[size_t(i) * system.lanes + lane] * d;
                largest[g] = std::max(largest[g], std::abs(d));
            }
            slope[strands.strands_of(g).strands[lane]] = sum;
            if (std::isfinite(sum)) continue; // a system too ill-conditioned to solve: the strand stays
            slope[strands.strands_of(g).strands[lane]] = 0.0;
            for (int i = 0; i < rows; ++i) direction[begin + size_t(i) * system.lanes + lane] = 0.0;
        }
    });
    moved = *std::max_element(largest.begin(), largest.end());
    changed.assign(strands.group_count(), 1);
    for (int cut = 0; cut <= most_cuts; ++cut) {
        for_groups(false, [&](int g) {
            if (!changed[g]) return;
            const StrandGroupSystem &system = strands.system(g);
            const size_t begin = strands.group_begin(g);
            double part[16] = {};
            for (int lane = 0; lane < strands.strands_of(g).count; ++lane)
                part[lane] = step[strands.strands_of(g).strands[lane]];
            for (size_t i = begin; i < strands.group_end(g); i += system.lanes)
                for (int lane = 0; lane < system.lanes; ++lane)
                    trial[i + lane] = x[i + lane] + part[lane] * direction[i + lane];
        });
        energies(trial, changed, now);
        const auto allowed = [&](int strand) { // of the energy, were it alone
            return before[strand] + least_decrease * step[strand] * slope[strand] + rounding * std::abs(before[strand]);
        };
        double sum = 0.0, bound = 0.0;
        for (int s = 0; s < count; ++s)
            if (together[s]) sum += now[s], bound += allowed(s);
        const bool sum_falls = sum <= bound, near = cut == 0 && moved <= tolerance;
        std::fill(changed.begin(), changed.end(), 0);
        bool any = false, any_together = false;
        const auto halve = [&](int strand) {
            step[strand] *= cut < 12 ? 0.5 : 0.0;
            changed[strands.group_of(strand)] = any = true;
            ++report.cuts;
        };
        for (int s = 0; s < count && !near; ++s)
            if (step[s] > 0.0 && !(together[s] && sum_falls) && !(now[s] <= allowed(s))) {
                any_together |= bool(together[s]);
                halve(s);
            }
        if (!sum_falls && !near && !any_together)
            for (int s = 0; s < count; ++s)
                if (together[s] && step[s] > 0.0) halve(s);
        if (!any) {
            std::swap(x, trial);
            return true;
        }
    }
    changed.assign(strands.group_count(), 1);
    energies(x, changed, now);
    return false;
}

Vec3 Scene::Parts::carried(int vertex, const Vec3 &point) const {
    const Triangle &t = some_triangle[vertex];
    if (t[0] == t[1]) return point + positions_end[vertex] - positions[vertex];
    const Vec3 from[3] = {positions[t[0]], positions[t[1]], positions[t[2]]};
    const Vec3 to[3] = {positions_end[t[0]], positions_end[t[1]], positions_end[t[2]]};
    return carried_by_triangle(from, to, point);
}

// Where everything is once it has gone along with what is kinematic, and what of it goes as one.
void Scene::Parts::carry_rigidly(std::vector<Vec3> &to) {
    rigid.assign(positions.size(), -1);
    std::vector<int> first_of(body_begin.size(),
                              -1); // per body: a vertex whose triangle says how all of it moves, if it is rigid
    for (int b = 0; b + 1 < int(body_begin.size()); ++b) {
        const int first = body_begin[b];
        bool is_rigid = first < body_begin[b + 1];
        for (int v = first; is_rigid && v < body_begin[b + 1]; ++v)
            is_rigid = (carried(first, positions[v]) - positions_end[v]).squaredNorm() < 1e-20;
        if (!is_rigid) continue;
        first_of[b] = first;
        std::fill(rigid.begin() + first, rigid.begin() + body_begin[b + 1], b);
    }
#pragma omp parallel for schedule(static)
    for (int s = 0; s < model.strand_count(); ++s) {
        const int begin = model.offsets[s], end = model.offsets[s + 1];
        const int body = s < int(root_body.size()) ? root_body[s] : -1;
        bool with_body = body >= 0 && first_of[body] >= 0;
        for (int v = begin; v < end && with_body; ++v)
            with_body = !model.held[v] || (carried(first_of[body], positions[v]) - positions_end[v]).squaredNorm() < 1e-20;
        for (int v = begin; v < end; ++v) {
            if (!model.held[v]) to[v] = carried(with_body ? first_of[body] : begin, positions[v]);
            if (with_body) rigid[v] = body;
        }
    }
}

// One step as far as it goes; says what part of it that was.
double Scene::Parts::advance(View<Vec3> strand_targets, View<Vec3> strand_forces, View<Vec3> body_targets,
                             const SceneStep &scene_step, StrandStep &step, SceneReport &report,
                             std::vector<StrandReport> &reports) {
    set_stiffness(step.dt);
    const StrandArrays arrays = arrays_of(model, state, strand_targets, strand_forces);
    {
        const Stopwatch watch(report.time_assemble);
        strands.begin(arrays, step);
        resize();
        for_groups(false, [&](int g) {
            const StrandGroupSystem &system = strands.system(g);
            std::copy(system.x, system.x + size_t(system.freedoms) * system.vertices * system.lanes,
                      x.data() + strands.group_begin(g));
        });
    }
    for (int v = 0; v < strand_vertices; ++v) positions_end[v] = model.held[v] ? strand_targets[v] : positions[v];
    std::copy(body_targets.begin(), body_targets.end(), positions_end.begin() + strand_vertices);
    // First everything goes along with what is kinematic, every strand rigidly with its root: of one rigid body and all that is
    // rooted in it, nothing meets. What is kinematic has arrived then, and staying is always safe.
    std::vector<Vec3> now = positions, to = positions_end;
    carry_rigidly(to);
    const double fraction = move(now, to, false, report);
    if (fraction < 1.0) {
        for (int v = 0; v < int(now.size()); ++v)
            if (!mesh.moves[v]) positions_end[v] = now[v];
        step.dt *= fraction;
    }
    // Then to where Newton's method begins.
    to = now;
    gather(x, to);
    for (int v = 0; v < strand_vertices; ++v)
        if (model.held[v]) to[v] = now[v];
    move(now, to, true, report);
    scatter(now, x);

    group_energy.assign(model.strand_count(), 0.0);
    std::vector<unsigned char> every(strands.group_count(), 1);
    std::vector<double> unused;
    double moved = 0.0;
    int iteration = 0;
    bool arrived = false;
    for (; iteration < step.newton && !arrived; ++iteration) {
        find_contacts(now, report);
        {
            const Stopwatch watch(report.time_assemble);
            energies(x, every, unused);
            assemble();
        }
        solve(scene_step, report);
        if (!search(report, step.tolerance, moved)) break;
        arrived = moved <= step.tolerance;
        gather(x, to);
        move(now, to, true, report);
        scatter(now, x);
    }
    report.newton += iteration;
    report.residual = moved;
    report.unconverged = moved > step.tolerance;
    report.contacts = double(contacts.contacts().size());
    strands.end(x, {double(iteration), report.cuts, moved}, reports);
    positions = std::move(now);
    return fraction;
}

SceneReport Scene::Parts::step(View<Vec3> strand_targets, View<Vec3> strand_forces, View<Vec3> body_targets,
                               const SceneStep &scene_step, std::vector<StrandReport> &reports) {
    const size_t bodies = positions.size() - strand_vertices;
    if (strand_targets.size() != size_t(strand_vertices) || strand_forces.size() != size_t(strand_vertices))
        throw std::invalid_argument("scene: targets and forces do not fit the strands");
    if (body_targets.size() != bodies) throw std::invalid_argument("scene: targets do not fit the bodies");
    reports.assign(model.strand_count(), StrandReport{});
    SceneReport report;
    std::copy(state.positions.begin(), state.positions.end(), positions.begin()); // they may have been placed since
    if (!begun) {
        broad_phase->find(positions, positions, 0.0, candidates);
        contacts.begin(mesh, candidates, positions);
        begun = true;
    }
    constexpr double parting = 0.002; // [m/s]
    contacts.part_early(parting * scene_step.strands.dt);
    path.clear();
    if (recording) path.push_back(positions);
    std::vector<Vec3> forces(strand_forces.begin(), strand_forces.end());
    if (embedded.count() > 0) {
        constexpr double speed = 0.02; // [m/s]
        set_stiffness(scene_step.strands.dt);
        embedded.push_out(mesh, positions, View<int>(model.offsets), material.stiffness, speed * scene_step.strands.dt, forces);
    }
    double left = 1.0;
    for (int part = 0; part < scene_step.most_substeps && left > 1e-9; ++part) {
        StrandStep step = scene_step.strands;
        step.dt *= left;
        const double fraction = advance(strand_targets, forces, body_targets, scene_step, step, report, reports);
        left = fraction < 1.0 ? left * (1.0 - fraction) : 0.0;
        ++report.substeps;
    }
    report.fraction = 1.0 - left;
    report.closest = std::numeric_limits<double>::infinity();
    for (const Contact &c : contacts.contacts()) report.closest = std::min(report.closest, separation(c, positions).norm());
    return report;
}

Scene::Scene(const StrandModel &model, StrandState &state, const std::vector<BodyModel> &bodies,
             const std::vector<int> &rooted_in, const SceneContact &contact)
    : parts_(std::make_unique<Parts>(model, state, bodies, rooted_in, contact)) {}

Scene::~Scene() = default;

SceneReport Scene::step(View<Vec3> strand_targets, View<Vec3> strand_forces, View<Vec3> body_targets, const SceneStep &step,
                        std::vector<StrandReport> &reports) {
    return parts_->step(strand_targets, strand_forces, body_targets, step, reports);
}

void Scene::excuse(int vertex, int body) {
    if (vertex < 0 || vertex >= parts_->strand_vertices)
        throw std::invalid_argument("scene: only vertices of strands are excused");
    if (body < 0 || body >= int(parts_->embedded_bodies.size())) throw std::invalid_argument("scene: there is no such body");
    parts_->embedded.add(vertex, parts_->embedded_bodies[body], parts_->mesh);
}

int Scene::excused() const { return parts_->embedded.count(); }

void Scene::record(bool on) { parts_->recording = on; }

const std::vector<std::vector<Vec3>> &Scene::path() const { return parts_->path; }

View<Vec3> Scene::positions() const { return parts_->positions; }
const std::vector<Contact> &Scene::contacts() const { return parts_->contacts.contacts(); }

} // namespace ringlet
