// Model and state of a cloth: all that is fixed, and all that moves. Alone it is stepped by scene/scene.h.
#pragma once

#include "ringlet/energy/cloth/membrane.h"
#include "ringlet/math/types.h"

#include <array>
#include <vector>

namespace ringlet {

struct ClothMaterial {
    double density = 0.15;      // [kg/m²]
    double stretch_warp = 1000; // resistance to stretch along the warp: force per width and strain [N/m]
    double stretch_weft = 1000; // along the weft [N/m]
    double shear = 300;         // [N/m]
    double bend = 1e-5;         // D: moment per width and curvature [N m]
    double damping = 0.0;       // Kelvin–Voigt time β [s]: every strain resists its own rate with β times its stiffness
    double mass_damping = 0.0;  // α [1/s]: velocities decay at this rate
    double drag = 0.0;          // linear air drag per area [kg/(m² s)]
    double thickness = 1e-3;    // [m]: for contact; it does not bend or stretch
};

// Fixed. Triangles and hinges refer to vertices.
struct ClothModel {
    std::vector<Vec3> rest; // rest shape [m]
    std::vector<Triangle> triangles;
    std::vector<MembraneRest> membrane;     // per triangle: rest shape
    std::vector<std::array<int, 4>> hinges; // apex, the two ends of an interior edge, apex
    std::vector<double> rest_angle;         // φ̄ per hinge [rad]
    std::vector<double> hinge_stiffness;    // D l̄²/A per hinge [N m]
    std::vector<unsigned char> held;        // per vertex: 1 where it follows its target
    std::vector<double> attachment;         // per vertex: a spring to its target [N/m]; 0 where there is none
    std::vector<double> mass;               // per vertex [kg]: a third of its triangles'
    std::vector<double> drag;               // per vertex [kg/s]
    MembraneStiffness stiffness;            // [N/m]
    double damping = 0.0;                   // β [s]
    double mass_damping = 0.0;              // α [1/s]
    double thickness = 0.0;                 // [m]

    std::vector<Vec3> given_rest; // the rest shape before it was scaled
    std::vector<MembraneRest> given_membrane;

    int vertex_count() const { return int(mass.size()); }
};

struct ClothState {
    std::vector<Vec3> positions;  // [m]
    std::vector<Vec3> velocities; // [m/s]
};

// The rest shape, with its folds, is that of `rest`. `warp` gives the direction of the warp, one vector per triangle (its
// projection counts). `attachment` is per vertex or empty. Throws std::invalid_argument where sizes or indices do not fit, a
// triangle has no area, or a free vertex belongs to no triangle.
ClothModel make_cloth_model(View<Triangle> triangles, View<Vec3> rest, View<Vec3> warp, View<unsigned char> held,
                            View<double> attachment, const ClothMaterial &material);

// Elastic that draws together, or grows: the rest shape becomes `scale` times what it was given as. Its folds, its masses and
// its resistance to bend stay.
void scale_rest(ClothModel &model, double scale);

} // namespace ringlet
