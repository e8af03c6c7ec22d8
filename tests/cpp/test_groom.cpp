// Sampling, curls, repair and hairs.
#include "ringlet/groom/curl.h"
#include "ringlet/groom/hairs.h"
#include "ringlet/groom/keep_beside.h"
#include "ringlet/groom/push_out.h"
#include "ringlet/groom/repair.h"
#include "ringlet/groom/sample.h"
#include "shapes.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <memory>
#include <numbers>
#include <random>

using namespace ringlet;

namespace {

std::vector<Vec3> random_square(int count) {
    std::mt19937 random(9);
    std::uniform_real_distribution<double> in(0.0, 1.0);
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) points.emplace_back(in(random), 0.0, in(random));
    return points;
}

double closest_pair(const std::vector<Vec3> &points, const std::vector<int> &chosen) {
    double least = 1e9;
    for (size_t i = 0; i < chosen.size(); ++i)
        for (size_t j = i + 1; j < chosen.size(); ++j) least = std::min(least, (points[chosen[i]] - points[chosen[j]]).norm());
    return least;
}

// Settings of one lock, with the arrays that they borrow.
struct OneCurl {
    std::vector<Vec3> axis{Vec3::UnitX()};
    std::vector<double> radius{0.004}, turns{5.0}, start{0.0}, flatness{0.0}, kink{0.0}, flip{-1.0};
    std::vector<double> switchbacks{1e9}, skips{1e9}, one{1.0}, zero{0.0};
    std::vector<int> leader{0};
    bool keep_length = false;
    CurlSettings settings() const {
        return {.axis = axis,
                .radius = radius,
                .turns = turns,
                .phase = zero,
                .flip = flip,
                .start = start,
                .end = zero,
                .taper = zero,
                .flatness = flatness,
                .kink = kink,
                .wave = zero,
                .wave_turns = zero,
                .width_ramp = one,
                .rate_ramp = one,
                .opening = one,
                .closing = one,
                .taper_ramp = zero,
                .wave_ramp = one,
                .width_noise = zero,
                .rate_noise = zero,
                .sway = zero,
                .switchbacks = switchbacks,
                .skips = skips,
                .leader = leader,
                .join = zero,
                .join_over = zero,
                .cohesion = zero,
                .noise_count = 1,
                .event_count = 1,
                .keep_length = keep_length};
    }
};

} // namespace

BOOST_AUTO_TEST_SUITE(groom)

BOOST_AUTO_TEST_CASE(eliminated_samples_keep_most_of_the_distance_of_a_perfect_packing) {
    const std::vector<Vec3> candidates = random_square(2000);
    const std::vector<int> kept = thin_out(candidates, 1.0, 250);
    BOOST_TEST(kept.size() == 250u);
    const double packing = 2.0 * std::sqrt(1.0 / (2.0 * std::sqrt(3.0) * 250));
    BOOST_TEST(closest_pair(candidates, kept) > 0.6 * packing);
}

BOOST_AUTO_TEST_CASE(elimination_to_as_many_as_there_are_keeps_all) {
    BOOST_TEST(thin_out(random_square(10), 1.0, 20).size() == 10u);
}

BOOST_AUTO_TEST_CASE(a_curl_about_a_straight_line_is_a_helix) {
    const std::vector<Vec3> shape = straight(10, 0.08);
    const std::vector<int> offsets{0, 10};
    const OneCurl one;
    for (const Vec3 &p : curl({shape, offsets}, one.settings(), 100)) {
        const double phase = 2.0 * std::numbers::pi * 5.0 * p.y() / 0.08;
        // The helix rotates from the axis x towards tangent × axis = -z.
        BOOST_TEST((p - Vec3(0.004 * std::cos(phase), p.y(), -0.004 * std::sin(phase))).norm() < 2e-5);
    }
}

BOOST_AUTO_TEST_CASE(a_curl_without_width_is_its_shape) {
    const std::vector<Vec3> shape = straight(10, 0.08);
    const std::vector<int> offsets{0, 10};
    OneCurl one;
    one.radius = {0.0};
    const std::vector<Vec3> result = curl({shape, offsets}, one.settings(), 10);
    for (size_t i = 0; i < 10; ++i) BOOST_TEST((result[i] - shape[i]).norm() < 1e-12);
}

