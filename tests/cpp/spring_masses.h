// A third kind of block: point masses, each on a spring to its anchor. Masses that follow one another are joined by edges that
// can touch, but have no energy.
#pragma once

#include "ringlet/solver/newton.h"

#include <Eigen/LU>
#include <memory>
#include <vector>

namespace ringlet {

class SpringMasses : public Block {
public:
    SpringMasses(int object, int first, std::vector<Vec3> positions, double mass, double stiffness)
        : positions_(std::move(positions)), velocities_(positions_.size(), Vec3::Zero()), anchors_(positions_), mass_(mass),
          stiffness_(stiffness) {
        objects_ = {{object, first, first + int(positions_.size())}};
        rows_ = 3 * int(positions_.size());
        size_ = rows_;
    }

    const std::vector<Vec3> &positions() const { return positions_; }
    std::vector<Vec3> &velocities() { return velocities_; }
    std::vector<Vec3> &anchors() { return anchors_; }

    void begin_step(const BlockStep &step) override {
        dt_ = step.dt;
        inertial_ = positions_;
        for (size_t i = 0; i < inertial_.size(); ++i)
            inertial_[i] += step.dt * velocities_[i] + step.dt * step.dt * step.gravity;
    }
    void initial_guess(double *) const override {}
    void energies(const double *x, double *of_lanes) override {
        of_lanes[0] = 0.0;
        for (size_t i = 0; i < positions_.size(); ++i)
            of_lanes[0] += 0.5 * inertia() * (at(x, i) - inertial_[i]).squaredNorm() +
                           0.5 * stiffness_ * (at(x, i) - anchors_[i]).squaredNorm();
    }
    void assemble(const double *x, double *of_lanes) override {
        energies(x, of_lanes);
        gradient_.setZero(rows_);
        hessian_.setIdentity(rows_, rows_);
        hessian_ *= inertia() + stiffness_;
        for (size_t i = 0; i < positions_.size(); ++i)
            gradient_.segment<3>(3 * i) = inertia() * (at(x, i) - inertial_[i]) + stiffness_ * (at(x, i) - anchors_[i]);
    }
    const double *gradient() const override { return gradient_.data(); }
    void add_gradient(int vertex, const Vec3 &gradient) override { gradient_.segment<3>(row(vertex)) += gradient; }
    void add_block(int vertex, int other, const Mat3 &block) override {
        hessian_.block<3, 3>(row(vertex), row(other)) += block;
        if (vertex != other) hessian_.block<3, 3>(row(other), row(vertex)) += block.transpose();
    }
    void add_to(MatrixAssembly &matrix) const override {
        const int count = int(positions_.size()), stride = matrix.block(), first = objects_[0].first;
        for (int a = 0; a < count; ++a)
            for (int b = 0; b <= a; ++b) {
                double *block = matrix.add_block(first + a, first + b);
                for (int r = 0; r < 3; ++r)
                    for (int c = 0; c < 3; ++c) block[r * stride + c] = hessian_(3 * a + r, 3 * b + c);
            }
    }
    void factor() override { factor_.compute(hessian_); }
    void solve(double *b) const override {
        Eigen::Map<Eigen::VectorXd> all(b, rows_);
        all = factor_.solve(all).eval();
    }
    void contact_stiffness(double dt, std::vector<double> &of_vertices) const override {
        for (int v = objects_[0].first; v < objects_[0].end; ++v) of_vertices[v] = mass_ / (dt * dt) + stiffness_;
    }
    bool commit(const double *x, double dt, const SolverEffort &) override {
        for (size_t i = 0; i < positions_.size(); ++i) {
            velocities_[i] = (at(x, i) - positions_[i]) / dt;
            positions_[i] = at(x, i);
        }
        return true;
    }

private:
    double inertia() const { return mass_ / (dt_ * dt_); }
    int row(int vertex) const { return 3 * (vertex - objects_[0].first); }
    static Vec3 at(const double *x, size_t i) { return Vec3(x + 3 * i); }

