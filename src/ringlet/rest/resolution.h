// Resolution correction of the rod coefficients: a coil with few vertices a turn is stiffer than the smooth coil through its
// vertices.
#pragma once

namespace ringlet {

// Factors on the coefficients of an edge. All are 1 for a straight edge and tend to 1 as a coil is refined.
struct ResolutionFactors {
    double bend = 1.0;  // EI
    double twist = 1.0; // GJ
    double mass = 1.0;  // arc length over chord length
};

// Factors of an edge with the turning angle `angle` (mean θ̄ of its two corners) and the dihedral angle `dihedral` (φ̄). The
// edge is a chord of a helix whose radius and pitch follow from the two, and so do the compliances of the smooth coil. The
// factors are 1 for nearly straight edges (angle < 1e-3) and for angles too large for a curve (angle > 2.4, or more than 2 rad
// about the axis of the helix).
ResolutionFactors resolution_factors(double angle, double dihedral);

} // namespace ringlet
