// Motion bounds: per vertex an AABB that it stays inside, so that candidate pairs found for the bounds serve many moves.
#pragma once

#include "ringlet/collision/mesh.h"
#include "ringlet/collision/swept_boxes.h"
#include "ringlet/geometry/rigid_motion.h"

#include <vector>

namespace ringlet {

// A vertex whose path leaves its bound has escaped for that move. Borrows the mesh, which must outlive it.
class MotionBounds {
public:
    explicit MotionBounds(const CollisionMesh &mesh) : boxes_(mesh) {}

    bool empty() const { return low_.empty(); }
    void clear() { low_.clear(), high_.clear(); }

    // How bounds are fitted: around the path of a move, or the start alone where that path is longer than `max_path`, and wider
    // by `margin` on each side [m].
    struct Fit {
        double margin, max_path;
    };
    // The vertices whose section of the move that fit() encloses is not inside their bounds.
    std::vector<int> outside(const Move &move, double max_path, double slack = 0.0) const;
    void fit(const Move &move, const Fit &how);                                   // of all vertices
    void fit(const Move &move, const Fit &how, const std::vector<int> &vertices); // of some

    // Marks the vertices that escape on a move.
    std::vector<unsigned char> escaped(const Move &move) const;

    // All vertices make one rigid motion from where they are: their bounds lose what turning leads out of them.
    void move_rigidly(const RigidMotion &motion, View<Vec3> from);

    const SweptBoxes &boxes() const { return boxes_; } // of the primitives in these bounds

private:
    bool leaves(int v, const Vec3 &point, double slack = 0.0) const {
        return empty() ||
               !((point.array() >= low_[v].array() - slack).all() && (point.array() <= high_[v].array() + slack).all());
    }
    void fit_vertex(const Move &move, const Fit &how, int v);

    std::vector<Vec3> low_, high_;
    SweptBoxes boxes_;
};

} // namespace ringlet
