// The broad phase: pairs of primitives whose AABBs overlap.
#pragma once

#include "ringlet/collision/incidence.h"
#include "ringlet/collision/mesh.h"
#include "ringlet/collision/swept_boxes.h"
#include "ringlet/geometry/bvh.h"

#include <vector>

namespace ringlet {

// What is found is in order and the same for any number of threads and any earlier queries. Left out are pairs that share a
// vertex, pairs that are kinematic, and primitives with the object that they are anchored to. Borrows the mesh, which must
// outlive it.
class BroadPhase {
public:
    explicit BroadPhase(const CollisionMesh &mesh);

    // Fits the hierarchies to all `boxes`; find() gives all pairs then.
    void fit(const SweptBoxes &boxes);
    std::vector<PrimitivePair> find(const SweptBoxes &boxes) {
        fit(boxes);
        return search_all(boxes);
    }

    // The same for static boxes around a move, without pairs of edges that a separating axis keeps apart wherever in their
    // triangles of that move they are.
    std::vector<PrimitivePair> find(const SweptBoxes &around, const SweptBoxes &move) {
        fit(around);
        return search_all(around, &move);
    }

    // After a fit, where the boxes of `changed` vertices are others now: fits the hierarchies to these, and gives the pairs
    // with a changed vertex.
    std::vector<PrimitivePair> find_changed(const SweptBoxes &boxes, View<unsigned char> changed);

    // After a fit to `bounds`: the pairs with an `escaped` and a `changed` vertex, where escaped vertices have their boxes of
    // `move` and all others those of `bounds`. Both have one origin. Of an unchanged vertex that had escaped in the last query,
    // the box of that query counts.
    std::vector<PrimitivePair> find_escaped(const SweptBoxes &move, const SweptBoxes &bounds, View<unsigned char> escaped,
                                            View<unsigned char> changed);

    const Incidence &incidence() const { return incidence_; }
    int builds() const { return edge_tree_.builds(); } // of the tree of edges

private:
    using Pairs = std::vector<PrimitivePair>;

    // Calls work(tree, primitives, box_of) for edges, points and triangles, with box_of(boxes, i).
    template <class Work> void for_trees(const Work &work);
    template <class Boxes> void refit(View<unsigned char> stale, View<unsigned char> changed, const Boxes &boxes_of);
    std::vector<PrimitivePair> search_all(const SweptBoxes &boxes, const SweptBoxes *move = nullptr);
    template <class A, class B>
    void search(const Bvh &tree_a, const A &all_a, const Bvh &tree_b, const B &all_b, const SweptBoxes &boxes,
                const SweptBoxes *move);
    void gather(size_t firsts, Pairs &all);

    const CollisionMesh &mesh_;
    std::vector<std::array<int, 1>> points_;
    std::vector<int> point_of_;          // a vertex; −1: none
    std::vector<unsigned char> escaped_; // vertices whose boxes in the hierarchies are those of a move
    Incidence incidence_;
    Bvh edge_tree_, triangle_tree_, point_tree_;
    std::vector<Pairs> found_; // by each task
};

} // namespace ringlet
