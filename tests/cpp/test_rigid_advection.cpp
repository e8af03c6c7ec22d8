// Motion bounds and pairs that are advected with a rigid motion.
#include "collision_scene.h"
#include "ringlet/collision/rigid_advection.h"

#include <boost/test/unit_test.hpp>

using namespace ringlet;

namespace {

CollisionMesh two_vertices(double radius) {
    CollisionMesh mesh;
    mesh.rest = {Vec3(0.0, 0.0, 0.0), Vec3(1.0, 0.0, 0.0)};
    mesh.radius.assign(2, radius);
    mesh.moves.assign(2, 1);
    mesh.object.assign(2, 0);
    mesh.anchor.assign(2, -1);
    mesh.edges = {{0, 1}};
    return mesh;
}

} // namespace

BOOST_AUTO_TEST_SUITE(rigid_advection)

BOOST_AUTO_TEST_CASE(an_advected_bound_is_inside_the_old_one_and_a_deviating_vertex_escapes) {
    const CollisionMesh mesh = two_vertices(0.01);
    MotionBounds bounds(mesh);
    RigidAdvection advection(mesh);
    bounds.fit({mesh.rest, mesh.rest}, {0.1, 1.0});
    const RigidMotion turn{Eigen::AngleAxisd(0.5, Vec3::UnitZ()).toRotationMatrix(), Vec3::Zero(), Vec3(3.0, 0.0, 0.0)};
    const std::vector<Vec3> end = {turn(mesh.rest[0]) + Vec3(0.0005, 0.0, 0.0), turn(mesh.rest[1]) + Vec3(0.002, 0.0, 0.0)};
    const Move move{mesh.rest, end};
    advection.begin(move, turn, std::vector<int>{0, 0}, std::vector<unsigned char>{1, 1}, true, bounds);
    BOOST_TEST(!bounds.escaped()[0]);
    BOOST_TEST(bounds.escaped()[1]); // by more than a tenth of the radius
    advection.advect(move, bounds);
    BOOST_TEST(bounds.clearance(0, end[0]) == (0.1 - 0.0005) / std::sqrt(3.0), boost::test_tools::tolerance(1e-9));
    BOOST_TEST(bounds.clearance(1, end[1]) < 0.0);
}

BOOST_AUTO_TEST_CASE(straight_paths_under_a_rotation_keep_the_cosine_of_half_its_angle) {
    const RigidMotion turn{Eigen::AngleAxisd(1.2, Vec3(1.0, 2.0, 2.0) / 3.0).toRotationMatrix(), Vec3::Zero(), Vec3::Zero()};
    const Vec3 across = Vec3(2.0, -1.0, 0.0).normalized();
    BOOST_TEST(RigidAdvection::kept_distance(turn) == (0.5 * (across + turn(across))).norm(),
               boost::test_tools::tolerance(1e-12));
}

// Objects turn together from step to step, most vertices nearly exactly, some not at all; in between each moves by itself.
BOOST_AUTO_TEST_CASE(cached_pairs_are_advected_with_a_nearly_rigid_motion) {
    CollisionScene scene(7, 0.0);
    const CollisionMesh &mesh = scene.mesh;
    const double radius = *std::min_element(mesh.radius.begin(), mesh.radius.end());
    const auto of_two_objects = [&](Pairs pairs) {
        std::erase_if(pairs, [&](const auto &pair) {
            const int second = pair[0] ? mesh.edges[pair[2]][0] : mesh.triangles[pair[2]][0];
            return mesh.object[pair[0] ? mesh.edges[pair[1]][0] : pair[1]] == mesh.object[second];
        });
        return pairs;
    };
    PairCache cache(mesh);
    cache.update_bounds({scene.start, scene.start}, {.margin = 0.01, .max_path = 0.0});
    std::vector<Vec3> now = scene.start, to(now.size());
    for (int step = 0; step < 8; ++step) {
        const RigidMotion motion{Eigen::AngleAxisd(0.5, Vec3(1.0, 2.0, 2.0) / 3.0).toRotationMatrix(), now[0], now[1]};
        for (size_t v = 0; v < now.size(); ++v)
            to[v] = v % 10 == 0 ? now[v] + scene.anywhere(0.05) : motion(now[v]) + scene.anywhere(0.05 * radius);
        PairCache uncached(mesh);
        uncached.begin_move({now, to});
        cache.begin_rigid_move({now, to}, motion, mesh.object);
        BOOST_TEST((of_two_objects(impacts(mesh, cache, now, to)) == of_two_objects(impacts(mesh, uncached, now, to))));
        BOOST_TEST(of_two_objects(impacts(mesh, cache, now, to)).size() > 10);
        BOOST_TEST(cache.transient_pairs().size() < uncached.transient_pairs().size());
        uncached.commit_move(now, to);
        cache.commit_rigid_move(now, to);
        BOOST_TEST(cache.is_complete());
        BOOST_TEST(contacts(cache, to).size() > 10);
        BOOST_TEST((contacts(cache, to) == contacts(uncached, to)));
        now = to;
        for (size_t v = 0; v < now.size(); ++v)
            if (mesh.moves[v]) to[v] += scene.anywhere(v % 2 == 0 ? 0.002 : 0.01);
        cache.update_bounds({now, to}, {.margin = 0.004, .max_path = 0.1});
        cache.begin_move({now, to});
        uncached.begin_move({now, to});
        BOOST_TEST((impacts(mesh, cache, now, to) == impacts(mesh, uncached, now, to)));
        cache.commit_move(now, to);
        now = to;
    }
}

