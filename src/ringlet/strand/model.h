// Model of strands: all that is constant while they move.
#pragma once

#include "ringlet/math/types.h"
#include "ringlet/strand/kernel.h"

#include <variant>
#include <vector>

namespace ringlet {

// Material of a lock, in a hair's values: many hairs that do not stick together move like one of them.
struct StrandMaterial {
    double youngs_modulus = 4e9;    // E [Pa]
    double radius = 35e-6;          // r [m]
    double density = 1300;          // ρ [kg/m³]
    double stretch_scale = 1;       // scales EA: below 1 the strand is easier to stretch than its E says
    double bend_scale = 1;          // scales EI
    double twist_ratio = 0.72;      // c = GJ / EI
    bool limit_twist = true;        // clamp c to [0, 1]
    double damping = 0.0;           // Kelvin–Voigt time β [s]: every strain resists its own rate with β times its stiffness
    double mass_damping = 0.0;      // α [1/s]: velocities decay at this rate
    double drag = 0.0;              // linear air drag per length [kg/(m s)]
    bool correct_resolution = true; // make coils of few vertices a turn as soft as smooth ones (rest/resolution.h)
};

// Settings of the material by name, for the bindings.
struct StrandMaterialSetting {
    const char *name;
    std::variant<double StrandMaterial::*, bool StrandMaterial::*> member;
};

inline constexpr StrandMaterialSetting strand_material_settings[] = {
    {"youngs_modulus", &StrandMaterial::youngs_modulus},
    {"radius", &StrandMaterial::radius},
    {"density", &StrandMaterial::density},
    {"stretch_scale", &StrandMaterial::stretch_scale},
    {"bend_scale", &StrandMaterial::bend_scale},
    {"twist_ratio", &StrandMaterial::twist_ratio},
    {"limit_twist", &StrandMaterial::limit_twist},
    {"damping", &StrandMaterial::damping},
    {"mass_damping", &StrandMaterial::mass_damping},
    {"drag", &StrandMaterial::drag},
    {"correct_resolution", &StrandMaterial::correct_resolution},
};

// Variation of the material along strands: factors per vertex on StrandMaterial, each n long or empty (1 everywhere). An edge
// takes the mean of its two vertices.
struct StrandVariation {
    View<double> radius, stretch, bend, twist, damping, drag;
};

// Rest shape and coefficients of all strands, packed like Curves: one row per vertex.
struct StrandModel : StrandCoefficients<std::vector<double>> {
    std::vector<int> offsets;        // first row of each strand, and the end; strand count + 1
    std::vector<unsigned char> held; // per vertex: 1 where it follows its target
    std::vector<Vec3> rest_normal;   // of the corners, in the pose of the rest shape
    std::vector<Vec3> rest_tangent;  // of the edges, likewise
    double mass_damping = 0.0;       // α [1/s]

    int strand_count() const { return int(offsets.size()) - 1; }
    int vertex_count() const { return offsets.back(); }
};

// The rest shape is measured from the polylines `rest` (offsets.back() points); every strand has at least 3 points, of which
// the root is held. Throws std::invalid_argument where lengths do not fit or an edge has no length.
StrandModel make_strand_model(View<int> offsets, View<Vec3> rest, View<unsigned char> held, const StrandMaterial &material,
                              const StrandVariation &variation = {});

} // namespace ringlet
