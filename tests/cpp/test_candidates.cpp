// Candidate pairs of many moves, against all pairs.
#include "collision_scene.h"
#include "ringlet/geometry/rigid_motion.h"

#include <Eigen/Geometry>
#include <boost/test/unit_test.hpp>

using namespace ringlet;

BOOST_AUTO_TEST_SUITE(candidates)

// Some vertices escape, most do not. Then all paths are halved, committed and reversed.
BOOST_AUTO_TEST_CASE(no_impact_and_no_contact_is_missed_on_moves_of_long_and_short_paths) {
    CollisionScene scene(6, 0.0);
    const CollisionMesh &mesh = scene.mesh;
    for (size_t v = 0; v < scene.end.size(); ++v)
        scene.end[v] = scene.start[v] + scene.anywhere(!mesh.moves[v] ? 0.0 : v % 50 == 0 ? 0.1 : 0.005);
    std::vector<Vec3> middle = scene.end;
    for (size_t v = 0; v < middle.size(); ++v) middle[v] = 0.5 * (scene.start[v] + scene.end[v]);
    const Move rest{scene.start, scene.start}, all{scene.start, scene.end};
    const std::vector<unsigned char> changed(scene.start.size(), 1);
    for (const auto &[enclosed, how] : {std::pair(rest, MotionBounds::Fit{0.01, 0.0}), {all, {0.001, 0.02}}}) {
        Candidates candidates(mesh);
        MoveCandidates pairs(candidates);
        candidates.enclose(enclosed, how);
        pairs.begin(all);
        BOOST_TEST(pairs.any_escaped());
        BOOST_TEST(pairs.impact_candidates().size() < size_t(pairs.size()));
        BOOST_TEST(impacts(mesh, pairs, scene.start, scene.end).size() > 10);
        BOOST_TEST((impacts(mesh, pairs, scene.start, scene.end) == all_impacts(mesh, scene.start, scene.end)));
        pairs.update({scene.start, middle}, changed);
        BOOST_TEST((impacts(mesh, pairs, scene.start, middle) == all_impacts(mesh, scene.start, middle)));
        pairs.commit(scene.start, middle);
        BOOST_TEST(contacts(pairs, middle).size() > 10);
        BOOST_TEST((contacts(pairs, middle) == all_contacts(mesh, middle)));
        pairs.begin({middle, scene.start});
        pairs.commit(middle, scene.start);
        BOOST_TEST((contacts(pairs, scene.start) == all_contacts(mesh, scene.start)));
    }
}

// Long compared with gaps: separating axes cull most of what boxes overlap.
BOOST_AUTO_TEST_CASE(a_long_shared_motion_has_few_impact_candidates) {
    CollisionScene scene(12, 0.0);
    const CollisionMesh &mesh = scene.mesh;
    for (size_t v = 0; v < scene.end.size(); ++v)
        if (mesh.moves[v]) scene.end[v] = scene.start[v] + Vec3(0.05, 0.06, 0.04) + scene.anywhere(0.005);
    Candidates candidates(mesh);
    MoveCandidates pairs(candidates);
    candidates.enclose({scene.start, scene.end}, {.margin = 0.0001, .max_path = 1.0});
    pairs.begin({scene.start, scene.end});
    BOOST_TEST(pairs.transient_pairs().empty());
    BOOST_TEST(2 * pairs.path_candidates().size() < size_t(pairs.size()));
    BOOST_TEST(2 * pairs.impact_candidates().size() < pairs.path_candidates().size());
    BOOST_TEST(impacts(mesh, pairs, scene.start, scene.end).size() > 10);
    BOOST_TEST((impacts(mesh, pairs, scene.start, scene.end) == all_impacts(mesh, scene.start, scene.end)));
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
    Candidates candidates(mesh);
    MoveCandidates pairs(candidates);
    candidates.enclose({scene.start, scene.end, via}, {.margin = 0.0001, .max_path = 0.05});
    pairs.begin({scene.start, scene.end, via});
    pairs.update({scene.start, elsewhere, via}, std::vector<unsigned char>(scene.start.size(), 1));
    BOOST_TEST(impacts(mesh, pairs, scene.start, elsewhere).size() > 10);
    BOOST_TEST((impacts(mesh, pairs, scene.start, elsewhere) == all_impacts(mesh, scene.start, elsewhere)));
    pairs.commit(scene.start, elsewhere);
    BOOST_TEST(contacts(pairs, elsewhere).size() > 10);
    BOOST_TEST((contacts(pairs, elsewhere) == all_contacts(mesh, elsewhere)));
}

// What a pair that was shortened knows holds where its partner goes elsewhere next.
BOOST_AUTO_TEST_CASE(a_shortened_path_counts_where_others_change_afterwards) {
    CollisionScene scene(11, 0.0);
    const CollisionMesh &mesh = scene.mesh;
    for (size_t v = 0; v < scene.end.size(); ++v)
        if (mesh.moves[v]) scene.end[v] = scene.start[v] + scene.anywhere(v % 50 == 0 ? 0.1 : 0.02);
    std::vector<unsigned char> odd(scene.start.size(), 0), even(scene.start.size(), 0);
    for (size_t v = 0; v < odd.size(); ++v) (mesh.object[v] % 2 == 1 ? odd : even)[v] = 1;
    Candidates candidates(mesh);
    MoveCandidates pairs(candidates);
    candidates.enclose({scene.start, scene.end}, {.margin = 0.001, .max_path = 0.05});
    pairs.begin({scene.start, scene.end});
    std::vector<Vec3> to = scene.end;
    for (size_t v = 0; v < to.size(); ++v)
        if (odd[v]) to[v] = 0.7 * scene.start[v] + 0.3 * to[v];
    pairs.shorten({scene.start, to}, odd);
    for (size_t v = 0; v < to.size(); ++v)
        if (even[v]) to[v] = 0.5 * (scene.start[v] + to[v]);
    pairs.update({scene.start, to}, even);
    Pairs expected;
    for (const PrimitivePair &pair : all_pairs(mesh))
        with_vertices(mesh, pair, [&](const auto &a, const auto &b) {
            if ((even[a[0]] || even[b[0]]) && has_impact(mesh, pair, scene.start, to)) expected.insert(name(pair));
        });
    BOOST_TEST(expected.size() > 10);
    BOOST_TEST((impacts(mesh, pairs, scene.start, to) == expected));
}

