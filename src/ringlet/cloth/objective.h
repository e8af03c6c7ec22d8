// What a time step of cloth minimises: Σ ½ aᵢ ‖xᵢ − yᵢ‖² (inertia, gravity, mass damping, drag, attachments) + membrane +
// hinges, with the vertices that are held left out. Damping of strains needs no term of its own: with b = β/dt, ½ k (s − s̄)² +
// ½ b k (s − sₙ)² = ½ k (1 + b) (s − (s̄ + b sₙ)/(1 + b))² + constant.
#pragma once

#include "ringlet/cloth/model.h"
#include "ringlet/linear/block_matrix.h"

namespace ringlet {

struct ClothForces {
    double dt = 1.0 / 24;        // [s]
    Vec3 gravity = Vec3::Zero(); // [m/s²]
    Vec3 wind = Vec3::Zero();    // [m/s]
    View<Vec3> targets;          // where held and attached vertices are at the end of the step [m]
    View<Vec3> forces;           // what pulls at each vertex besides [N]; may be empty
};

// Elastic energy of a shape [J], without damping.
struct ClothEnergies {
    double stretch = 0, bend = 0;
    double max_stretch = 0; // largest | ‖F‖ − 1 | along warp or weft
};

class ClothObjective {
public:
    explicit ClothObjective(const ClothModel &model);

    // A matrix with the pattern of the Hessian, all zero: a copy of it is what `assemble` fills.
    const BlockMatrix &pattern() const { return pattern_; }

    // From now on `assemble` fills a matrix with this pattern, of which the cloth is a part: its vertex 0 is the row `first`.
    void use_pattern(const BlockMatrix &matrix, int first);

    // The step from this state: sets what the energy below is about.
    void begin(const ClothState &state, const ClothForces &forces);

    double energy(View<Vec3> positions) const;

    // Sets the gradient [N] of the cloth's vertices and adds the Hessian to the matrix. Held vertices have no gradient, and the
    // unit matrix is their diagonal block.
    void assemble(View<Vec3> positions, std::span<Vec3> gradient, BlockMatrix &hessian);

    ClothEnergies energies(View<Vec3> positions) const;
    const ClothModel &model() const { return *model_; }

private:
    // Element e has the vertex as its corner c.
    struct Incidence {
        int element, corner;
    };
    struct Incidences {
        std::vector<int> starts;
        std::vector<Incidence> list;
    };
    struct HingeTerms {
        Vec3 gradient[4];
        double moment, stiffness;
    };

    void measure(View<Vec3> positions);
    void gather(int vertex, View<Vec3> positions, Vec3 &gradient, BlockMatrix &hessian) const;
    MembraneShape shape(int triangle, View<Vec3> positions) const;
    double angle(int hinge, View<Vec3> positions) const;
    double free(int vertex) const { return model_->held[vertex] ? 0.0 : 1.0; }

    const ClothModel *model_;
    BlockMatrix pattern_;
    Incidences triangles_of_, hinges_of_;
    std::vector<std::array<int, 9>> triangle_slots_; // of the blocks (corner, corner)
    std::vector<std::array<int, 16>> hinge_slots_;
    std::vector<int> diagonals_;

    std::vector<double> inertia_;             // aᵢ [N/m]
    std::vector<Vec3> inertial_;              // yᵢ [m]
    double stiffer_ = 1;                      // 1 + b
    std::vector<MembraneStrain> rest_strain_; // damped, per triangle
    std::vector<double> rest_angle_;          // damped, per hinge

    std::vector<Membrane> triangle_terms_; // times area
    std::vector<HingeTerms> hinge_terms_;
};

} // namespace ringlet
