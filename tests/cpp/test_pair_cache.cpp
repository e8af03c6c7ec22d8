// The pair cache against one that has no motion bounds.
#include "collision_scene.h"
#include "ringlet/geometry/rigid_motion.h"

#include <Eigen/Geometry>
#include <boost/test/unit_test.hpp>

using namespace ringlet;

BOOST_AUTO_TEST_SUITE(pair_cache)

// Some vertices escape, most do not. Then all paths are halved, committed and reversed.
BOOST_AUTO_TEST_CASE(cached_pairs_change_no_impact_and_no_contact) {
    CollisionScene scene(6, 0.0);
    const CollisionMesh &mesh = scene.mesh;
    for (size_t v = 0; v < scene.end.size(); ++v)
        scene.end[v] = scene.start[v] + scene.anywhere(!mesh.moves[v] ? 0.0 : v % 50 == 0 ? 0.1 : 0.005);
    std::vector<Vec3> middle = scene.end;
    for (size_t v = 0; v < middle.size(); ++v) middle[v] = 0.5 * (scene.start[v] + scene.end[v]);
    PairCache cached(mesh), uncached(mesh);
    cached.update_bounds({scene.start, scene.start}, {.margin = 0.01, .max_path = 0.0});
    for (PairCache *pairs : {&cached, &uncached}) pairs->begin_move({scene.start, scene.end});
    BOOST_TEST(cached.impact_candidates().size() < size_t(cached.size()));
    BOOST_TEST(impacts(mesh, cached, scene.start, scene.end).size() > 10);
    BOOST_TEST((impacts(mesh, cached, scene.start, scene.end) == impacts(mesh, uncached, scene.start, scene.end)));
    PairCache along_paths(mesh); // bounds around the paths: only vertices with long paths escape
    along_paths.update_bounds({scene.start, scene.end}, {.margin = 0.001, .max_path = 0.02});
    along_paths.begin_move({scene.start, scene.end});
    BOOST_TEST((impacts(mesh, along_paths, scene.start, scene.end) == impacts(mesh, uncached, scene.start, scene.end)));
    const std::vector<unsigned char> changed(scene.start.size(), 1);
    for (PairCache *pairs : {&cached, &uncached, &along_paths}) pairs->update_move({scene.start, middle}, changed);
    BOOST_TEST((impacts(mesh, cached, scene.start, middle) == impacts(mesh, uncached, scene.start, middle)));
    BOOST_TEST((impacts(mesh, along_paths, scene.start, middle) == impacts(mesh, uncached, scene.start, middle)));
    for (PairCache *pairs : {&cached, &uncached, &along_paths}) pairs->commit_move(scene.start, middle);
    BOOST_TEST(contacts(cached, middle).size() > 10);
    BOOST_TEST((contacts(cached, middle) == contacts(uncached, middle)));
    BOOST_TEST((contacts(along_paths, middle) == contacts(uncached, middle)));
    for (PairCache *pairs : {&cached, &uncached, &along_paths}) {
        pairs->begin_move({middle, scene.start});
        pairs->commit_move(middle, scene.start);
    }
    BOOST_TEST((contacts(cached, scene.start) == contacts(uncached, scene.start)));
}

// Long compared with gaps: separating axes cull most of what boxes overlap.
BOOST_AUTO_TEST_CASE(a_long_shared_motion_has_few_impact_candidates) {
    CollisionScene scene(12, 0.0);
    const CollisionMesh &mesh = scene.mesh;
    for (size_t v = 0; v < scene.end.size(); ++v)
        if (mesh.moves[v]) scene.end[v] = scene.start[v] + Vec3(0.05, 0.06, 0.04) + scene.anywhere(0.005);
    PairCache cache(mesh), uncached(mesh);
    cache.update_bounds({scene.start, scene.end}, {.margin = 0.0001, .max_path = 1.0});
    for (PairCache *pairs : {&cache, &uncached}) pairs->begin_move({scene.start, scene.end});
    BOOST_TEST(cache.transient_pairs().empty());
    BOOST_TEST(2 * cache.path_candidates().size() < size_t(cache.size()));
    BOOST_TEST(2 * cache.impact_candidates().size() < cache.path_candidates().size());
    BOOST_TEST(impacts(mesh, cache, scene.start, scene.end).size() > 10);
    BOOST_TEST((impacts(mesh, cache, scene.start, scene.end) == impacts(mesh, uncached, scene.start, scene.end)));
}

// The end moves to anywhere in the triangle of start, first end and apex.
BOOST_AUTO_TEST_CASE(a_curved_path_has_the_impacts_of_all_of_its_triangle) {
    CollisionScene scene(10, 0.0);
    const CollisionMesh &mesh = scene.mesh;
    std::vector<Vec3> via = scene.start, elsewhere = scene.start;
    for (size_t v = 0; v < via.size(); ++v) {
        if (!mesh.moves[v]) continue;
        scene.end[v] = scene.start[v] + scene.anywhere(v % 50 == 0 ? 0.1 : 0.005);
        via[v] = scene.start[v] + scene.anywhere(v % 40 == 0 ? 0.1 : 0.01);
        const double one = double(v % 7) / 6.0;
        elsewhere[v] = scene.start[v] + 0.9 * (one * (scene.end[v] - scene.start[v]) + (1.0 - one) * (via[v] - scene.start[v]));
    }
    PairCache cache(mesh), uncached(mesh);
    cache.update_bounds({scene.start, scene.end, via}, {.margin = 0.0001, .max_path = 0.05});
    cache.begin_move({scene.start, scene.end, via});
    const std::vector<unsigned char> changed(scene.start.size(), 1);
    cache.update_move({scene.start, elsewhere, via}, changed);
    uncached.begin_move({scene.start, elsewhere});
    BOOST_TEST(impacts(mesh, uncached, scene.start, elsewhere).size() > 10);
    BOOST_TEST((impacts(mesh, cache, scene.start, elsewhere) == impacts(mesh, uncached, scene.start, elsewhere)));
    for (PairCache *pairs : {&cache, &uncached}) pairs->commit_move(scene.start, elsewhere);
    BOOST_TEST(contacts(cache, elsewhere).size() > 10);
    BOOST_TEST((contacts(cache, elsewhere) == contacts(uncached, elsewhere)));
}

