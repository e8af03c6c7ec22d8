// The configuration and the path limiter: moves end before pairs come too close, and what meets nothing moves fully.
#include "ringlet/math/parallel_copy.h"
#include "ringlet/solver/search_path.h"
#include "spring_masses.h"

#include <Eigen/Geometry>
#include <boost/test/unit_test.hpp>

using namespace ringlet;

namespace {

// A mass above a triangle, and one far away.
SpringScene above_a_triangle() {
    SpringScene scene;
    scene.add_masses({{0.0, 0.0, 0.01}}, 1e-3, 1.0);
    scene.add_masses({{1.0, 0.0, 0.01}}, 1e-3, 1.0);
    scene.add_triangle({-0.1, -0.1, 0.0}, {0.1, -0.1, 0.0}, {0.0, 0.1, 0.0});
    scene.finish();
    return scene;
}

} // namespace

BOOST_AUTO_TEST_SUITE(configuration)

BOOST_AUTO_TEST_CASE(a_limited_move_ends_above_the_surface_and_leaves_others_alone) {
    SpringScene scene = above_a_triangle();
    PlannedMove move{scene.positions, {}};
    for (const int v : {0, 1}) move.to[v].z() = -0.05;
    SceneReport report{};
    scene.configuration->limit(move, Yield::as_a_whole, Candidates::Serve::later_moves, report);
    BOOST_TEST(move.to[0].z() > 0.0);
    BOOST_TEST(move.to[0].z() < 0.01);
    BOOST_TEST(move.to[1].z() == -0.05);
    BOOST_TEST(report.violations == 1.0);
    scene.configuration->commit(move.to);
    BOOST_TEST((scene.configuration->positions == move.to));
}

BOOST_AUTO_TEST_CASE(recorded_positions_begin_with_the_frame_of_the_step_and_follow_each_move) {
    SpringScene scene = above_a_triangle();
    scene.configuration->record(true);
    const RigidMotion turn{Eigen::AngleAxisd(0.5, Vec3::UnitZ()).toRotationMatrix(), Vec3::Zero(), Vec3(0.0, 1.0, 0.0)};
    scene.configuration->begin_step(turn);
    std::vector<Vec3> begin;
    for (const Vec3 &x : scene.positions) begin.push_back(turn(x));
    PlannedMove move{begin, {}};
    move.to[1].x() += 0.1;
    SceneReport report{};
    scene.configuration->limit(move, Yield::as_a_whole, Candidates::Serve::later_moves, report);
    scene.configuration->commit(move.to);
    BOOST_REQUIRE(scene.configuration->recorded().size() == 2u);
    BOOST_TEST((scene.configuration->recorded()[0] == begin));
    BOOST_TEST((scene.configuration->recorded()[1] == move.to));
}

BOOST_AUTO_TEST_CASE(a_limited_path_leads_where_its_move_ends) {
    SpringScene scene = above_a_triangle();
    scene.begin(0.01);
    scene.objective->find_contacts({}, scene.all_objects(), scene.positions, scene.positions);
    const AlignedVector x = scene.unknowns();
    SearchPath path(scene.blocks->size());
    path.straight[2] = path.straight[5] = -0.05; // both masses down
    path.bend[0] = path.bend[3] = 0.01;          // on parabolas
    const std::vector<unsigned char> none(2, 0);
    SceneReport report{};
    const auto [move, moves] = limit_path(*scene.objective, *scene.configuration, x,
                                          {Candidates::Serve::later_moves, Yield::as_a_whole, none}, path, report);
    BOOST_TEST(move.to[0].z() > 0.0);
    BOOST_TEST((move.to[1] - Vec3(1.01, 0.0, -0.04)).norm() < 1e-15);
    BOOST_TEST(path.bend[3] == 0.01);
    const double left = move.to[0].x() / 0.01; // of the path of the first, which goes on bending
    BOOST_TEST((left > 0.0 && left < 1.0));
    BOOST_TEST(path.bend[0] > 0.0);
    BOOST_TEST(!moves.are_full());
    BOOST_TEST(moves.fraction[0] < 1.0);
    BOOST_TEST(moves.fraction[1] == 1.0);
    AlignedVector end = parallel_copy(x);
    move_along(*scene.blocks, x, {1.0, 1.0}, path, {1, 1}, end);
    for (const int v : {0, 1}) BOOST_TEST((scene.blocks->position(end, v) - move.to[v]).norm() < 1e-15);
}

BOOST_AUTO_TEST_CASE(a_line_search_shortens_a_path_whose_energy_rises) {
    SpringScene scene = above_a_triangle();
    scene.begin(0.01);
    scene.objective->find_contacts({}, scene.all_objects(), scene.positions, scene.positions);
    const AlignedVector x = scene.unknowns();
    scene.masses[0]->anchors()[0].z() += 1e-3;
    scene.system->assemble(x, {});
    SearchPath path(scene.blocks->size());
    scene.system->solve({}, path.straight);
    for (int i = 0; i < 3; ++i) path.straight[i] *= 5.0; // far beyond the minimum
    const double wanted = path.straight[2];
    AlignedVector end = parallel_copy(x);
    const LineSearchResult found = line_search(*scene.objective, {}, path, {0, 0}, end);
    BOOST_TEST(found.step[0] == 0.25);
    BOOST_TEST(end[2] - x[2] == 0.25 * wanted, boost::test_tools::tolerance(1e-9));
}

BOOST_AUTO_TEST_CASE(numbers_of_lanes_are_products_and_points_of_each_system) {
    const double a[4] = {1, 2, 3, 4}, b[4] = {2, 2, 2, 2};
    double dot = 0.0;
    lane_dots(a, b, 4, 1, &dot);
    BOOST_TEST(dot == 20.0);
    const int lanes = RINGLET_DISPATCH(lane_width);
    AlignedVector x(3 * lanes), straight(3 * lanes), bend(3 * lanes), to(3 * lanes);
    std::vector<double> dots(lanes), t(lanes);
    for (int l = 0; l < lanes; ++l) {
        t[l] = 0.1 * l;
        for (int r = 0; r < 3; ++r) x[r * lanes + l] = r + l, straight[r * lanes + l] = 1.0 + r, bend[r * lanes + l] = l;
    }
    lane_dots(x.data(), straight.data(), 3, lanes, dots.data());
    lane_points(x.data(), t.data(), straight.data(), bend.data(), 3, lanes, to.data());
    for (int l = 0; l < lanes; ++l) {
        BOOST_TEST(dots[l] == 8.0 + 6.0 * l);
        for (int r = 0; r < 3; ++r) BOOST_TEST(std::abs(to[r * lanes + l] - (r + l + t[l] * (1.0 + r + t[l] * l))) < 1e-14);
    }
}

BOOST_AUTO_TEST_SUITE_END()
