// The broad phase against all pairs.
#include "collision_scene.h"
#include "ringlet/collision/broad_phase.h"

#include <boost/test/unit_test.hpp>
#include <omp.h>

using namespace ringlet;

namespace {

template <size_t N> bool any_moves(const CollisionMesh &mesh, const std::array<int, N> &vertices) {
    return std::any_of(vertices.begin(), vertices.end(), [&](int v) { return mesh.moves[v]; });
}

template <class A, class B> bool excluded(const CollisionMesh &mesh, const A &a, const B &b) {
    return share_vertex(a, b) || anchored(mesh, a, b) || (!any_moves(mesh, a) && !any_moves(mesh, b));
}

// The least gap of two primitives on the move, less their activation distance, from 41 samples.
template <class A, class B> double least_slack(const CollisionScene &scene, const A &a, const B &b) {
    double nearest = 1e9;
    std::vector<Vec3> x(scene.start.size());
    for (int k = 0; k <= 40; ++k) {
        for (int v : a) x[v] = scene.start[v] + k / 40.0 * (scene.end[v] - scene.start[v]);
        for (int v : b) x[v] = scene.start[v] + k / 40.0 * (scene.end[v] - scene.start[v]);
        nearest = std::min(nearest, std::sqrt(closest_points(x, a, b).distance2));
    }
    return nearest - activation_distance(scene.mesh, a, b);
}

Candidates found(const CollisionScene &scene, double margin) {
    Candidates candidates;
    BroadPhase(scene.mesh).find(boxes_of_move(scene.mesh, scene.start, scene.end, margin), candidates);
    return candidates;
}

bool same(const Candidates &a, const Candidates &b) {
    return a.edge_edge == b.edge_edge && a.point_triangle == b.point_triangle;
}

template <class Pairs> bool ascending(const Pairs &pairs) {
    return std::adjacent_find(pairs.begin(), pairs.end(), std::greater_equal()) == pairs.end();
}

} // namespace

BOOST_AUTO_TEST_SUITE(broad_phase)

BOOST_AUTO_TEST_CASE(no_pair_within_the_margin_is_missed) {
    for (double motion : {0.0, 0.02, 0.3}) {
        const CollisionScene scene(1, motion);
        const CollisionMesh &mesh = scene.mesh;
        const double margin = 0.005;
        const Candidates candidates = found(scene, margin);
        BOOST_TEST((ascending(candidates.edge_edge) && ascending(candidates.point_triangle)));
        const std::set<std::array<int, 2>> edges(candidates.edge_edge.begin(), candidates.edge_edge.end());
        const std::set<std::array<int, 2>> points(candidates.point_triangle.begin(), candidates.point_triangle.end());
        int near = 0, missed = 0;
        for (int a = 0; a < static_cast<int>(mesh.edges.size()); ++a)
            for (int b = a + 1; b < static_cast<int>(mesh.edges.size()); ++b) {
                if (excluded(mesh, mesh.edges[a], mesh.edges[b]) || least_slack(scene, mesh.edges[a], mesh.edges[b]) > margin)
                    continue;
                ++near;
                missed += !edges.count({a, b});
            }
        for (int v : mesh.points)
            for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
                const std::array<int, 1> point = {v};
                if (excluded(mesh, point, mesh.triangles[t]) || least_slack(scene, point, mesh.triangles[t]) > margin) continue;
                ++near;
                missed += !points.count({v, t});
            }
        BOOST_TEST(missed == 0, "motion " << motion << ": " << missed << " of " << near << " pairs missed");
        BOOST_TEST(near > 50);
    }
}

BOOST_AUTO_TEST_CASE(excluded_pairs_are_no_candidates) {
    const CollisionScene scene(2, 0.1);
    const CollisionMesh &mesh = scene.mesh;
    const Candidates candidates = found(scene, 0.05);
    BOOST_TEST(candidates.edge_edge.size() > 1000);
    BOOST_TEST(candidates.point_triangle.size() > 1000);
    for (const auto &[a, b] : candidates.edge_edge) BOOST_TEST(!excluded(mesh, mesh.edges[a], mesh.edges[b]));
    for (const auto &[v, t] : candidates.point_triangle) BOOST_TEST(!excluded(mesh, std::array<int, 1>{v}, mesh.triangles[t]));
}

BOOST_AUTO_TEST_CASE(neighbours_along_a_strand_at_rest_are_no_candidates) {
    CollisionMesh mesh; // segments of 1 mm, ten times as thick
    for (int k = 0; k < 50; ++k) {
        mesh.rest.emplace_back(0.001 * k, 0.0, 0.0);
        if (k > 0) mesh.edges.push_back({k - 1, k});
    }
    mesh.radius.assign(50, 0.005);
    mesh.moves.assign(50, 1);
    mesh.object.assign(50, 0);
    mesh.anchor.assign(50, -1);
    Candidates candidates;
    BroadPhase broad(mesh);
    broad.find(boxes_of_move(mesh, mesh.rest, mesh.rest, 0.0), candidates);
    BOOST_TEST(candidates.edge_edge.empty());
    std::vector<Vec3> shorter = mesh.rest;
    for (Vec3 &x : shorter) x *= 0.5;
    broad.find(boxes_of_move(mesh, shorter, shorter, 0.0), candidates); // drawn together, they do push
    BOOST_TEST(!candidates.edge_edge.empty());
}

BOOST_AUTO_TEST_CASE(candidates_do_not_depend_on_threads_or_earlier_queries) {
    const CollisionScene scene(3, 0.1), other(4, 0.5);
    const int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    const Candidates one = found(scene, 0.01);
    omp_set_num_threads(4);
    Candidates four;
    BroadPhase broad(scene.mesh);
    broad.find(boxes_of_move(scene.mesh, other.start, other.end, 0.02), four); // the same mesh elsewhere
    broad.find(boxes_of_move(scene.mesh, scene.start, scene.end, 0.01), four);
    omp_set_num_threads(threads);
    BOOST_TEST(same(one, four));
}

BOOST_AUTO_TEST_CASE(a_hierarchy_that_has_grown_loose_is_rebuilt) {
    CollisionScene scene(3, 0.1);
    BroadPhase broad(scene.mesh);
    Candidates candidates;
    for (int k = 0; k < 3; ++k)
        broad.find(boxes_of_move(scene.mesh, scene.start, scene.end, 0.001 * k), candidates); // a wider margin is no reason
    BOOST_TEST(broad.builds() == 1);
    std::shuffle(scene.start.begin(), scene.start.end(), scene.random);
    broad.find(boxes_of_move(scene.mesh, scene.start, scene.start, 0.01), candidates);
    BOOST_TEST(broad.builds() == 2);
    scene.end = scene.start;
    BOOST_TEST(same(candidates, found(scene, 0.01)));
}

// For a film frame: as many pairs as if the scene rested, not all that lie along the path.
BOOST_AUTO_TEST_CASE(a_scene_that_moves_at_100_m_per_s_has_the_same_candidates) {
    CollisionScene scene(5, 0.05);
    const Candidates at_home = found(scene, 0.01);
    for (Vec3 &x : scene.end) x += Vec3(60.0, 0.0, 80.0) / 24.0;
    BOOST_TEST(same(at_home, found(scene, 0.01)));
}

BOOST_AUTO_TEST_CASE(an_empty_mesh_has_no_candidates) {
    CollisionMesh mesh;
    Candidates candidates;
    BroadPhase(mesh).find(SweptBoxes(mesh), candidates);
    BOOST_TEST((candidates.edge_edge.empty() && candidates.point_triangle.empty()));
}

BOOST_AUTO_TEST_SUITE_END()
