// What a coil of few vertices a turn is too stiff by, and the factors that make it as soft as the smooth coil through its
// vertices.
#pragma once

namespace ringlet {

// By these the coefficients of a chord are multiplied. All are 1 for a straight edge and tend to 1 as a coil is refined.
struct ResolutionFactors {
    double bend = 1.0;  // EI
    double twist = 1.0; // GJ
    double mass = 1.0;  // arc length over chord length
};

// For an edge whose corners turn by `angle` (mean θ̄ of the two) and whose dihedral is `dihedral` (φ̄): it is a chord of a helix
// of known radius and pitch, whose smooth compliances are known. 1 where the edge is nearly straight or turns too far to be a
// chord of a curve (angle < 1e-3 or > 2.4, more than 2 rad about the axis).
ResolutionFactors resolution_factors(double angle, double dihedral);

} // namespace ringlet
