// The broad phase: candidate pairs whose swept AABBs overlap on a move.
#pragma once

#include "ringlet/collision/bvh.h"
#include "ringlet/collision/incidence.h"
#include "ringlet/collision/mesh.h"
#include "ringlet/collision/swept_boxes.h"

#include <vector>

namespace ringlet {

struct Candidates {                                 // in ascending order, each pair once
    std::vector<std::array<int, 2>> edge_edge;      // indices into `edges`, the lower first
    std::vector<std::array<int, 2>> point_triangle; // a vertex, and an index into `triangles`
};

// Candidates are the same for any number of threads and any earlier queries. Left out are pairs that share a vertex, pairs that
// are kinematic, and primitives with the object that they are anchored to. Borrows the mesh, which must outlive it.
class BroadPhase {
public:
    explicit BroadPhase(const CollisionMesh &mesh);

    // All candidates of `boxes`. With `changed` only pairs with a vertex that it marks. With `move`, which needs static boxes,
    // without pairs of edges that a separating axis keeps apart wherever in the triangles of that move they are.
    void find(const SweptBoxes &boxes, Candidates &candidates, View<unsigned char> changed = {},
              const SweptBoxes *move = nullptr);

    // After a find() of `bounds`: the candidates with an `escaped` and a `changed` vertex, where escaped vertices have their
    // boxes of `move` and all others those of `bounds`. Refits only what differs. Both have one origin.
    void find_escaped(const SweptBoxes &move, const SweptBoxes &bounds, View<unsigned char> escaped,
                      View<unsigned char> changed, Candidates &candidates);

    void invalidate() { unbounded_.assign(mesh_.moves.size(), 1); } // the bounds of find() have all changed

    const Incidence &incidence() const { return incidence_; }
    int builds() const { return edge_tree_.builds(); } // of the tree of edges

private:
    using Pairs = std::vector<std::array<int, 2>>;

    // Calls work(tree, primitives, box_of) for edges, points and triangles, with box_of(boxes, i).
    template <class Work> void for_trees(const Work &work);
    void search_all(const SweptBoxes &boxes, Candidates &candidates, const SweptBoxes *move = nullptr);
    template <class A, class B>
    void search(const Bvh &tree_a, const A &all_a, const Bvh &tree_b, const B &all_b, const SweptBoxes &boxes,
                const SweptBoxes *move);
    void gather(size_t firsts, Pairs &sorted);

    const CollisionMesh &mesh_;
    std::vector<std::array<int, 1>> points_;
    std::vector<int> point_of_; // a vertex; −1: none
    Incidence incidence_;
    Bvh edge_tree_, triangle_tree_, point_tree_;
    std::vector<Pairs> found_; // by each task

    std::vector<unsigned char> unbounded_; // vertices that do not have their boxes of the bounds
    std::vector<unsigned char> stale_;     // vertices to be refitted
};

} // namespace ringlet
