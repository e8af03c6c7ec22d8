// Frames, normals, closest points and signed distances.
#include "ringlet/geometry/distance.h"
#include "ringlet/geometry/frames.h"
#include "ringlet/geometry/near_segments.h"
#include "ringlet/geometry/resample.h"
#include "ringlet/geometry/solid.h"
#include "ringlet/geometry/triangle_tree.h"
#include "shapes.h"

#include <Eigen/LU>
#include <boost/test/unit_test.hpp>

using namespace ringlet;

BOOST_AUTO_TEST_SUITE(geometry)

BOOST_AUTO_TEST_CASE(the_tree_finds_the_closest_point_of_all_triangles) {
    const OwnedMesh soup = triangle_soup(300);
    const TriangleTree tree(soup.view());
    std::mt19937 random(5);
    std::uniform_real_distribution<double> in(-0.5, 1.5);
    for (int i = 0; i < 200; ++i) {
        const Vec3 p(in(random), in(random), in(random));
        double nearest = 1e9;
        for (int t = 0; t < 300; ++t) nearest = std::min(nearest, closest_point(soup.view(), t, p).distance);
        BOOST_TEST(tree.closest(p).distance == nearest, boost::test_tools::tolerance(1e-12));
    }
}

BOOST_AUTO_TEST_CASE(a_search_within_a_distance_finds_nothing_beyond_it) {
    const OwnedMesh mesh = octahedron();
    const TriangleTree tree(mesh.view());
    BOOST_TEST(tree.closest({2.0, 0.0, 0.0}, 0.9).triangle == -1);
    BOOST_TEST(tree.closest({2.0, 0.0, 0.0}, 1.1).distance == 1.0);
}

BOOST_AUTO_TEST_CASE(a_box_query_finds_each_triangle_whose_box_overlaps_once_and_no_others) {
    const OwnedMesh soup = triangle_soup(300);
    const TriangleTree tree(soup.view());
    std::mt19937 random(11);
    std::uniform_real_distribution<double> in(-0.2, 1.2);
    for (int run = 0; run < 100; ++run) {
        const Vec3 a(in(random), in(random), in(random)), b(in(random), in(random), in(random));
        const Eigen::AlignedBox3d asked(a.cwiseMin(b), a.cwiseMax(b));
        std::vector<int> expected, found;
        for (int t = 0; t < 300; ++t) {
            Eigen::AlignedBox3d box;
            for (int k = 0; k < 3; ++k) box.extend(soup.view().corner(t, k));
            if (box.intersects(asked)) expected.push_back(t);
        }
        tree.overlapping(asked.min(), asked.max(), found);
        std::ranges::sort(found);
        BOOST_TEST(found == expected, boost::test_tools::per_element());
    }
}

BOOST_AUTO_TEST_CASE(the_closest_point_of_a_triangle_is_nearer_than_any_other) {
    const OwnedMesh soup = triangle_soup(20);
    std::mt19937 random(6);
    std::uniform_real_distribution<double> in(0.0, 1.0);
    for (int t = 0; t < 20; ++t) {
        const Vec3 p(in(random), in(random), in(random));
        const SurfacePoint nearest = closest_point(soup.view(), t, p);
        BOOST_TEST(nearest.barycentric.minCoeff() >= 0.0);
        BOOST_TEST((soup.view().at(t, nearest.barycentric) - nearest.position).norm() < 1e-14);
        for (int k = 0; k < 100; ++k) {
            const double root = std::sqrt(in(random)), v = in(random);
            const Vec3 other = soup.view().at(t, {1.0 - root, root * (1.0 - v), root * v});
            BOOST_TEST((other - p).norm() >= nearest.distance - 1e-12);
        }
    }
}

BOOST_AUTO_TEST_CASE(vertex_normals_point_outward_and_do_not_depend_on_the_triangulation) {
    const OwnedMesh mesh = octahedron();
    const std::vector<Vec3> normals = vertex_normals(mesh.view());
    for (size_t i = 0; i < mesh.points.size(); ++i) BOOST_TEST((normals[i] - mesh.points[i]).norm() < 1e-12);
}

BOOST_AUTO_TEST_CASE(surface_frames_are_rotations) {
    const OwnedMesh mesh = octahedron();
    const std::vector<Vec3> normals = vertex_normals(mesh.view());
    for (int t = 0; t < 8; ++t) {
        const Mat3 frame = surface_frame(mesh.view(), normals, t, {0.5, 0.2, 0.3});
        BOOST_TEST((frame * frame.transpose() - Mat3::Identity()).norm() < 1e-12);
        BOOST_TEST(frame.determinant() > 0.0);
        BOOST_TEST(frame.col(2).dot(mesh.view().at(t, {0.5, 0.2, 0.3})) > 0.0);
    }
}

