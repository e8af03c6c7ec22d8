// Contact pairs of the narrow phase, and of the pairs that a line search asks for.
#include "collision_scene.h"

#include <boost/test/unit_test.hpp>

using namespace ringlet;

BOOST_AUTO_TEST_SUITE(narrow_phase)

BOOST_AUTO_TEST_CASE(contact_pairs_are_the_pairs_nearer_than_their_activation_distance) {
    const CollisionScene scene(3, 0.0);
    const CollisionMesh &mesh = scene.mesh;
    const std::vector<PrimitivePair> pairs = all_pairs(mesh);
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
    Candidates candidates(mesh);
    candidates.enclose({scene.start, scene.start}, {.margin = 0.01, .max_path = 0.0});
    MoveCandidates pairs(candidates);
    pairs.begin({scene.start, scene.end});
    std::vector<unsigned char> marked(32, 0);
    for (int object = 0; object < 32; object += 2) marked[object] = 1;
    const ReachablePairs reachable = pairs.reachable_pairs(marked);
    for (const double fraction : {0.0, 0.4, 1.0}) {
        std::vector<Vec3> x = scene.start;
        for (size_t v = 0; v < x.size(); ++v) x[v] += fraction * (scene.end[v] - scene.start[v]);
        Pairs expected, found;
        for (const auto &[edge_edge, i, j] : all_contacts(mesh, x)) {
            const int first = edge_edge ? mesh.edges[i][0] : i, second = edge_edge ? mesh.edges[j][0] : mesh.triangles[j][0];
            if (marked[mesh.object[first]] || marked[mesh.object[second]]) expected.insert({edge_edge, i, j});
        }
        for (const ContactPair &pair : contact_pairs(mesh, reachable, x, marked, std::vector<double>(32, fraction)))
            found.insert(name(pair));
        BOOST_TEST(expected.size() > 5);
        BOOST_TEST((found == expected));
    }
}

// Most objects stay: their pairs are looked at no more, and yet known.
BOOST_AUTO_TEST_CASE(contact_pairs_are_complete_where_few_objects_move) {
    CollisionScene scene(4, 0.05);
    const CollisionMesh &mesh = scene.mesh;
    std::vector<Vec3> now = scene.start, next = scene.start;
    Candidates candidates(mesh);
    candidates.enclose({now, now}, {.margin = 0.05, .max_path = 0.1});
    MoveCandidates pairs(candidates);
    pairs.begin({now, now});
    size_t checked = 0;
    for (int mover = 2; mover < 32; ++mover) {
        std::vector<unsigned char> marked(32, 0);
        marked[mover] = 1;
        for (size_t v = 0; v < now.size(); ++v)
            if (mesh.object[v] == mover && mesh.moves[v]) next[v] = now[v] + Vec3(0.003, 0.004, -0.003);
        const Move move{now, next};
        candidates.enclose(move, {.margin = 0.05, .max_path = 0.1});
        pairs.begin(move);
        pairs.commit(now, next);
        now = next;
        Pairs expected, found;
        for (const auto &[edge_edge, i, j] : all_contacts(mesh, now)) {
            const int first = edge_edge ? mesh.edges[i][0] : i, second = edge_edge ? mesh.edges[j][0] : mesh.triangles[j][0];
            if (marked[mesh.object[first]] || marked[mesh.object[second]]) expected.insert({edge_edge, i, j});
        }
        for (const ContactPair &pair : pairs.contact_pairs(now, marked)) found.insert(name(pair));
        checked += expected.size();
        BOOST_TEST((found == expected));
    }
    BOOST_TEST(checked > 20);
    BOOST_TEST((contacts(pairs, now) == all_contacts(mesh, now)));
}

BOOST_AUTO_TEST_SUITE_END()
