// Boxes around the primitives of a scene on their ways.
#pragma once

#include "ringlet/contact/collision_mesh.h"
#include "ringlet/contact/moving_box.h"

#include <vector>

namespace ringlet {

// Borrows the mesh, which must outlive it. Boxes are as wide as their primitives are thick, and wider by what may be lost in
// computing in single precision.
class PathBoxes {
public:
    explicit PathBoxes(const CollisionMesh &mesh);

    // Where places are told from: where the scene is and how fast it flies as a whole costs no precision if this is a vertex.
    struct Origin {
        Vec3 start, end;
    };

    // Everything goes straight from `start` to `end`: positions [m] of all vertices. Boxes are wider by `margin` [m].
    void fit(View<Vec3> start, View<Vec3> end, const Origin &origin, double margin = 0.0);
    // Vertices may be anywhere in boxes, from `low` to `high` [m].
    void fit_within(View<Vec3> low, View<Vec3> high);
    // Either of them again, of vertices that have changed.
    void fit_anew(View<Vec3> start_or_low, View<Vec3> end_or_high, View<unsigned char> changed);

    const Origin &origin() const { return origin_; }
    bool still() const { return still_; } // boxes are the same at the end
    const MovingBox &of_edge(int i) const { return edges_[i]; }
    const MovingBox &of_vertex(int v) const { return vertices_[v]; }
    const MovingBox &of_triangle(int i) const { return triangles_[i]; }

    // Calls work with the boxes of the two of a pair.
    template <class Pair, class Work> auto with_boxes(const Pair &pair, const Work &work) const {
        return pair.of_edges ? work(edges_[pair.of[0]], edges_[pair.of[1]])
                             : work(vertices_[pair.of[0]], triangles_[pair.of[1]]);
    }

private:
    template <class Counts> void fit(const Counts &counts);
    MovingBox box(int vertex) const { // not widened yet
        const Eigen::Array4f &a = starts_[vertex], &b = ends_[vertex];
        return still_ ? MovingBox{a, b, a, b} : MovingBox{a, a, b, b};
    }
    static void place(View<Vec3> points, const Vec3 &origin, std::vector<Eigen::Array4f> &places);
    float rounding() const; // [m]

    const CollisionMesh &mesh_;
    std::vector<float> edge_radii_, vertex_radii_, triangle_radii_;
    Origin origin_;
    std::vector<Eigen::Array4f> starts_, ends_; // of the ways, or the corners of what vertices stay in
    float wider_ = 0.0f;                        // [m]
    bool still_ = false;
    std::vector<MovingBox> edges_, vertices_, triangles_;
};

} // namespace ringlet
