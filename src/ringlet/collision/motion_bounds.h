// Motion bounds: per vertex an AABB that it stays inside, so that candidate pairs found for the bounds serve many moves.
#pragma once

#include "ringlet/collision/mesh.h"
#include "ringlet/collision/swept_boxes.h"

#include <vector>

namespace ringlet {

// A vertex whose path leaves its bound has escaped for that move. While there are no bounds all that moves has escaped. Borrows
// the mesh, which must outlive it.
class MotionBounds {
public:
    explicit MotionBounds(const CollisionMesh &mesh) : mesh_(mesh), boxes_(mesh), escaped_(mesh.moves.size()) {}

    bool empty() const { return low_.empty(); }
    void clear() { low_.clear(), high_.clear(); }

    // How bounds are fitted: around the path of a move, or the start alone where that path is longer than `max_path`, and wider
    // by `margin` on each side [m].
    struct Fit {
        double margin, max_path;
    };
    // The vertices whose section of the move that fit() encloses is not inside their bounds grown by `slack` on each side [m].
    std::vector<int> outside(const Move &move, double max_path, double slack) const;
    void fit(const Move &move, const Fit &how);                                   // of all vertices
    void fit(const Move &move, const Fit &how, const std::vector<int> &vertices); // of some

    // Finds the vertices that escape on a move.
    void find_escaped(const Move &move);
    View<unsigned char> escaped() const { return escaped_; } // per vertex
    bool any_escaped() const { return any_escaped_; }

    // All vertices have moved by one rigid motion: a bound becomes a cube inside the ball that its vertex has in it, however
    // that turned. One that its vertex had left is empty.
    void move_rigidly(View<Vec3> from, View<Vec3> to);

    const SweptBoxes &boxes() const { return boxes_; } // of the primitives in these bounds

private:
    bool leaves(int v, const Vec3 &point, double slack = 0.0) const {
        return !((point.array() >= low_[v].array() - slack).all() && (point.array() <= high_[v].array() + slack).all());
    }
    void fit_vertex(const Move &move, const Fit &how, int v);

    const CollisionMesh &mesh_;
    std::vector<Vec3> low_, high_;
    SweptBoxes boxes_;
    std::vector<unsigned char> escaped_;
    bool any_escaped_ = false;
};

} // namespace ringlet