// Rotation of the curl about a straight centre line from point to point [turns], in ascending order.
std::vector<double> sorted_turns(const std::vector<Vec3> &points, const Vec3 &middle, const Vec3 &up) {
    std::vector<double> turns;
    for (size_t k = 1; k < points.size(); ++k) {
        const auto off = [&](const Vec3 &p) { return Vec3(p - middle - up.dot(p - middle) * up).normalized(); };
        const double cosine = off(points[k]).dot(off(points[k - 1]));
        turns.push_back(std::acos(std::clamp(cosine, -1.0, 1.0)) / (2.0 * std::numbers::pi));
    }
    std::sort(turns.begin(), turns.end());
    return turns;
}

BOOST_AUTO_TEST_CASE(frames_do_not_spin_on_shapes_that_are_straight_up_to_rounding) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> shaken(-1e-14, 1e-14);
    std::vector<Vec3> shape = straight(20, 0.08);
    for (Vec3 &p : shape) p += Vec3(shaken(random), shaken(random), shaken(random));
    const std::vector<int> offsets{0, 20};
    const OneCurl one;
    const std::vector<Vec3> result = curl({shape, offsets}, one.settings(), 120);
    BOOST_TEST(sorted_turns(result, Vec3::Zero(), Vec3::UnitY()).back() < 1.01 * 5.0 / 119);
}

BOOST_AUTO_TEST_CASE(frames_do_not_spin_where_a_shape_reverses) {
    std::vector<Vec3> shape = straight(10, 0.04);
    for (int i = 8; i >= 0; --i) shape.push_back(shape[i]);
    const std::vector<int> offsets{0, static_cast<int>(shape.size())};
    OneCurl one;
    one.turns = {6.0};
    const std::vector<Vec3> result = curl({shape, offsets}, one.settings(), 240);
    const std::vector<Vec3> up(result.begin(), result.begin() + 100), down(result.begin() + 140, result.end());
    // The hairpin takes points, so there are more than 6 / 239 turns between the others, and equally many between all of them.
    for (const std::vector<Vec3> &side : {up, down}) {
        const std::vector<double> turns = sorted_turns(side, Vec3::Zero(), Vec3::UnitY());
        BOOST_TEST(turns.back() < 1.01 * turns[turns.size() / 2]);
    }
    for (const Vec3 &p : result) BOOST_TEST(p.allFinite());
}

std::vector<Vec3> pushed_out(const std::vector<Vec3> &curve, const std::vector<const OwnedMesh *> &meshes, double margin) {
    const std::vector<int> offsets{0, static_cast<int>(curve.size())};
    std::vector<std::unique_ptr<Solid>> owned;
    std::vector<const Solid *> bodies;
    for (const OwnedMesh *mesh : meshes) bodies.push_back(owned.emplace_back(std::make_unique<Solid>(mesh->view())).get());
    return push_out({curve, offsets}, bodies, margin);
}

BOOST_AUTO_TEST_CASE(a_curve_between_two_overlapping_bodies_is_outside_of_both) {
    const OwnedMesh body = octahedron();
    OwnedMesh wide = octahedron(); // the curve leaves the first body inside of it
    for (Vec3 &p : wide.points) p = Vec3(3.0, 0.5, 3.0).cwiseProduct(p) - Vec3(0.0, 1.2, 0.0);
    std::vector<Vec3> curve;
    for (int i = 0; i <= 80; ++i) curve.emplace_back(0.3 + 0.004 * i, 0.5 - 0.02 * i, 0.22);
    const auto depth = [&](const OwnedMesh &mesh, const std::vector<Vec3> &points) {
        double most = 0.0;
        for (const Vec3 &p : points) most = std::max(most, -Solid(mesh.view()).signed_distance(p).distance);
        return most;
    };
    BOOST_TEST(depth(wide, pushed_out(curve, {&body}, 0.01)) > 0.05);
    const std::vector<Vec3> result = pushed_out(curve, {&body, &wide}, 0.01);
    BOOST_TEST(depth(body, result) < 1e-9);
    BOOST_TEST(depth(wide, result) < 1e-9);
}