    std::vector<Vec3> positions_, velocities_, anchors_, inertial_;
    double mass_, stiffness_, dt_ = 1.0;
    Eigen::VectorXd gradient_;
    Eigen::MatrixXd hessian_;
    Eigen::PartialPivLU<Eigen::MatrixXd> factor_;
};

// Spring masses and a triangle that does not move, in a solver of their own.
struct SpringScene {
    static constexpr double radius = 1e-3;

    VertexTable table;
    std::vector<std::unique_ptr<SpringMasses>> masses;
    std::vector<Vec3> positions;
    std::unique_ptr<BlockSet> blocks;
    std::unique_ptr<Objective> objective;
    std::unique_ptr<LinearSystem> system;
    std::unique_ptr<Configuration> configuration;
    std::unique_ptr<ContactStiffness> stiffness;

    void add_masses(std::vector<Vec3> at, double mass, double spring) {
        const int object = table.objects++, first = int(positions.size());
        table.mesh.objects.push_back({first, first + int(at.size())});
        for (size_t i = 0; i < at.size(); ++i) {
            add_vertex(at[i], object, true, mass);
            table.mesh.points.push_back(first + int(i));
            if (i > 0) table.mesh.edges.push_back({first + int(i) - 1, first + int(i)});
        }
        table.dynamic_vertices = int(positions.size());
        masses.push_back(std::make_unique<SpringMasses>(object, first, std::move(at), mass, spring));
    }

    void add_triangle(const Vec3 &a, const Vec3 &b, const Vec3 &c) { // after all masses
        const int first = int(positions.size());
        table.mesh.objects.push_back({first, first + 3});
        for (const Vec3 &at : {a, b, c}) add_vertex(at, table.objects, false, 0.0);
        table.mesh.triangles.push_back({first, first + 1, first + 2});
    }

    void finish(double friction = 0.0) {
        table.mesh.rest = positions;
        table.material.friction = {friction};
        table.material.stick_length = 1e-5;
        std::vector<Block *> all;
        for (const auto &block : masses) all.push_back(block.get());
        blocks = std::make_unique<BlockSet>(all, table);
        objective = std::make_unique<Objective>(*blocks, table);
        system = std::make_unique<LinearSystem>(*objective);
        configuration = std::make_unique<Configuration>(table, positions, radius);
        stiffness = std::make_unique<ContactStiffness>(table.count());
    }

    void begin(double dt, const Vec3 &gravity = Vec3::Zero()) {
        stiffness->begin_step(objective->contact_stiffness(1.0, dt), dt);
        table.material.stiffness = table.material.firm_stiffness = stiffness->largest();
        objective->begin_step({dt, gravity, Vec3::Zero(), configuration->positions, {}}, configuration->positions);
    }

    AlignedVector unknowns() const {
        AlignedVector x(blocks->size());
        blocks->scatter(configuration->positions, x);
        return x;
    }

    std::vector<unsigned char> all_objects() const { return std::vector<unsigned char>(table.objects, 1); }

    // The pairs that touch at the positions.
    std::vector<ContactPair> touching() {
        configuration->candidates.clear();
        return configuration->contact_pairs();
    }

    SolverEffort step(double dt, const Vec3 &gravity = Vec3::Zero(), int iterations = 50) {
        const std::vector<Vec3> start = configuration->positions;
        begin(dt, gravity);
        AlignedVector x = unknowns();
        Refinement refinement(*objective);
        SceneReport report{};
        Newton newton(table, *objective, *system, *configuration, *stiffness);
        const SolverEffort effort =
            newton.minimise(start, {.iterations = iterations, .tolerance = 1e-12, .linear = {}}, refinement, x, report);
        for (int b = 0; b < blocks->count(); ++b) (*blocks)[b].commit(blocks->of(b, x), dt, effort);
        return effort;
    }

private:
    void add_vertex(const Vec3 &at, int object, bool moves, double mass) {
        positions.push_back(at);
        table.mass.push_back(mass);
        table.mesh.radius.push_back(radius);
        table.mesh.moves.push_back(moves);
        table.mesh.object.push_back(object);
        table.mesh.anchor.push_back(-1);
        table.material.material.push_back(0);
    }
};

} // namespace ringlet
