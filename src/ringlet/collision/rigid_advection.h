// Rigid advection: transforms motion bounds where nearly everything follows one rigid motion, as hair does on a head.
#pragma once

#include "ringlet/collision/motion_bounds.h"
#include "ringlet/geometry/rigid_motion.h"

#include <vector>

namespace ringlet {

// Vertices that deviate little from the rigid motion follow it; the others escape. Borrows the mesh, which must outlive it.
class RigidAdvection {
public:
    explicit RigidAdvection(const CollisionMesh &mesh);

    // Two points that move straight to where a rotation by θ leads them keep this fraction of their distance: cos ½θ.
    static double kept_distance(const RigidMotion &motion);

    // Measures how far `changed` vertices end from where the rigid motion leads them, and adds those to the escaped ones that
    // do not follow it. A vertex with a number ≥ 0 in `rigid` can follow. Without `bounded` nothing that moves can.
    void begin(const Move &move, const RigidMotion &motion, View<int> rigid, View<unsigned char> changed, bool bounded,
               MotionBounds &bounds);

    // A bound that is advected is a cube inside the ball that its vertex has in the old one, however that turned, less the
    // vertex's deviation. Escaped vertices get bounds that contain nothing.
    void advect(const Move &move, MotionBounds &bounds);

    // Upper bound on how much nearer a pair comes than under the rigid motion [m].
    double deviation(const PrimitivePair &pair) const;
    // The same after advect(), which is cheaper where all vertices follow almost exactly.
    double advected_deviation(const PrimitivePair &pair) const { return nearly_exact_ ? 2.0 * largest_ : deviation(pair); }

private:
    const CollisionMesh &mesh_;
    double least_radius_;           // of moving vertices [m]
    std::vector<double> deviation_; // per vertex [m]
    double largest_ = 0.0;          // of those that follow [m]
    bool nearly_exact_ = false;
};

} // namespace ringlet