BOOST_AUTO_TEST_CASE(a_curve_through_a_body_comes_out_and_keeps_its_root) {
    const OwnedMesh body = octahedron();
    std::vector<Vec3> curve;
    for (int i = 0; i <= 40; ++i) curve.emplace_back(0.05 + 0.02 * i, 0.95 - 0.02 * i, 0.02); // descends inside, near a face
    const std::vector<Vec3> result = pushed_out(curve, {&body}, 0.01);
    BOOST_TEST(result.front() == curve.front());
    for (size_t i = 1; i < result.size(); ++i) BOOST_TEST(result[i].lpNorm<1>() >= 1.0 - 1e-9); // outside of the octahedron
}

BOOST_AUTO_TEST_CASE(curves_at_a_sufficient_distance_do_not_move) {
    const OwnedMesh body = octahedron();
    std::vector<Vec3> curve = straight(20, 1.0);
    for (Vec3 &p : curve) p.y() += 1.0;
    const std::vector<Vec3> result = pushed_out(curve, {&body}, 0.01);
    BOOST_TEST(std::equal(result.begin(), result.end(), curve.begin()));
}

BOOST_AUTO_TEST_CASE(a_curl_pushed_out_of_a_body_keeps_its_length) {
    OwnedMesh body = octahedron();
    for (Vec3 &p : body.points) p *= 0.1;
    std::vector<Vec3> curve; // from a face down through the body, and out at a lower face
    for (int i = 0; i <= 300; ++i) {
        const double s = 0.12 * i / 300.0, phase = 2.0 * std::numbers::pi * s / 6.5e-3;
        curve.emplace_back(0.03 + 0.1 * s + 2.5e-3 * std::sin(phase), 0.05 - s, 0.02 + 2.5e-3 * (std::cos(phase) - 1.0));
    }
    const std::vector<Vec3> result = pushed_out(curve, {&body}, 1e-3);
    double before = 0.0, after = 0.0;
    for (size_t i = 1; i < result.size(); ++i) {
        BOOST_TEST(result[i].lpNorm<1>() >= 0.1 - 1e-9);
        const double was = (curve[i] - curve[i - 1]).norm(), is = (result[i] - result[i - 1]).norm();
        BOOST_TEST(is < 2.0 * was); // not torn, though the body has sharp edges
        before += was, after += is;
    }
    BOOST_TEST(after == before, boost::test_tools::tolerance(0.1));
}

// The largest and the least factor on the length of an edge, and the factor on the whole length.
std::array<double, 3> stretches(View<Vec3> before, View<Vec3> after) {
    double least = std::numeric_limits<double>::infinity(), most = 0.0, was = 0.0, is = 0.0;
    for (size_t k = 1; k < before.size(); ++k) {
        const double old_edge = (before[k] - before[k - 1]).norm(), edge = (after[k] - after[k - 1]).norm();
        least = std::min(least, edge / old_edge), most = std::max(most, edge / old_edge);
        was += old_edge, is += edge;
    }
    return {most, least, is / was};
}

BOOST_AUTO_TEST_CASE(a_curve_straight_into_a_body_is_led_along_it_with_its_length) {
    OwnedMesh body = octahedron();
    const Vec3 root(0.3, 0.4, 0.3), inward = -Vec3::Ones().normalized();
    for (const bool reversed : {false, true}) {
        if (reversed)
            for (Triangle &t : body.triangles) std::swap(t[1], t[2]);
        std::vector<Vec3> curve;
        for (int i = 0; i <= 20; ++i) curve.emplace_back(root + (reversed ? -0.01 : 0.01) * i * inward);
        const std::vector<Vec3> result = pushed_out(curve, {&body}, 1e-3);
        const auto [most, least, whole] = stretches(curve, result);
        BOOST_TEST(least > 0.5);
        BOOST_TEST(most < 2.0);
        BOOST_TEST(whole == 1.0, boost::test_tools::tolerance(0.05));
        BOOST_TEST((result.back() - curve.back()).norm() > 0.1);
    }
}

