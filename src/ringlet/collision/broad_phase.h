// Which pairs may touch while everything moves from one place to the next.
#pragma once

#include "ringlet/collision/collision_mesh.h"
#include "ringlet/collision/moving_tree.h"
#include "ringlet/collision/path_boxes.h"
#include "ringlet/collision/vertex_lists.h"

#include <vector>

namespace ringlet {

struct Candidates {                                 // in ascending order, each pair once
    std::vector<std::array<int, 2>> edge_edge;      // indices into `edges`, the lower first
    std::vector<std::array<int, 2>> point_triangle; // a vertex, and an index into `triangles`
};

// Borrows the mesh, which must outlive it.
class BroadPhase {
public:
    explicit BroadPhase(const CollisionMesh &mesh);

    // All pairs that may touch on their ways. Left out are pairs that share a vertex, pairs whose motions are both given, and
    // what is carried against what carries it. The same for any number of threads, and whatever was asked before.
    // `changed`, if given, leaves only pairs with a vertex for which it is not 0.
    // `move`, if given, leaves out pairs of edges that are apart wherever in the triangles of their ways on it they are.
    void find(const PathBoxes &ways, Candidates &candidates, View<unsigned char> changed = {}, const PathBoxes *move = nullptr);

    // What find() finds, after a find() of `homes`, for pairs with a vertex that is `quick` and one that has `changed`. All
    // others stay at home. Takes less time the fewer these are. Both are told from one place.
    void find_quick(const PathBoxes &ways, const PathBoxes &homes, View<unsigned char> quick, View<unsigned char> changed,
                    Candidates &candidates);

    void leave_homes() { away_.assign(mesh_.moves.size(), 1); } // all have changed since find()

    const Incidence &incidence() const { return incidence_; }
    int built() const { return edge_tree_.built(); } // how often the tree of edges was built, for studies

private:
    using Pairs = std::vector<std::array<int, 2>>;

    void search_all(const PathBoxes &ways, Candidates &candidates, const PathBoxes *move = nullptr);
    template <class A, class B>
    void search(const MovingTree &tree_a, const A &all_a, const MovingTree &tree_b, const B &all_b, const PathBoxes &ways,
                const PathBoxes *move);
    void gather(size_t firsts, Pairs &sorted);

    const CollisionMesh &mesh_;
    std::vector<std::array<int, 1>> points_;
    std::vector<int> point_of_; // a vertex; −1: none
    Incidence incidence_;
    MovingTree edge_tree_, triangle_tree_, point_tree_;
    std::vector<Pairs> found_; // by each task

    std::vector<unsigned char> away_, stale_; // vertices: not boxed at home; that are to be boxed anew
};

} // namespace ringlet