BOOST_AUTO_TEST_CASE(a_closed_curve_turns_the_transported_axis_by_the_solid_angle_of_its_tangents) {
    // Tangents that go once around a cone of half-angle b enclose the solid angle 2π (1 - cos b) on the sphere of directions.
    constexpr int count = 20000;
    const double slope = 0.7;
    std::vector<Vec3> points, tangent(count), axis(count);
    for (int i = 0; i < count; ++i) {
        const double phase = 2.0 * std::numbers::pi * i / (count - 1);
        points.emplace_back(std::cos(phase), slope * phase, std::sin(phase));
    }
    tangents(points, tangent);
    transport(points, tangent, Vec3::UnitX(), axis);
    const double cos_b = slope / std::hypot(1.0, slope);
    BOOST_TEST(axis.front().dot(axis.back()) == std::cos(2.0 * std::numbers::pi * (1.0 - cos_b)),
               boost::test_tools::tolerance(1e-3));
}

BOOST_AUTO_TEST_CASE(the_spline_passes_through_its_points_with_continuous_curvature) {
    std::vector<Vec3> points;
    for (int i = 0; i < 6; ++i) points.emplace_back(i, 0.5 * i * i, i == 3 ? 1.0 : 2.0); // unevenly spaced
    const std::vector<Cubic> pieces = spline(points);
    BOOST_REQUIRE(pieces.size() == 5);
    for (size_t i = 0; i < pieces.size(); ++i) {
        BOOST_TEST((pieces[i](0.0) - points[i]).norm() == 0.0);
        BOOST_TEST((pieces[i](1.0) - points[i + 1]).norm() < 1e-12);
    }
    for (size_t i = 0; i + 1 < pieces.size(); ++i) {
        const Cubic &a = pieces[i], &b = pieces[i + 1];
        const double ha = (points[i + 1] - points[i]).norm(), hb = (points[i + 2] - points[i + 1]).norm();
        BOOST_TEST(((a.c1 + 2.0 * a.c2 + 3.0 * a.c3) / ha - b.c1 / hb).norm() < 1e-12);
        BOOST_TEST(((2.0 * a.c2 + 6.0 * a.c3) / (ha * ha) - 2.0 * b.c2 / (hb * hb)).norm() < 1e-12);
    }
    for (const Cubic &end : {pieces.front(), pieces.back()}) BOOST_TEST(end.c3.norm() < 1e-12);
}

BOOST_AUTO_TEST_CASE(near_segments_agree_with_a_test_of_every_pair) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> in(0.0, 1.0), step(-0.1, 0.1);
    std::vector<Vec3> points;
    std::vector<int> offsets{0};
    for (int curve = 0; curve < 20; ++curve) {
        Vec3 at(in(random), in(random), in(random));
        for (int i = 0; i < 12; ++i) {
            points.push_back(at);
            at += (i == 5 ? 4.0 : 1.0) * Vec3(step(random), step(random), step(random)); // one of them is long
        }
        offsets.push_back(static_cast<int>(points.size()));
    }
    const double along = 2.5;
    std::vector<double> radius;
    for (size_t i = 0; i < points.size(); ++i) radius.push_back(0.06 * in(random));
    std::vector<std::array<int, 2>> expected;
    for (int i = 0; i < 20; ++i)
        for (int j = i; j < 20; ++j)
            for (int a = offsets[i]; a + 1 < offsets[i + 1]; ++a)
                for (int b = i == j ? a + 2 : offsets[j]; b + 1 < offsets[j + 1]; ++b) {
                    double between = 0.0;
                    for (int k = a + 1; i == j && k < b; ++k) between += (points[k + 1] - points[k]).norm();
                    const double distance2 = closest_edge_edge(points[a], points[a + 1], points[b], points[b + 1]).distance2;
                    const double touching = radius[a] + radius[b];
                    if ((i != j || between > along * touching) && distance2 < touching * touching) expected.push_back({a, b});
                }
    std::sort(expected.begin(), expected.end());
    BOOST_TEST(expected.size() > 50u);
    BOOST_TEST((near_segments({points, offsets}, radius, along) == expected));
}

BOOST_AUTO_TEST_CASE(the_signed_distance_is_negative_behind_faces_edges_and_corners) {
    const OwnedMesh mesh = octahedron();
    const Solid solid(mesh.view());
    std::mt19937 random(6);
    std::uniform_real_distribution<double> in(-1.5, 1.5);
    for (int i = 0; i < 500; ++i) {
        const Vec3 p(in(random), in(random), in(random));
        const SignedDistance found = solid.signed_distance(p);
        BOOST_TEST((found.distance < 0.0) == (p.lpNorm<1>() < 1.0));
        BOOST_TEST(std::abs(found.distance) == (p - found.closest).norm(), boost::test_tools::tolerance(1e-12));
        BOOST_TEST(solid.signed_distance(p, std::numeric_limits<double>::infinity(), i % 8).distance == found.distance);
    }
    BOOST_TEST(solid.signed_distance({3.0, 0.0, 0.0}, 1.0).triangle == -1);
}

BOOST_AUTO_TEST_SUITE_END()