BOOST_AUTO_TEST_CASE(a_push_out_of_triangles_that_face_against_one_another_stays_bounded) {
    OwnedMesh body = octahedron();
    for (size_t t = 0; t < body.triangles.size(); t += 3) std::swap(body.triangles[t][1], body.triangles[t][2]);
    std::vector<Vec3> curve;
    for (int i = 0; i <= 200; ++i) curve.emplace_back(0.5 + 2e-3 * std::sin(0.5 * i), 0.5 - 2e-3 * i, 2e-3 * std::cos(0.5 * i));
    const auto [most, least, whole] = stretches(curve, pushed_out(curve, {&body}, 2e-3));
    BOOST_TEST((whole > 0.5 && whole < 2.0));
}

BOOST_AUTO_TEST_CASE(repair_does_not_stretch_curves_that_are_shorter_than_their_distance) {
    const OwnedMesh mesh = octahedron();
    const Solid body(mesh.view());
    std::vector<Vec3> points;
    std::vector<int> offsets{0};
    for (int lock = 0; lock < 6; ++lock) {
        for (int i = 0; i <= 5; ++i) points.emplace_back(0.3 + 2e-3 * i, 0.4 + 1e-3 * lock, 0.3 + 1e-3 * lock * i);
        offsets.push_back(static_cast<int>(points.size()));
    }
    const CurveView curves{points, offsets};
    Repair repair(curves, {&body}, {.thickness = 0.05});
    for (int round = 0; round < 40 && repair.round() > 0; ++round) {
    }
    const std::vector<Vec3> repaired = repair.points();
    const CurveView after{repaired, offsets};
    for (int i = 0; i < curves.count(); ++i) {
        const auto [most, least, whole] = stretches(curves[i], after[i]);
        BOOST_TEST((whole > 0.79 && whole < 1.26));
    }
}

BOOST_AUTO_TEST_CASE(repair_frees_curves_that_pass_through_a_body_and_one_another) {
    const OwnedMesh mesh = octahedron();
    const Solid body(mesh.view());
    std::vector<Vec3> points;
    std::vector<int> offsets{0};
    for (int lock = 0; lock < 6; ++lock) { // from outside they converge just above a face, and enter it
        for (int i = 0; i <= 60; ++i) {
            const double s = 0.01 * (i - 30), turn = 0.3 * lock;
            points.emplace_back(0.52 - s * std::cos(turn), 0.2 - s * std::sin(turn), 0.3 + 1e-4 * lock);
        }
        offsets.push_back(static_cast<int>(points.size()));
    }
    const CurveView curves{points, offsets};
    const Allowed allowed{.thickness = 1e-3};
    BOOST_TEST(!find_penetrations(curves, {&body}, allowed).empty());
    const std::vector<double> radius(points.size(), 5e-4);
    BOOST_TEST(!find_overlaps(curves, radius).empty());
    Repair repair(curves, {&body}, allowed);
    for (int round = 0; round < 100 && repair.round() > 0; ++round) {
    }
    const std::vector<Vec3> repaired = repair.points();
    const CurveView after{repaired, offsets};
    BOOST_TEST(find_overlaps(after, radius).empty());
    for (const Penetration &place : find_penetrations(after, {&body}, allowed)) BOOST_TEST(place.point == -1);
    for (int i = 0; i < 6; ++i) BOOST_TEST(after[i][0] == curves[i][0]);
}

BOOST_AUTO_TEST_CASE(a_hair_off_the_middle_runs_beside_a_straight_lock) {
    const std::vector<Vec3> line = straight(8, 0.07);
    std::vector<Vec3f> lock;
    for (const Vec3 &p : line) lock.push_back(p.cast<float>());
    const std::vector<int> offsets{0, 8}, first{0, 2};
    const std::vector<Vec3> axis{Vec3::UnitX()};
    const std::vector<float> root(6, 0.0F), offset{0, 0, 0.002F, 0.001F}, tip{1, 1}, none(2, 0.0F), taper(2, 0.0F),
        frizz(8, 0.0F), profile(8, 1.0F), hold(8, 0.0F);
    std::vector<float> result(size_t{2} * 8 * 3);
    warp_hairs(lock, offsets, axis, root, {first, offset, tip, none, none, taper, frizz, 2, profile, hold, hold, {}, {}, {}},
               result);
    for (size_t k = 0; k < 8; ++k) {
        BOOST_TEST((Eigen::Map<Vec3f>(&result[3 * k]) == lock[k]));
        const Vec3f beside = lock[k] + Vec3f(0.002F, 0.0F, -0.001F);
        BOOST_TEST((Eigen::Map<Vec3f>(&result[3 * (8 + k)]) - beside).norm() < 1e-8F);
    }
}

