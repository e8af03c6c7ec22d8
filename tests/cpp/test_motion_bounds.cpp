// Motion bounds and the vertices that escape them.
#include "random.h"
#include "ringlet/collision/motion_bounds.h"

#include <Eigen/Geometry>
#include <boost/test/unit_test.hpp>

using namespace ringlet;

namespace {

CollisionMesh points(int count) {
    CollisionMesh mesh;
    for (int v = 0; v < count; ++v) mesh.rest.emplace_back(v, 0.0, 0.0);
    mesh.radius.assign(count, 0.01);
    mesh.moves.assign(count, 1);
    mesh.object.assign(count, 0);
    mesh.anchor.assign(count, -1);
    return mesh;
}

} // namespace

BOOST_AUTO_TEST_SUITE(motion_bounds)

BOOST_AUTO_TEST_CASE(a_vertex_escapes_where_its_path_leaves_its_bound) {
    const CollisionMesh mesh = points(4);
    MotionBounds bounds(mesh);
    std::vector<Vec3> end = mesh.rest, apex = mesh.rest;
    bounds.fit({mesh.rest, mesh.rest}, {0.1, 1.0});
    end[1].y() += 0.09;
    end[2].y() += 0.11;
    apex[3].z() -= 0.11;
    BOOST_TEST((bounds.escaped({mesh.rest, end, apex}) == std::vector<unsigned char>{0, 0, 1, 1}));
}

// Of vertices anywhere in their bounds, and one that has left its own.
BOOST_AUTO_TEST_CASE(a_bound_that_moves_rigidly_stays_inside_the_old_one) {
    const CollisionMesh mesh = points(200);
    Random random{std::mt19937(1)};
    MotionBounds before(mesh);
    before.fit({mesh.rest, mesh.rest}, {0.1, 1.0});
    std::vector<Vec3> from = mesh.rest;
    for (Vec3 &x : from) x += random.vector(0.06);
    from[0] = mesh.rest[0] + Vec3(0.0, 0.2, 0.0);
    for (const double angle : {0.0, 0.01, 0.1, 0.3}) {
        const RigidMotion motion{Eigen::AngleAxisd(angle, Vec3(2.0, 1.0, 2.0) / 3.0).toRotationMatrix(), Vec3::Zero(),
                                 Vec3(3.0, 0.0, 0.0)};
        MotionBounds after = before;
        after.move_rigidly(motion, from);
        int inside = 0;
        for (int sample = 0; sample < 50; ++sample) {
            std::vector<Vec3> to = from, turned;
            for (Vec3 &x : to) x += random.vector(0.1);
            for (const Vec3 &x : to) turned.push_back(motion(x));
            const std::vector<unsigned char> left = before.escaped({from, to});
            std::vector<Vec3> start;
            for (const Vec3 &x : from) start.push_back(motion(x));
            const std::vector<unsigned char> left_after = after.escaped({start, turned});
            BOOST_TEST(left_after[0]);
            for (size_t v = 0; v < to.size(); ++v) {
                BOOST_TEST((left_after[v] || !left[v]), "vertex " << v << " turned by " << angle);
                inside += !left_after[v];
                if (angle == 0.0 && v > 0) BOOST_TEST(left_after[v] == left[v]); // a translation loses nothing
            }
        }
        BOOST_TEST(inside > 200);
    }
}

BOOST_AUTO_TEST_CASE(the_bound_of_a_long_path_encloses_its_start_alone) {
    const CollisionMesh mesh = points(2);
    MotionBounds bounds(mesh);
    std::vector<Vec3> end = mesh.rest;
    end[0].y() += 0.5, end[1].y() += 2.0;
    const Move move{mesh.rest, end};
    bounds.fit(move, {0.1, 1.0});
    BOOST_TEST(bounds.outside(move, 1.0).empty()); // of the long path nothing more is asked
    BOOST_TEST((bounds.escaped(move) == std::vector<unsigned char>{0, 1}));
    end[0].y() += 0.2;
    BOOST_TEST((bounds.outside(move, 1.0) == std::vector<int>{0}));
    bounds.fit(move, {0.1, 1.0}, {0});
    BOOST_TEST(!bounds.escaped(move)[0]);
}

BOOST_AUTO_TEST_SUITE_END()
