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
    void clear_escaped() { escaped_.assign(escaped_.size(), 0), any_escaped_ = false; }
    // Adds those for which escapes(v), which is called in parallel, is true.
    template <class Escapes> void add_escaped(const Escapes &escapes) {
        bool any = any_escaped_;
#pragma omp parallel for schedule(static) reduction(|| : any)
        for (int v = 0; v < int(escaped_.size()); ++v) {
            escaped_[v] |= escapes(v);
            any = any || escaped_[v];
        }
        any_escaped_ = any;
    }
    View<unsigned char> escaped() const { return escaped_; } // per vertex
    bool any_escaped() const { return any_escaped_; }

    // Distance from a point to the nearest side of a vertex's bound; negative outside [m].
    double clearance(int v, const Vec3 &point) const {
        return std::min((point - low_[v]).minCoeff(), (high_[v] - point).minCoeff());
    }
    // Replaces every bound by a cube around `centres`, of half_side(v), which may be negative [m].
    template <class HalfSide> void set_cubes(View<Vec3> centres, const HalfSide &half_side) {
#pragma omp parallel for schedule(static)
        for (int v = 0; v < int(centres.size()); ++v) {
            const double half = half_side(v);
            low_[v] = centres[v].array() - half;
            high_[v] = centres[v].array() + half;
        }
        boxes_.fit_static(low_, high_);
    }

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