BOOST_AUTO_TEST_CASE(a_flat_hair_goes_straight_from_its_root_to_where_it_joins_the_lock) {
    std::vector<Vec3f> lock;
    for (const Vec3 &p : straight(9, 0.08)) lock.push_back(p.cast<float>());
    const std::vector<int> offsets{0, 9}, first{0, 2};
    const std::vector<Vec3> axis{Vec3::UnitX()};
    const std::vector<float> root{0, 0, 0, 0.01F, 0, 0}, offset(4, 0.0F), tip{1, 1}, join{0, 0.5F}, flat{0, 1}, taper(2, 0.0F),
        frizz(8, 0.0F), profile(5, 1.0F), hold{1, 0.5F, 0, 0, 0}, pace{0, 0, 0, 0.5F, 1};
    std::vector<float> result(size_t{2} * 5 * 3);
    warp_hairs(lock, offsets, axis, root, {first, offset, tip, join, flat, taper, frizz, 2, profile, hold, pace, {}, {}, {}},
               result);
    const auto point = [&](size_t k) { return Vec3f(Eigen::Map<Vec3f>(&result[3 * (5 + k)])); };
    const Vec3f outside = lock[0] + Vec3f(0.01F, 0.0F, 0.0F);
    BOOST_TEST((point(0) - outside).norm() < 1e-8F);
    BOOST_TEST((point(1) - 0.5F * (outside + lock[4])).norm() < 1e-8F);
    for (const size_t k : {2, 3, 4}) BOOST_TEST((point(k) - lock[2 * k]).norm() < 1e-8F); // the rest of the lock is its own
}

BOOST_AUTO_TEST_CASE(hairs_stop_short_of_a_wall_beside_their_lock_and_return_to_their_places_beyond) {
    constexpr int n = 41; // 2 mm apart
    constexpr float beyond = 2e-3F;
    std::vector<Vec3f> lock;
    for (const Vec3 &p : straight(n, 0.08)) lock.push_back(p.cast<float>());
    const std::vector<int> offsets{0, n}, first{0, 3};
    std::vector<float> tip{1, 1, 1}, hold(n, 0.0F), hairs;
    hold[0] = 1.0F;
    const std::vector<float> none(3, 0.0F);
    for (const float x : {0.0F, beyond, -beyond})
        for (const Vec3f &p : lock) hairs.insert(hairs.end(), {p[0] + x, p[1], p[2]});
    const std::vector<float> before = hairs;
    const double y = 0.04,
                 at = 1e-3; // the wall's lower rim and its place; slightly askew, so that no point is on an edge
    const std::vector<Vec3> wall{{at, y, -0.031}, {at, y, 0.03}, {at, 0.2, 0.03}, {at, 0.2, -0.03}};
    const std::vector<Triangle> triangles{{0, 1, 2}, {0, 2, 3}};
    HairLayout layout;
    layout.first = first, layout.tip = tip, layout.join = layout.flat = none, layout.hold = layout.pace = hold;

    BOOST_TEST(keep_beside(lock, offsets, layout, {wall, triangles}, 1e-4, hairs) == 1);
    const auto x = [&](int hair, int k) { return hairs[3 * (hair * n + k)]; };
    for (int k = 0; k < n; ++k) {
        for (const int hair : {0, 2})
            for (int c = 0; c < 3; ++c) BOOST_TEST(hairs[3 * (hair * n + k) + c] == before[3 * (hair * n + k) + c]);
        if (lock[k][1] > y) BOOST_TEST(x(1, k) < 0.9001e-3F);        // short by the margin
        if (lock[k][1] > y + 5e-3) BOOST_TEST(x(1, k) > 0.8999e-3F); // nearer only where its edge would pierce at the rim
        if (lock[k][1] < y - 6e-3) BOOST_TEST(x(1, k) == beyond);
        if (k > 0) BOOST_TEST(std::abs(x(1, k) - x(1, k - 1)) < 0.7e-3F); // a third of its offset in 2 mm
    }
}

