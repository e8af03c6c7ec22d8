// Incidence of a collision mesh.
#include "collision_scene.h"
#include "ringlet/collision/incidence.h"

#include <boost/test/unit_test.hpp>

using namespace ringlet;

BOOST_AUTO_TEST_SUITE(incidence)

BOOST_AUTO_TEST_CASE(a_subset_lists_each_primitive_with_a_marked_vertex_once) {
    const CollisionScene scene(1, 0.0);
    const CollisionMesh &mesh = scene.mesh;
    std::vector<unsigned char> marked(mesh.moves.size(), 0);
    for (const int v : {0, 1, 7, 100, 101}) marked[v] = 1;
    const MeshSubset subset(mesh, Incidence(mesh), marked);
    const auto check = [&](std::vector<int> listed, const auto &primitives) {
        std::vector<int> expected;
        for (int i = 0; i < int(primitives.size()); ++i)
            if (any_of(View<unsigned char>(marked), primitives[i])) expected.push_back(i);
        std::sort(listed.begin(), listed.end());
        BOOST_TEST(expected.size() > 3);
        BOOST_TEST((listed == expected));
    };
    check(subset.edges, mesh.edges);
    check(subset.triangles, mesh.triangles);
    BOOST_TEST((subset.vertices == std::vector<int>{0, 1, 7, 100, 101}));
}

BOOST_AUTO_TEST_SUITE_END()