// Some vertices of a rigid move change their ends, twice.
BOOST_AUTO_TEST_CASE(an_updated_rigid_move_has_the_impacts_of_what_changed) {
    for (const bool knows : {true, false}) {
        CollisionScene scene(9, 0.0);
        const CollisionMesh &mesh = scene.mesh;
        const std::vector<Vec3> &now = scene.start;
        const RigidMotion motion{Eigen::AngleAxisd(0.5, Vec3(1.0, 2.0, 2.0) / 3.0).toRotationMatrix(), now[0], now[1]};
        std::vector<int> rigid(now.size(), 0);
        std::vector<Vec3> to(now.size());
        for (size_t v = 0; v < now.size(); ++v) {
            if (v % 10 == 0) rigid[v] = -1;
            to[v] = motion(now[v]) + scene.anywhere(v % 10 == 0 ? 0.05 : 0.0);
        }
        PairCache cache(mesh);
        if (knows) cache.update_bounds({now, now}, {.margin = 0.01, .max_path = 0.0});
        cache.begin_rigid_move({now, to}, motion, rigid);
        for (int round = 0; round < 2; ++round) {
            std::vector<unsigned char> changed(now.size(), 0);
            for (size_t v = round; v < now.size(); v += 7) {
                changed[v] = 1;
                if (!mesh.moves[v]) continue;
                rigid[v] = -1;
                to[v] += scene.anywhere(v % 2 == 0 ? 0.0001 : 0.1);
            }
            cache.update_rigid_move({now, to}, motion, rigid, changed);
            PairCache uncached(mesh);
            uncached.begin_move({now, to});
            Pairs all = impacts(mesh, uncached, now, to);
            std::erase_if(all, [&](const auto &pair) {
                const auto any = [&](const auto &primitive) { return any_of(View<unsigned char>(changed), primitive); };
                return !(pair[0] ? any(mesh.edges[pair[1]]) || any(mesh.edges[pair[2]])
                                 : any(std::array{pair[1]}) || any(mesh.triangles[pair[2]]));
            });
            BOOST_TEST(all.size() > 10);
            BOOST_TEST((impacts(mesh, cache, now, to) == all));
        }
        cache.commit_rigid_move(now, to);
        PairCache uncached(mesh);
        uncached.begin_move({now, to});
        uncached.commit_move(now, to);
        BOOST_TEST(contacts(cache, to).size() > 10);
        BOOST_TEST((contacts(cache, to) == contacts(uncached, to)));
    }
}

BOOST_AUTO_TEST_CASE(a_small_deviation_is_subtracted_from_the_bound_on_the_gap) {
    CollisionMesh mesh; // two edges, a twentieth beyond their activation distance
    mesh.rest = {{0.0, 0.0, 0.0}, {0.01, 0.0, 0.0}, {0.0, 0.0015, 0.0015}, {0.01, 0.0015, 0.0015}};
    mesh.edges = {{0, 1}, {2, 3}};
    mesh.radius.assign(4, 0.001);
    mesh.moves.assign(4, 1);
    mesh.object = {0, 0, 1, 1};
    mesh.anchor.assign(4, -1);
    PairCache cache(mesh);
    cache.update_bounds({mesh.rest, mesh.rest}, {.margin = 0.001, .max_path = 0.0});
    BOOST_TEST(contacts(cache, mesh.rest).empty());
    std::vector<Vec3> to = mesh.rest;
    for (int v = 0; v < 4; ++v) to[v] += (v < 2 ? 1.0 : -1.0) * Vec3(0.0, 0.00006, 0.00006);
    cache.begin_rigid_move({mesh.rest, to}, RigidMotion(), mesh.object);
    cache.commit_rigid_move(mesh.rest, to);
    BOOST_TEST(cache.transient_pairs().empty());
    BOOST_TEST(contacts(cache, to).size() == 1u);
}

BOOST_AUTO_TEST_CASE(a_rotation_by_half_a_turn_advects_nothing) {
    CollisionScene scene(8, 0.0);
    const CollisionMesh &mesh = scene.mesh;
    const RigidMotion motion{Eigen::AngleAxisd(3.0, Vec3::UnitX()).toRotationMatrix(), scene.start[0], scene.start[0]};
    for (size_t v = 0; v < scene.end.size(); ++v) scene.end[v] = motion(scene.start[v]);
    PairCache cache(mesh), uncached(mesh);
    cache.update_bounds({scene.start, scene.start}, {.margin = 0.01, .max_path = 0.0});
    cache.begin_rigid_move({scene.start, scene.end}, motion, mesh.object);
    uncached.begin_move({scene.start, scene.end});
    BOOST_TEST((impacts(mesh, cache, scene.start, scene.end) == impacts(mesh, uncached, scene.start, scene.end)));
}

BOOST_AUTO_TEST_SUITE_END()