BOOST_AUTO_TEST_CASE(no_edge_of_a_hair_pierces_what_its_lock_does_not) {
    constexpr int n = 60, count = 30;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> in(-1.0, 1.0);
    const auto anywhere = [&] { return Vec3(in(random), in(random), in(random)); };
    const auto goes_through = [](const Vec3 &a, const Vec3 &b, const std::vector<Vec3> &corners) {
        const auto volume = [](const Vec3 &p, const Vec3 &q, const Vec3 &r, const Vec3 &s) {
            return (q - p).cross(r - p).dot(s - p) > 0.0;
        };
        const Vec3 &c0 = corners[0], &c1 = corners[1], &c2 = corners[2];
        const bool side = volume(a, b, c0, c1);
        return volume(a, c0, c1, c2) != volume(b, c0, c1, c2) && side == volume(a, b, c1, c2) && side == volume(a, b, c2, c0);
    };
    int through_before = 0, through_after = 0;
    for (int run = 0; run < 40; ++run) {
        std::vector<Vec3f> lock; // a coil of 12 points a turn, 6 mm wide
        for (int k = 0; k < n; ++k) {
            const double angle = 2.0 * std::numbers::pi * k / 12.0;
            lock.emplace_back(Vec3(6e-3 * std::cos(angle), 1e-3 * k, 6e-3 * std::sin(angle)).cast<float>());
        }
        const std::vector<int> offsets{0, n}, first{0, count};
        std::vector<float> tip, hairs, hold(n, 0.0F), none(count, 0.0F);
        for (int i = 0; i < count; ++i) { // shorter than the lock by up to a tenth, beside it by up to 3 mm
            tip.push_back(1.0F - 0.1F * static_cast<float>(i) / count);
            const Vec3f beside = (1.7e-3 * anywhere()).cast<float>();
            for (int k = 0; k < n; ++k) {
                const float at = static_cast<float>(k) * tip.back();
                const int segment = std::min(static_cast<int>(at), n - 2);
                const Vec3f p =
                    lock[segment] + (at - static_cast<float>(segment)) * (lock[segment + 1] - lock[segment]) + beside;
                hairs.insert(hairs.end(), {p[0], p[1], p[2]});
            }
        }
        OwnedMesh shards; // 2 mm wide, none pierced by the lock
        while (shards.triangles.size() < 40) {
            const Vec3 centre = lock[static_cast<size_t>(random() % n)].cast<double>() + 1.5e-3 * anywhere();
            const std::vector<Vec3> corners{centre + 2e-3 * anywhere(), centre + 2e-3 * anywhere(), centre + 2e-3 * anywhere()};
            bool clear = true;
            for (int k = 0; k + 1 < n; ++k)
                clear = clear && !goes_through(lock[k].cast<double>(), lock[k + 1].cast<double>(), corners);
            if (!clear) continue;
            const int next = static_cast<int>(shards.points.size());
            shards.points.insert(shards.points.end(), corners.begin(), corners.end());
            shards.triangles.emplace_back(next, next + 1, next + 2);
        }
        const auto through = [&] {
            int found = 0;
            for (int e = 0; e < count * n; ++e) {
                if (e % n == n - 1) continue;
                const Vec3 a = Eigen::Map<Vec3f>(&hairs[3 * e]).cast<double>(),
                           b = Eigen::Map<Vec3f>(&hairs[3 * e + 3]).cast<double>();
                for (size_t t = 0; t < shards.triangles.size(); ++t)
                    found += goes_through(a, b, {shards.points[3 * t], shards.points[3 * t + 1], shards.points[3 * t + 2]});
            }
            return found;
        };
        HairLayout layout;
        layout.first = first, layout.tip = tip, layout.join = layout.flat = none, layout.hold = layout.pace = hold;
        through_before += through();
        keep_beside(lock, offsets, layout, shards.view(), 1e-4, hairs);
        through_after += through();
    }
    BOOST_TEST(through_before > 2'000);
    BOOST_TEST(through_after == 0);
}

BOOST_AUTO_TEST_SUITE_END()