// Most vertices leave their bounds in every move, so that pairs are found for one move alone. Then everything turns.
BOOST_AUTO_TEST_CASE(pairs_found_for_one_move_are_exact_on_it_and_serve_no_other) {
    CollisionScene scene(13, 0.0);
    const CollisionMesh &mesh = scene.mesh;
    Candidates candidates(mesh), lasting(mesh);
    MoveCandidates pairs(candidates);
    std::vector<Vec3> now = scene.start;
    const auto go = [&](double far, Candidates::Serve serve) {
        std::vector<Vec3> end = now, via = now, to = now;
        for (size_t v = 0; v < now.size(); ++v) {
            if (!mesh.moves[v]) continue;
            end[v] += scene.anywhere(v % 50 == 0 ? 10.0 * far : far);
            via[v] += scene.anywhere(far);
            to[v] += 0.4 * (end[v] - now[v]) + 0.5 * (via[v] - now[v]);
        }
        const Move move{now, end, via};
        candidates.enclose(move, {0.002, 0.05}, serve);
        lasting.enclose(move, {0.002, 0.05});
        pairs.begin(move);
        pairs.update({now, to, via}, std::vector<unsigned char>(now.size(), 1));
        BOOST_TEST((impacts(mesh, pairs, now, to) == all_impacts(mesh, now, to)));
        pairs.commit(now, to);
        now = to;
        BOOST_TEST((contacts(pairs, now) == all_contacts(mesh, now)));
        return candidates.pairs().size() < lasting.pairs().size();
    };
    using enum Candidates::Serve;
    BOOST_TEST(!go(0.01, later_moves));
    BOOST_TEST(!go(0.01, later_moves));
    for (const double far : {0.01, 0.02, 0.01}) BOOST_TEST(go(far, this_move));
    const RigidMotion turn{Eigen::AngleAxisd(0.5, Vec3::UnitY()).toRotationMatrix(), now[0], now[1]};
    const auto turn_all = [&] {
        for (Candidates *all : {&candidates, &lasting}) all->move_rigidly(turn, now);
        for (Vec3 &x : now) x = turn(x);
    };
    go(0.0001, this_move); // a short move again: not for it alone
    turn_all();
    BOOST_TEST(!candidates.empty());
    BOOST_TEST(go(0.01, this_move));
    turn_all();
    BOOST_TEST(candidates.empty());
    BOOST_TEST(!go(0.01, later_moves));
}

// Everything turns from step to step; then some vertices move little, and some do not stay near.
BOOST_AUTO_TEST_CASE(a_rigid_motion_of_everything_changes_no_impact_and_no_contact) {
    CollisionScene scene(7, 0.0);
    const CollisionMesh &mesh = scene.mesh;
    Candidates candidates(mesh);
    MoveCandidates pairs(candidates);
    std::vector<Vec3> now = scene.start, to(now.size());
    candidates.enclose({now, now}, {.margin = 0.01, .max_path = 0.0});
    int transient = 0;
    for (int step = 0; step < 8; ++step) {
        const double angle = step % 2 == 0 ? 0.05 : 0.5; // about as much as a head turns, and more than bounds can follow
        const RigidMotion turn{Eigen::AngleAxisd(angle, Vec3(1.0, 2.0, 2.0) / 3.0).toRotationMatrix(), now[0], now[1]};
        candidates.move_rigidly(turn, now);
        for (Vec3 &x : now) x = turn(x);
        for (size_t v = 0; v < now.size(); ++v) to[v] = now[v] + scene.anywhere(v % 10 == 0 ? 0.05 : 0.0005);
        pairs.begin({now, to});
        BOOST_TEST(impacts(mesh, pairs, now, to).size() > 10);
        BOOST_TEST((impacts(mesh, pairs, now, to) == all_impacts(mesh, now, to)));
        if (step % 2 == 0) transient += int(pairs.transient_pairs().size());
        pairs.commit(now, to);
        now = to;
        BOOST_TEST(contacts(pairs, now).size() > 10);
        BOOST_TEST((contacts(pairs, now) == all_contacts(mesh, now)));
        for (size_t v = 0; v < now.size(); ++v)
            if (mesh.moves[v]) to[v] += scene.anywhere(v % 2 == 0 ? 0.002 : 0.01);
        candidates.enclose({now, to}, {.margin = 0.004, .max_path = 0.1});
        pairs.begin({now, to});
        BOOST_TEST((impacts(mesh, pairs, now, to) == all_impacts(mesh, now, to)));
        pairs.commit(now, to);
        now = to;
    }
    BOOST_TEST(transient < 4 * int(candidates.pairs().size()));
}

BOOST_AUTO_TEST_SUITE_END()