// Most vertices escape in every move, so that bounds that need not last serve one move. Then everything moves rigidly.
BOOST_AUTO_TEST_CASE(pairs_cached_for_one_move_are_exact_on_it_and_serve_no_other) {
    CollisionScene scene(13, 0.0);
    const CollisionMesh &mesh = scene.mesh;
    PairCache cache(mesh), lasting(mesh);
    std::vector<Vec3> now = scene.start;
    const auto go = [&](double far, bool lasts) {
        std::vector<Vec3> end = now, via = now, to = now;
        for (size_t v = 0; v < now.size(); ++v) {
            if (!mesh.moves[v]) continue;
            end[v] += scene.anywhere(v % 50 == 0 ? 10.0 * far : far);
            via[v] += scene.anywhere(far);
            to[v] += 0.4 * (end[v] - now[v]) + 0.5 * (via[v] - now[v]);
        }
        cache.update_bounds({now, end, via}, {.margin = 0.002, .max_path = 0.05, .lasting = lasts});
        lasting.update_bounds({now, end, via}, {.margin = 0.002, .max_path = 0.05});
        PairCache uncached(mesh);
        for (PairCache *pairs : {&cache, &lasting}) {
            pairs->begin_move({now, end, via});
            pairs->update_move({now, to, via}, std::vector<unsigned char>(now.size(), 1));
        }
        uncached.begin_move({now, to});
        BOOST_TEST(impacts(mesh, uncached, now, to).size() > 10);
        BOOST_TEST((impacts(mesh, cache, now, to) == impacts(mesh, uncached, now, to)));
        for (PairCache *pairs : {&cache, &lasting, &uncached}) pairs->commit_move(now, to);
        now = to;
        BOOST_TEST((contacts(cache, now) == contacts(uncached, now)));
    };
    go(0.01, true), go(0.01, true);
    for (const double far : {0.01, 0.001, 0.0001}) {
        go(far, false);
        BOOST_TEST(cache.size() < lasting.size());
    }
    go(0.01, false); // after pairs for one move all bounds have a margin again
    BOOST_TEST(cache.size() == lasting.size());
    go(0.01, false);
    BOOST_TEST(cache.size() < lasting.size());
    RigidMotion turn{Eigen::AngleAxisd(0.5, Vec3::UnitY()).toRotationMatrix(), now[0], now[1]};
    std::vector<Vec3> to = now;
    for (Vec3 &x : to) x = turn(x);
    for (PairCache *pairs : {&cache, &lasting}) pairs->move_rigidly(now, to);
    now = to;
    go(0.01, true);
    BOOST_TEST(cache.size() == lasting.size());
}

// Everything turns from step to step; then some vertices move little, and some do not stay near.
BOOST_AUTO_TEST_CASE(a_rigid_motion_of_everything_changes_no_impact_and_no_contact) {
    CollisionScene scene(7, 0.0);
    const CollisionMesh &mesh = scene.mesh;
    PairCache cache(mesh);
    std::vector<Vec3> now = scene.start, to(now.size());
    cache.update_bounds({now, now}, {.margin = 0.01, .max_path = 0.0});
    for (int step = 0; step < 8; ++step) {
        const RigidMotion turn{Eigen::AngleAxisd(0.5, Vec3(1.0, 2.0, 2.0) / 3.0).toRotationMatrix(), now[0], now[1]};
        for (size_t v = 0; v < now.size(); ++v) to[v] = turn(now[v]);
        cache.move_rigidly(now, to);
        now = to;
        for (size_t v = 0; v < now.size(); ++v) to[v] = now[v] + scene.anywhere(v % 10 == 0 ? 0.05 : 0.0005);
        PairCache uncached(mesh);
        for (PairCache *pairs : {&cache, &uncached}) pairs->begin_move({now, to});
        BOOST_TEST(impacts(mesh, cache, now, to).size() > 10);
        BOOST_TEST((impacts(mesh, cache, now, to) == impacts(mesh, uncached, now, to)));
        BOOST_TEST(cache.transient_pairs().size() < uncached.transient_pairs().size());
        for (PairCache *pairs : {&cache, &uncached}) pairs->commit_move(now, to);
        now = to;
        BOOST_TEST(contacts(cache, now).size() > 10);
        BOOST_TEST((contacts(cache, now) == contacts(uncached, now)));
        for (size_t v = 0; v < now.size(); ++v)
            if (mesh.moves[v]) to[v] += scene.anywhere(v % 2 == 0 ? 0.002 : 0.01);
        cache.update_bounds({now, to}, {.margin = 0.004, .max_path = 0.1});
        for (PairCache *pairs : {&cache, &uncached}) pairs->begin_move({now, to});
        BOOST_TEST((impacts(mesh, cache, now, to) == impacts(mesh, uncached, now, to)));
        cache.commit_move(now, to);
        now = to;
    }
}

BOOST_AUTO_TEST_SUITE_END()
