// Rigid motions fitted to points, against the motion that moved them.
#include "ringlet/geometry/rigid_motion.h"

#include <Eigen/Geometry>
#include <boost/test/unit_test.hpp>
#include <numeric>
#include <random>

using namespace ringlet;

namespace {

struct Moved {
    std::vector<Vec3> start, end;
    std::vector<int> all;
    RigidMotion motion{Eigen::AngleAxisd(1.2, Vec3(2.0, -1.0, 2.0) / 3.0).toRotationMatrix(), Vec3(0.1, 0.2, 0.3),
                       Vec3(-0.5, 1.0, 0.0)};

    explicit Moved(int count) : start(count), end(count), all(count) {
        std::mt19937 random(1);
        std::uniform_real_distribution<double> in(-0.2, 0.2);
        for (int v = 0; v < count; ++v) {
            start[v] = Vec3(in(random), in(random), in(random));
            end[v] = motion(start[v]);
        }
        std::iota(all.begin(), all.end(), 0);
    }

    double largest_error(const RigidMotion &found) const {
        double most = 0.0;
        for (const Vec3 &x : start) most = std::max(most, (found(x) - motion(x)).norm());
        return most;
    }
};

} // namespace

BOOST_AUTO_TEST_SUITE(rigid_motion)

BOOST_AUTO_TEST_CASE(the_fit_recovers_the_motion_of_points_that_move_rigidly) {
    const Moved moved(50);
    BOOST_TEST(moved.largest_error(fit_rigid_motion(moved.all, moved.start, moved.end)) < 1e-8);
    const RigidMotion none = fit_rigid_motion({}, moved.start, moved.end);
    BOOST_TEST((none(moved.start[0]) == moved.start[0]));
}

BOOST_AUTO_TEST_CASE(outliers_do_not_affect_the_robust_fit) {
    Moved moved(50);
    for (int v = 0; v < 50; v += 3) moved.end[v] += Vec3(0.03, 0.0, 0.05); // a third of the points are outliers
    BOOST_TEST(moved.largest_error(fit_rigid_motion(moved.all, moved.start, moved.end)) > 1e-3);
    BOOST_TEST(moved.largest_error(fit_rigid_motion_robust(moved.all, moved.start, moved.end)) < 1e-8);
}

BOOST_AUTO_TEST_SUITE_END()
