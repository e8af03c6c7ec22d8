// Contact pairs of the narrow phase, and of the pairs that a line search asks for.
#include "collision_scene.h"

#include <boost/test/unit_test.hpp>

using namespace ringlet;

BOOST_AUTO_TEST_SUITE(narrow_phase)

BOOST_AUTO_TEST_CASE(contact_pairs_are_the_pairs_nearer_than_their_activation_distance) {
    const CollisionScene scene(3, 0.0);
    const CollisionMesh &mesh = scene.mesh;
    Candidates candidates;
    BroadPhase(mesh).find(boxes_of_move(mesh, scene.start, scene.start, 0.05), candidates);
    std::vector<PrimitivePair> pairs;
    for (const auto &pair : candidates.edge_edge)
        pairs.push_back({pair, true, activation_distance(mesh, mesh.edges[pair[0]], mesh.edges[pair[1]])});
    for (const auto &pair : candidates.point_triangle)
        pairs.push_back({pair, false, activation_distance(mesh, std::array{pair[0]}, mesh.triangles[pair[1]])});
    std::vector<ContactPair> found;
    {
        const auto ignore = [](const PrimitivePair &, double) {};
        NarrowPhase<const PrimitivePair, decltype(ignore)> narrow_phase(mesh, scene.start, ignore, found);
        for (const PrimitivePair &pair : pairs) narrow_phase.add(pair);
    }
    BOOST_TEST(found.size() > 10);
    size_t k = 0;
    for (const PrimitivePair &pair : pairs)
        with_vertices(mesh, pair, [&](const auto &a, const auto &b) {
            const double gap = std::sqrt(closest_points(scene.start, a, b).distance2);
            if (std::abs(gap - pair.d_hat) < 1e-12) return; // rounding decides
            const bool is_found =
                k < found.size() && found[k].primitive == pair.primitive && found[k].edge_edge == pair.edge_edge;
            BOOST_TEST(is_found == (gap < pair.d_hat));
            k += is_found;
        });
    BOOST_TEST(k == found.size());
}

BOOST_AUTO_TEST_CASE(reachable_pairs_hold_all_contacts_of_marked_objects_at_any_fraction_of_a_move) {
    CollisionScene scene(4, 0.05);
    const CollisionMesh &mesh = scene.mesh;
    for (size_t v = 0; v < scene.end.size(); ++v)
        if (!mesh.moves[v]) scene.end[v] = scene.start[v];
    PairCache cache(mesh);
    cache.begin_move({scene.start, scene.end});
    std::vector<unsigned char> marked(32, 0);
    for (int object = 0; object < 32; object += 2) marked[object] = 1;
    const ReachablePairs reachable = cache.reachable_pairs(marked);
    for (const double fraction : {0.0, 0.4, 1.0}) {
        std::vector<Vec3> x = scene.start;
        for (size_t v = 0; v < x.size(); ++v) x[v] += fraction * (scene.end[v] - scene.start[v]);
        PairCache there(mesh);
        there.begin_move({x, x});
        Pairs expected, found;
        for (const ContactPair &pair : there.contact_pairs(x)) {
            const auto object = [&](int k) {
                const int i = pair.primitive[k];
                return mesh.object[pair.edge_edge ? mesh.edges[i][0] : k == 0 ? i : mesh.triangles[i][0]];
            };
            if (marked[object(0)] || marked[object(1)]) expected.insert({pair.edge_edge, pair.primitive[0], pair.primitive[1]});
        }
        for (const ContactPair &pair : contact_pairs(mesh, reachable, x, marked, std::vector<double>(32, fraction)))
            found.insert({pair.edge_edge, pair.primitive[0], pair.primitive[1]});
        BOOST_TEST(expected.size() > 5);
        BOOST_TEST((found == expected));
    }
}

BOOST_AUTO_TEST_SUITE_END()
