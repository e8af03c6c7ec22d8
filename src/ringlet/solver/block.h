// A block of the system: unknowns with an energy of their own, such as a group of strands in lanes or a cloth.
#pragma once

#include "ringlet/contact/contact_set.h"
#include "ringlet/math/types.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <vector>

namespace ringlet {

// What moves a block in a step. Rows of targets and forces are those of all vertices of the scene.
struct BlockStep {
    double dt;          // [s]
    Vec3 gravity, wind; // [m/s²], [m/s]
    View<Vec3> targets; // where prescribed and attached vertices end [m]
    View<Vec3> forces;  // external forces [N]
};

// What the solution of a step took.
struct SolverEffort {
    double iterations = 0, cuts = 0; // of Newton's method; of the step length
    double residual = 0;             // largest coordinate of the last search direction [m]
    bool converged = true;
    std::vector<unsigned char> stalled; // per object: not at rest in the step, and yet not moved
};

// A system of a block that is independent but for contacts: a strand, a cloth. It has an energy and a step length of its own.
struct BlockObject {
    int number;     // in the scene
    int first, end; // its vertices in the scene
};

// One object's Hessian, to be added to a matrix of all vertices: rows and columns are vertices, values row-major.
class MatrixAssembly {
public:
    virtual ~MatrixAssembly() = default;
    virtual int block() const = 0;                      // rows of a vertex
    virtual double *add_block(int row, int column) = 0; // of zeros; of the lower triangle only
};

// Unknown r of the object in lane l stands at [r · lanes + l] of the block's vectors. The degrees of freedom of a vertex follow
// one another; the first three are its position.
class Block {
public:
    virtual ~Block() = default;

    int lanes() const { return lanes_; }
    int dofs() const { return dofs_; }
    int rows() const { return rows_; } // unknowns of a lane
    size_t unknowns() const { return size_t(rows_) * lanes_; }
    size_t size() const { return size_; } // doubles of a vector: the unknowns and the padding that solve() needs
    const std::vector<BlockObject> &objects() const { return objects_; } // by lane; the last lanes may be empty

    // Opens a step from the present state. Sets the layout above.
    virtual void begin_step(const BlockStep &step) = 0;

    // Replaces x, the advected positions, by a better initial guess where there is one.
    virtual void initial_guess(double *x) const = 0;

    // Energies of the objects at x, a lane each [J]; assemble() also sets gradient and Hessian.
    virtual void energies(const double *x, double *of_lanes) = 0;
    virtual void assemble(const double *x, double *of_lanes) = 0;
    virtual const double *gradient() const = 0; // of all unknowns

    // Add forces from outside to what is assembled: to the gradient at a vertex; to the Hessian a block of one vertex, or of
    // two that share an edge or a triangle, row ≥ column.
    virtual void add_gradient(int vertex, const Vec3 &gradient) = 0;
    virtual void add_block(int row, int column, const Mat3 &block) = 0;

    virtual void add_to(MatrixAssembly &matrix) const = 0; // the Hessian, before it is factored

    // Factors the Hessian; then b becomes its solution, up to an error where the factor is incomplete.
    virtual void factor() = 0;
    virtual void solve(double *b) const = 0;
    virtual bool is_exact() const { return true; }
    virtual void multiply_add(const double *, double *) const { // q += A p: (p, q)
        throw std::logic_error("block: one whose factor is not exact has to multiply");
    }

    // Largest fractions of the search direction from x that the linearisation is good for, a lane each: (x, direction,
    // of_lanes).
    virtual void max_step(const double *, const double *, double *of_lanes) const {
        std::fill_n(of_lanes, objects_.size(), 1.0);
    }

    // Sets the bend of a path, so that at x + straight + bend edges have turned rather than stretched: (x, straight, bend).
    virtual void bend(const double *, const double *, double *bend) const { std::fill_n(bend, unknowns(), 0.0); }

    // Sets how hard each free vertex resists a contact in a step of dt [N/m]; rows are those of the scene's vertices.
    virtual void contact_stiffness(double dt, std::vector<double> &of_vertices) const = 0;

    // Whether a lane's object is stretched so far that it needs more iterations, and the distance that it settles to [m].
    virtual bool is_stretched(int, View<Vec3>) const { return false; }
    virtual double settled_distance(int) const { return std::numeric_limits<double>::infinity(); }

    virtual bool is_parallel() const { return false; } // in itself: large, one at a time

    // Accepts x as the end of a step of dt. Where an object's x is not finite it keeps its last state, at rest; then returns
    // false.
    virtual bool commit(const double *x, double dt, const SolverEffort &effort) = 0;

protected:
    std::vector<BlockObject> objects_;
    int lanes_ = 1, dofs_ = 3, rows_ = 0;
    size_t size_ = 0;
};

} // namespace ringlet
