// What a filter knows of a scene besides where its vertices are.
#pragma once

#include "ringlet/collision/collision_mesh.h"
#include "ringlet/collision/vertex_lists.h"
#include "ringlet/geometry/rigid_motion.h"

#include <functional>

namespace ringlet {

// How what is kinematic moves near one of its vertices: where a point that goes along with it ends.
using CarriedBy = std::function<Vec3(int vertex, const Vec3 &point)>;

struct FilterScene {
    const CollisionMesh &mesh;
    View<double> mass; // per vertex
    View<int> offsets; // where each strand begins among the vertices, and the end
    CarriedBy carried_by;
    View<int>
        rigid; // per vertex: vertices of one number ≥ 0 are moved by one and the same affine map, so that none of them meet
    RigidMotion as_one; // nearly all moves so, where it is not still
    bool still = false; // nothing kinematic moves: staying is safe
    bool whole = false; // strands then only go a part of their way as a whole, and none is held back near a pair alone
    // Per vertex, what ends elsewhere than on the move that was filtered last, of which this is the rest; empty: all is new.
    View<unsigned char> changed = {};
    // Per vertex, where it may be told to go instead before it has arrived, or anywhere in the triangle of its start, this and
    // its end; what is held back has as much less of it. None: it goes no other way.
    std::vector<Vec3> *via = nullptr;
    // Where each cloth begins among the vertices, and the end; object numbers of cloths follow those of strands.
    View<int> cloths = {};
    const VertexLists *neighbours = nullptr; // of the vertices of cloths
    // While kinematic things move: rounds at most, and those after which it goes on only where little is left in the way.
    static constexpr int most_rounds = 16;
    int hopeful = most_rounds;
};

} // namespace ringlet
