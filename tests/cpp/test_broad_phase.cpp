// The broad phase against all pairs.
#include "collision_scene.h"
#include "ringlet/collision/broad_phase.h"

#include <boost/test/unit_test.hpp>
#include <omp.h>

using namespace ringlet;

namespace {

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

std::vector<PrimitivePair> found(const CollisionScene &scene, double margin) {
    return BroadPhase(scene.mesh).find(boxes_of_move(scene.mesh, scene.start, scene.end, margin));
}

Pairs names(const std::vector<PrimitivePair> &pairs) {
    Pairs all;
    for (const PrimitivePair &pair : pairs) all.insert(name(pair));
    return all;
}

// Each pair once.
bool ascending(const std::vector<PrimitivePair> &pairs) {
    const auto not_before = [](const PrimitivePair &a, const PrimitivePair &b) { return !before(a, b); };
    return std::adjacent_find(pairs.begin(), pairs.end(), not_before) == pairs.end();
}

} // namespace

BOOST_AUTO_TEST_SUITE(broad_phase)

BOOST_AUTO_TEST_CASE(no_pair_within_the_margin_is_missed) {
    for (double motion : {0.0, 0.02, 0.3}) {
        const CollisionScene scene(1, motion);
        const CollisionMesh &mesh = scene.mesh;
        const double margin = 0.005;
        const std::vector<PrimitivePair> candidates = found(scene, margin);
        BOOST_TEST(ascending(candidates));
        const Pairs found = names(candidates);
        int near = 0, missed = 0;
        for (const PrimitivePair &pair : all_pairs(mesh))
            with_vertices(mesh, pair, [&](const auto &a, const auto &b) {
                if (least_slack(scene, a, b) > margin) return;
                ++near;
                missed += !found.count(name(pair));
            });
        BOOST_TEST(missed == 0, "motion " << motion << ": " << missed << " of " << near << " pairs missed");
        BOOST_TEST(near > 50);
    }
}

BOOST_AUTO_TEST_CASE(excluded_pairs_are_no_candidates) {
    const CollisionScene scene(2, 0.1);
    const CollisionMesh &mesh = scene.mesh;
    const std::vector<PrimitivePair> candidates = found(scene, 0.05);
    BOOST_TEST(std::count_if(candidates.begin(), candidates.end(), [](const auto &pair) { return pair.edge_edge; }) > 1000);
    BOOST_TEST(std::count_if(candidates.begin(), candidates.end(), [](const auto &pair) { return !pair.edge_edge; }) > 1000);
    for (const PrimitivePair &pair : candidates)
        with_vertices(mesh, pair, [&](const auto &a, const auto &b) {
            BOOST_TEST(!excluded(mesh, a, b));
            BOOST_TEST(pair.d_hat == activation_distance(mesh, a, b));
        });
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
    BroadPhase broad(mesh);
    BOOST_TEST(broad.find(boxes_of_move(mesh, mesh.rest, mesh.rest, 0.0)).empty());
    std::vector<Vec3> shorter = mesh.rest;
    for (Vec3 &x : shorter) x *= 0.5;
    BOOST_TEST(!broad.find(boxes_of_move(mesh, shorter, shorter, 0.0)).empty()); // drawn together, they do push
}

BOOST_AUTO_TEST_CASE(candidates_do_not_depend_on_threads_or_earlier_queries) {
    const CollisionScene scene(3, 0.1), other(4, 0.5);
    const int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    const std::vector<PrimitivePair> one = found(scene, 0.01);
    omp_set_num_threads(4);
    BroadPhase broad(scene.mesh);
    broad.find(boxes_of_move(scene.mesh, other.start, other.end, 0.02)); // the same mesh elsewhere
    const std::vector<PrimitivePair> four = broad.find(boxes_of_move(scene.mesh, scene.start, scene.end, 0.01));
    omp_set_num_threads(threads);
    BOOST_TEST((names(one) == names(four)));
}

BOOST_AUTO_TEST_CASE(pairs_of_escaped_vertices_do_not_depend_on_who_escaped_before) {
    const CollisionScene scene(6, 0.1);
    const size_t count = scene.start.size();
    SweptBoxes bounds(scene.mesh), move(scene.mesh);
    bounds.fit_static(scene.start, scene.start);
    move.fit({scene.start, scene.end}, bounds.origin());
    std::vector<unsigned char> some(count), others(count);
    for (size_t v = 0; v < count; ++v) some[v] = v % 3 == 0, others[v] = v % 5 == 0;
    BroadPhase before(scene.mesh), between(scene.mesh), fresh(scene.mesh);
    for (BroadPhase *broad : {&before, &between, &fresh}) broad->fit(bounds);
    const Pairs escaped = names(fresh.find_escaped(move, bounds, others, others));
    BOOST_TEST(escaped.size() > 50);
    BOOST_TEST((names(before.find_escaped(move, bounds, some, some)) != escaped));
    BOOST_TEST((names(before.find_escaped(move, bounds, others, others)) == escaped));
    fresh.fit(bounds);
    between.find_escaped(move, bounds, some, some);
    BOOST_TEST((names(between.find_changed(bounds, others)) == names(fresh.find_changed(bounds, others))));
}

BOOST_AUTO_TEST_CASE(a_hierarchy_that_has_grown_loose_is_rebuilt) {
    CollisionScene scene(3, 0.1);
    BroadPhase broad(scene.mesh);
    for (int k = 0; k < 3; ++k)
        broad.fit(boxes_of_move(scene.mesh, scene.start, scene.end, 0.001 * k)); // a wider margin is no reason
    BOOST_TEST(broad.builds() == 1);
    std::shuffle(scene.start.begin(), scene.start.end(), scene.random);
    const std::vector<PrimitivePair> candidates = broad.find(boxes_of_move(scene.mesh, scene.start, scene.start, 0.01));
    BOOST_TEST(broad.builds() == 2);
    scene.end = scene.start;
    BOOST_TEST((names(candidates) == names(found(scene, 0.01))));
}

// For a film frame: as many pairs as if the scene rested, not all that lie along the path.
BOOST_AUTO_TEST_CASE(a_scene_that_moves_at_100_m_per_s_has_the_same_candidates) {
    CollisionScene scene(5, 0.05);
    const std::vector<PrimitivePair> at_home = found(scene, 0.01);
    for (Vec3 &x : scene.end) x += Vec3(60.0, 0.0, 80.0) / 24.0;
    BOOST_TEST((names(at_home) == names(found(scene, 0.01))));
}

BOOST_AUTO_TEST_CASE(an_empty_mesh_has_no_candidates) {
    CollisionMesh mesh;
    const std::vector<PrimitivePair> candidates = BroadPhase(mesh).find(SweptBoxes(mesh));
    BOOST_TEST(candidates.empty());
}

BOOST_AUTO_TEST_SUITE_END()
