// Which pairs may touch: against looking at all of them.
#include "ringlet/ccd/time_of_impact.h"
#include "ringlet/collision/pair_cache.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <omp.h>
#include <random>
#include <set>

using namespace ringlet;

namespace {

// Strands in the unit cube that wind among a cloth and a body. The strands are rooted in the body, object 0; the cloth is
// object 1.
struct Scene {
    CollisionMesh mesh;
    std::vector<Vec3> start, end;
    std::mt19937 random;

    explicit Scene(unsigned seed, double motion) : random(seed) {
        add_grid(0, 0.0, false);
        add_grid(1, 0.4, true);
        for (int strand = 0; strand < 30; ++strand) add_strand(2 + strand);
        mesh.rest = start;
        const Vec3 shared = motion * anywhere(1.0);
        for (const Vec3 &x : start) end.push_back(x + shared + motion * anywhere(0.3));
    }

    Vec3 anywhere(double size) {
        std::uniform_real_distribution<double> in(-size, size);
        return Vec3(in(random), in(random), in(random));
    }

    int add(const Vec3 &x, int object, double radius, bool moves, int anchor) {
        start.push_back(x);
        mesh.radius.push_back(radius);
        mesh.moves.push_back(moves);
        mesh.object.push_back(object);
        mesh.anchor.push_back(anchor);
        mesh.points.push_back(static_cast<int>(start.size()) - 1);
        return mesh.points.back();
    }

    void add_grid(int object, double height, bool moves) { // 6 × 6 vertices
        const int first = static_cast<int>(start.size());
        for (int i = 0; i < 36; ++i) add(Vec3(i / 6 / 5.0, height, i % 6 / 5.0) + anywhere(0.03), object, 0.002, moves, -1);
        for (int i = 0; i < 36; ++i) {
            const int v = first + i;
            const bool right = i % 6 < 5, down = i < 30;
            if (right) mesh.edges.push_back({v, v + 1});
            if (down) mesh.edges.push_back({v, v + 6});
            if (!right || !down) continue;
            mesh.edges.push_back({v, v + 7});
            mesh.triangles.push_back({v, v + 7, v + 1});
            mesh.triangles.push_back({v, v + 6, v + 7});
        }
    }

    void add_strand(int object) { // of 20 vertices, the first two held by the body
        Vec3 x = Vec3::Constant(0.5) + anywhere(0.5);
        x.y() = 0.0;
        for (int k = 0; k < 20; ++k) {
            add(x, object, 0.01, k >= 2, k < 2 ? 0 : -1);
            if (k > 0) mesh.edges.push_back({mesh.points.back() - 1, mesh.points.back()});
            x += Vec3(0.0, 0.015, 0.0) + anywhere(0.03);
        }
    }
};

template <size_t N> bool any_moves(const CollisionMesh &mesh, const std::array<int, N> &vertices) {
    return std::any_of(vertices.begin(), vertices.end(), [&](int v) { return mesh.moves[v]; });
}

template <class A, class B> bool excluded(const CollisionMesh &mesh, const A &a, const B &b) {
    return share_vertex(a, b) || anchored(mesh, a, b) || (!any_moves(mesh, a) && !any_moves(mesh, b));
}

// How far two primitives are from touching where they come nearest, at 41 times.
template <class A, class B> double nearest_gap(const Scene &scene, const A &a, const B &b) {
    double nearest = 1e9;
    std::vector<Vec3> x(scene.start.size());
    for (int k = 0; k <= 40; ++k) {
        for (int v : a) x[v] = scene.start[v] + k / 40.0 * (scene.end[v] - scene.start[v]);
        for (int v : b) x[v] = scene.start[v] + k / 40.0 * (scene.end[v] - scene.start[v]);
        nearest = std::min(nearest, std::sqrt(closest_points(x, a, b).distance2));
    }
    return nearest - activation_distance(scene.mesh, a, b);
}

SweptBoxes ways(const CollisionMesh &mesh, const std::vector<Vec3> &start, const std::vector<Vec3> &end, double margin) {
    SweptBoxes boxes(mesh);
    boxes.fit({start, end}, {start[0], end[0]}, margin);
    return boxes;
}

Candidates found(const Scene &scene, double margin) {
    Candidates candidates;
    BroadPhase(scene.mesh).find(ways(scene.mesh, scene.start, scene.end, margin), candidates);
    return candidates;
}

bool same(const Candidates &a, const Candidates &b) {
    return a.edge_edge == b.edge_edge && a.point_triangle == b.point_triangle;
}

template <class Pairs> bool ascending(const Pairs &pairs) {
    return std::adjacent_find(pairs.begin(), pairs.end(), std::greater_equal()) == pairs.end();
}

using Pairs = std::set<std::array<int, 3>>;

// Of those that may meet, the pairs that do, going straight.
Pairs coming_near(const CollisionMesh &mesh, PairCache &near, const std::vector<Vec3> &start, const std::vector<Vec3> &end) {
    Pairs pairs;
    for (const CandidatePair *pair : near.impact_candidates())
        with_vertices(mesh, *pair, [&](const auto &a, const auto &b) {
            Vec3 x[4], p[4];
            int i = 0;
            for (const int v : a) x[i] = start[v], p[i++] = end[v] - start[v];
            for (const int v : b) x[i] = start[v], p[i++] = end[v] - start[v];
            const double kept = 0.5 * pair->d_hat;
            const double time = pair->edge_edge ? edge_edge_toi(x, p, kept) : point_triangle_toi(x, p, kept);
            if (time <= 1.0) pairs.insert({pair->edge_edge, pair->primitive[0], pair->primitive[1]});
        });
    return pairs;
}

Pairs touching(PairCache &near, const std::vector<Vec3> &positions) {
    Pairs pairs;
    for (const ContactPair &touch : near.contact_pairs(positions))
        pairs.insert({touch.edge_edge, touch.primitive[0], touch.primitive[1]});
    return pairs;
}

} // namespace

BOOST_AUTO_TEST_SUITE(contact_pairs)

BOOST_AUTO_TEST_CASE(no_pair_that_comes_near_is_missed) {
    for (double motion : {0.0, 0.02, 0.3}) {
        const Scene scene(1, motion);
        const CollisionMesh &mesh = scene.mesh;
        const double margin = 0.005;
        const Candidates candidates = found(scene, margin);
        BOOST_TEST((ascending(candidates.edge_edge) && ascending(candidates.point_triangle)));
        const std::set<std::array<int, 2>> edges(candidates.edge_edge.begin(), candidates.edge_edge.end());
        const std::set<std::array<int, 2>> points(candidates.point_triangle.begin(), candidates.point_triangle.end());
        int near = 0, missed = 0;
        for (int a = 0; a < static_cast<int>(mesh.edges.size()); ++a)
            for (int b = a + 1; b < static_cast<int>(mesh.edges.size()); ++b) {
                if (excluded(mesh, mesh.edges[a], mesh.edges[b]) || nearest_gap(scene, mesh.edges[a], mesh.edges[b]) > margin)
                    continue;
                ++near;
                missed += !edges.count({a, b});
            }
        for (int v : mesh.points)
            for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
                const std::array<int, 1> point = {v};
                if (excluded(mesh, point, mesh.triangles[t]) || nearest_gap(scene, point, mesh.triangles[t]) > margin) continue;
                ++near;
                missed += !points.count({v, t});
            }
        BOOST_TEST(missed == 0, "motion " << motion << ": " << missed << " of " << near << " pairs missed");
        BOOST_TEST(near > 50);
    }
}

BOOST_AUTO_TEST_CASE(what_may_never_touch_is_left_out) {
    const Scene scene(2, 0.1);
    const CollisionMesh &mesh = scene.mesh;
    const Candidates candidates = found(scene, 0.05);
    BOOST_TEST(candidates.edge_edge.size() > 1000);
    BOOST_TEST(candidates.point_triangle.size() > 1000);
    for (const auto &[a, b] : candidates.edge_edge) BOOST_TEST(!excluded(mesh, mesh.edges[a], mesh.edges[b]));
    for (const auto &[v, t] : candidates.point_triangle) BOOST_TEST(!excluded(mesh, std::array<int, 1>{v}, mesh.triangles[t]));
}

BOOST_AUTO_TEST_CASE(neighbours_along_a_strand_that_rests_are_no_pairs) {
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
    broad.find(ways(mesh, mesh.rest, mesh.rest, 0.0), candidates);
    BOOST_TEST(candidates.edge_edge.empty());
    std::vector<Vec3> shorter = mesh.rest;
    for (Vec3 &x : shorter) x *= 0.5;
    broad.find(ways(mesh, shorter, shorter, 0.0), candidates); // drawn together, they do push
    BOOST_TEST(!candidates.edge_edge.empty());
}

BOOST_AUTO_TEST_CASE(a_strand_that_is_groomed_through_itself_touches_at_a_hundredth_of_its_thickness) {
    CollisionMesh mesh; // a loop that ends on itself
    mesh.rest = {{0.0, 0.0, 0.0}, {0.02, 0.0, 0.0}, {0.02, 0.02, 0.0}, {0.01, 0.02, 0.0}, {0.01, -0.01, 0.0}};
    mesh.radius.assign(5, 0.001);
    mesh.object.assign(5, 0);
    const std::array<int, 2> first{0, 1}, last{3, 4}, third{2, 3};
    BOOST_TEST(activation_distance(mesh, first, last) == 0.00002, boost::test_tools::tolerance(1e-12));
    BOOST_TEST(activation_distance(mesh, first, third) == 0.002); // all of it
    mesh.rest[4].z() = 0.002;
    const double apart = std::sqrt(closest_points(mesh.rest, first, last).distance2);
    BOOST_TEST(activation_distance(mesh, first, last) == std::min(0.002, 0.9 * apart), boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(pairs_do_not_depend_on_threads_nor_on_what_was_asked_before) {
    const Scene scene(3, 0.1), other(4, 0.5);
    const int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    const Candidates one = found(scene, 0.01);
    omp_set_num_threads(4);
    Candidates four;
    BroadPhase broad(scene.mesh);
    broad.find(ways(scene.mesh, other.start, other.end, 0.02), four); // the same mesh elsewhere
    broad.find(ways(scene.mesh, scene.start, scene.end, 0.01), four);
    omp_set_num_threads(threads);
    BOOST_TEST(same(one, four));
}

BOOST_AUTO_TEST_CASE(a_tree_that_no_longer_fits_is_built_again) {
    Scene scene(3, 0.1);
    BroadPhase broad(scene.mesh);
    Candidates candidates;
    for (int k = 0; k < 3; ++k)
        broad.find(ways(scene.mesh, scene.start, scene.end, 0.001 * k), candidates); // a wider margin is no reason
    BOOST_TEST(broad.builds() == 1);
    std::shuffle(scene.start.begin(), scene.start.end(), scene.random);
    broad.find(ways(scene.mesh, scene.start, scene.start, 0.01), candidates);
    BOOST_TEST(broad.builds() == 2);
    scene.end = scene.start;
    BOOST_TEST(same(candidates, found(scene, 0.01)));
}

// For a film frame, in any direction: as many pairs as if the scene stood still, not all that lie along the way.
BOOST_AUTO_TEST_CASE(a_scene_that_flies_at_100_m_per_s_finds_the_same_pairs) {
    Scene scene(5, 0.05);
    const Candidates at_home = found(scene, 0.01);
    for (Vec3 &x : scene.end) x += Vec3(60.0, 0.0, 80.0) / 24.0;
    BOOST_TEST(same(at_home, found(scene, 0.01)));
}

// Some vertices move far, most by less than what was noted for them; then all go half as far, and from there back.
BOOST_AUTO_TEST_CASE(what_is_known_of_pairs_changes_nothing_that_is_found) {
    Scene scene(6, 0.0);
    const CollisionMesh &mesh = scene.mesh;
    for (size_t v = 0; v < scene.end.size(); ++v)
        scene.end[v] = scene.start[v] + scene.anywhere(!mesh.moves[v] ? 0.0 : v % 50 == 0 ? 0.1 : 0.005);
    std::vector<Vec3> middle = scene.end;
    for (size_t v = 0; v < middle.size(); ++v) middle[v] = 0.5 * (scene.start[v] + scene.end[v]);
    PairCache knowing(mesh), unknowing(mesh);
    knowing.update_bounds({scene.start, scene.start}, {.margin = 0.01, .max_path = 0.0});
    for (PairCache *near : {&knowing, &unknowing}) near->begin_move({scene.start, scene.end});
    BOOST_TEST(knowing.impact_candidates().size() < size_t(knowing.size()));
    BOOST_TEST(coming_near(mesh, knowing, scene.start, scene.end).size() > 10);
    BOOST_TEST((coming_near(mesh, knowing, scene.start, scene.end) == coming_near(mesh, unknowing, scene.start, scene.end)));
    PairCache going_along(mesh); // pairs noted along the way: only what goes far is quick
    going_along.update_bounds({scene.start, scene.end}, {.margin = 0.001, .max_path = 0.02});
    going_along.begin_move({scene.start, scene.end});
    BOOST_TEST(
        (coming_near(mesh, going_along, scene.start, scene.end) == coming_near(mesh, unknowing, scene.start, scene.end)));
    const std::vector<unsigned char> changed(scene.start.size(), 1);
    for (PairCache *near : {&knowing, &unknowing, &going_along}) near->update_move({scene.start, middle}, changed);
    BOOST_TEST((coming_near(mesh, knowing, scene.start, middle) == coming_near(mesh, unknowing, scene.start, middle)));
    BOOST_TEST((coming_near(mesh, going_along, scene.start, middle) == coming_near(mesh, unknowing, scene.start, middle)));
    for (PairCache *near : {&knowing, &unknowing, &going_along}) near->commit_move(scene.start, middle);
    BOOST_TEST(touching(knowing, middle).size() > 10);
    BOOST_TEST((touching(knowing, middle) == touching(unknowing, middle)));
    BOOST_TEST((touching(going_along, middle) == touching(unknowing, middle)));
    for (PairCache *near : {&knowing, &unknowing, &going_along}) {
        near->begin_move({middle, scene.start});
        near->commit_move(middle, scene.start);
    }
    BOOST_TEST((touching(knowing, scene.start) == touching(unknowing, scene.start)));
}

// Far beside what is between them: most of what lies on the way is not met.
BOOST_AUTO_TEST_CASE(what_goes_far_together_comes_near_little_of_what_lies_on_its_way) {
    Scene scene(12, 0.0);
    const CollisionMesh &mesh = scene.mesh;
    for (size_t v = 0; v < scene.end.size(); ++v)
        if (mesh.moves[v]) scene.end[v] = scene.start[v] + Vec3(0.05, 0.06, 0.04) + scene.anywhere(0.005);
    PairCache near(mesh), unknowing(mesh);
    near.update_bounds({scene.start, scene.end}, {.margin = 0.0001, .max_path = 1.0});
    for (PairCache *pairs : {&near, &unknowing}) pairs->begin_move({scene.start, scene.end});
    BOOST_TEST(near.transient_pairs().empty());
    BOOST_TEST(2 * near.path_candidates().size() < size_t(near.size()));
    BOOST_TEST(2 * near.impact_candidates().size() < near.path_candidates().size());
    BOOST_TEST(coming_near(mesh, near, scene.start, scene.end).size() > 10);
    BOOST_TEST((coming_near(mesh, near, scene.start, scene.end) == coming_near(mesh, unknowing, scene.start, scene.end)));
}

// Somewhere in the triangle of where they are, where they set out to, and a third place.
BOOST_AUTO_TEST_CASE(what_may_bend_knows_the_pairs_of_all_of_its_triangle) {
    Scene scene(10, 0.0);
    const CollisionMesh &mesh = scene.mesh;
    std::vector<Vec3> via = scene.start, elsewhere = scene.start;
    for (size_t v = 0; v < via.size(); ++v) {
        if (!mesh.moves[v]) continue;
        scene.end[v] = scene.start[v] + scene.anywhere(v % 50 == 0 ? 0.1 : 0.005);
        via[v] = scene.start[v] + scene.anywhere(v % 40 == 0 ? 0.1 : 0.01);
        const double one = double(v % 7) / 6.0;
        elsewhere[v] = scene.start[v] + 0.9 * (one * (scene.end[v] - scene.start[v]) + (1.0 - one) * (via[v] - scene.start[v]));
    }
    PairCache near(mesh), unknowing(mesh);
    near.update_bounds({scene.start, scene.end, via}, {.margin = 0.0001, .max_path = 0.05});
    near.begin_move({scene.start, scene.end, via});
    const std::vector<unsigned char> changed(scene.start.size(), 1);
    near.update_move({scene.start, elsewhere, via}, changed);
    unknowing.begin_move({scene.start, elsewhere});
    BOOST_TEST(coming_near(mesh, unknowing, scene.start, elsewhere).size() > 10);
    BOOST_TEST((coming_near(mesh, near, scene.start, elsewhere) == coming_near(mesh, unknowing, scene.start, elsewhere)));
    for (PairCache *pairs : {&near, &unknowing}) pairs->commit_move(scene.start, elsewhere);
    BOOST_TEST(touching(near, elsewhere).size() > 10);
    BOOST_TEST((touching(near, elsewhere) == touching(unknowing, elsewhere)));
}

// Move by move, most leave any corridor; of what does not last fewer pairs are noted. Then all stays where it is, and goes as
// one.
BOOST_AUTO_TEST_CASE(pairs_noted_for_one_move_are_all_of_that_move_and_serve_no_other) {
    Scene scene(13, 0.0);
    const CollisionMesh &mesh = scene.mesh;
    PairCache near(mesh), lasting(mesh);
    std::vector<Vec3> now = scene.start;
    const auto go = [&](double far, bool lasts) {
        std::vector<Vec3> end = now, via = now, to = now;
        for (size_t v = 0; v < now.size(); ++v) {
            if (!mesh.moves[v]) continue;
            end[v] += scene.anywhere(v % 50 == 0 ? 10.0 * far : far);
            via[v] += scene.anywhere(far);
            to[v] += 0.4 * (end[v] - now[v]) + 0.5 * (via[v] - now[v]);
        }
        near.update_bounds({now, end, via}, {.margin = 0.002, .max_path = 0.05, .lasting = lasts});
        lasting.update_bounds({now, end, via}, {.margin = 0.002, .max_path = 0.05});
        PairCache unknowing(mesh);
        for (PairCache *pairs : {&near, &lasting}) {
            pairs->begin_move({now, end, via});
            pairs->update_move({now, to, via}, std::vector<unsigned char>(now.size(), 1));
        }
        unknowing.begin_move({now, to});
        BOOST_TEST(coming_near(mesh, unknowing, now, to).size() > 10);
        BOOST_TEST((coming_near(mesh, near, now, to) == coming_near(mesh, unknowing, now, to)));
        for (PairCache *pairs : {&near, &lasting, &unknowing}) pairs->commit_move(now, to);
        now = to;
        BOOST_TEST((touching(near, now) == touching(unknowing, now)));
    };
    go(0.01, true), go(0.01, true);
    for (const double far : {0.01, 0.001, 0.0001}) {
        go(far, false);
        BOOST_TEST(near.size() < lasting.size());
    }
    go(0.01, false); // what served a move before is noted with a margin again
    BOOST_TEST(near.size() == lasting.size());
    go(0.01, false);
    BOOST_TEST(near.size() < lasting.size());
    RigidMotion turn{Eigen::AngleAxisd(0.5, Vec3::UnitY()).toRotationMatrix(), now[0], now[1]};
    std::vector<Vec3> to = now;
    for (Vec3 &x : to) x = turn(x) + scene.anywhere(0.0001);
    near.begin_rigid_move({now, to}, turn, mesh.object);
    near.commit_rigid_move(now, to);
    PairCache unknowing(mesh);
    unknowing.begin_move({now, to});
    unknowing.commit_move(now, to);
    now = to;
    BOOST_TEST(touching(near, now).size() > 10);
    BOOST_TEST((touching(near, now) == touching(unknowing, now)));
    go(0.01, true);
    BOOST_TEST(near.size() == lasting.size());
}

// Objects turn together, from step to step, most vertices of each nearly exactly so, some not at all; in between each of them
// goes a little where it likes.
BOOST_AUTO_TEST_CASE(what_is_known_of_pairs_goes_along_with_what_moves_nearly_as_one) {
    Scene scene(7, 0.0);
    const CollisionMesh &mesh = scene.mesh;
    const double radius = *std::min_element(mesh.radius.begin(), mesh.radius.end());
    const auto of_two_objects = [&](Pairs pairs) {
        std::erase_if(pairs, [&](const auto &pair) {
            const int second = pair[0] ? mesh.edges[pair[2]][0] : mesh.triangles[pair[2]][0];
            return mesh.object[pair[0] ? mesh.edges[pair[1]][0] : pair[1]] == mesh.object[second];
        });
        return pairs;
    };
    PairCache near(mesh);
    near.update_bounds({scene.start, scene.start}, {.margin = 0.01, .max_path = 0.0});
    std::vector<Vec3> now = scene.start, to(now.size());
    for (int step = 0; step < 8; ++step) {
        const RigidMotion motion{Eigen::AngleAxisd(0.5, Vec3(1.0, 2.0, 2.0) / 3.0).toRotationMatrix(), now[0], now[1]};
        for (size_t v = 0; v < now.size(); ++v)
            to[v] = v % 10 == 0 ? now[v] + scene.anywhere(0.05) : motion(now[v]) + scene.anywhere(0.05 * radius);
        PairCache unknowing(mesh);
        unknowing.begin_move({now, to});
        near.begin_rigid_move({now, to}, motion, mesh.object);
        BOOST_TEST((of_two_objects(coming_near(mesh, near, now, to)) == of_two_objects(coming_near(mesh, unknowing, now, to))));
        BOOST_TEST(of_two_objects(coming_near(mesh, near, now, to)).size() > 10);
        BOOST_TEST(near.transient_pairs().size() < unknowing.transient_pairs().size());
        unknowing.commit_move(now, to);
        near.commit_rigid_move(now, to);
        BOOST_TEST(near.is_complete());
        BOOST_TEST(touching(near, to).size() > 10);
        BOOST_TEST((touching(near, to) == touching(unknowing, to)));
        now = to;
        for (size_t v = 0; v < now.size(); ++v)
            if (mesh.moves[v]) to[v] += scene.anywhere(v % 2 == 0 ? 0.002 : 0.01);
        near.update_bounds({now, to}, {.margin = 0.004, .max_path = 0.1});
        near.begin_move({now, to});
        unknowing.begin_move({now, to});
        BOOST_TEST((coming_near(mesh, near, now, to) == coming_near(mesh, unknowing, now, to)));
        near.commit_move(now, to);
        now = to;
    }
}

// Some of what set out as one goes elsewhere then, twice, by itself.
BOOST_AUTO_TEST_CASE(what_sets_out_as_one_anew_meets_what_has_changed) {
    for (const bool knows : {true, false}) {
        Scene scene(9, 0.0);
        const CollisionMesh &mesh = scene.mesh;
        const std::vector<Vec3> &now = scene.start;
        const RigidMotion motion{Eigen::AngleAxisd(0.5, Vec3(1.0, 2.0, 2.0) / 3.0).toRotationMatrix(), now[0], now[1]};
        std::vector<int> rigid(now.size(), 0);
        std::vector<Vec3> to(now.size());
        for (size_t v = 0; v < now.size(); ++v) {
            if (v % 10 == 0) rigid[v] = -1;
            to[v] = motion(now[v]) + scene.anywhere(v % 10 == 0 ? 0.05 : 0.0);
        }
        PairCache near(mesh);
        if (knows) near.update_bounds({now, now}, {.margin = 0.01, .max_path = 0.0});
        near.begin_rigid_move({now, to}, motion, rigid);
        for (int round = 0; round < 2; ++round) {
            std::vector<unsigned char> changed(now.size(), 0);
            for (size_t v = round; v < now.size(); v += 7) {
                changed[v] = 1;
                if (!mesh.moves[v]) continue;
                rigid[v] = -1;
                to[v] += scene.anywhere(v % 2 == 0 ? 0.0001 : 0.1);
            }
            near.update_rigid_move({now, to}, motion, rigid, changed);
            PairCache unknowing(mesh);
            unknowing.begin_move({now, to});
            Pairs all = coming_near(mesh, unknowing, now, to);
            std::erase_if(all, [&](const auto &pair) {
                const auto any = [&](const auto &primitive) { return any_of(View<unsigned char>(changed), primitive); };
                return !(pair[0] ? any(mesh.edges[pair[1]]) || any(mesh.edges[pair[2]])
                                 : any(std::array{pair[1]}) || any(mesh.triangles[pair[2]]));
            });
            BOOST_TEST(all.size() > 10);
            BOOST_TEST((coming_near(mesh, near, now, to) == all));
        }
        near.commit_rigid_move(now, to);
        PairCache unknowing(mesh);
        unknowing.begin_move({now, to});
        unknowing.commit_move(now, to);
        BOOST_TEST(touching(near, to).size() > 10);
        BOOST_TEST((touching(near, to) == touching(unknowing, to)));
    }
}

// What was measured of it no longer holds then.
BOOST_AUTO_TEST_CASE(a_pair_that_comes_a_little_nearer_as_one_is_measured_again) {
    CollisionMesh mesh; // two edges, a twentieth further apart than they touch
    mesh.rest = {{0.0, 0.0, 0.0}, {0.01, 0.0, 0.0}, {0.0, 0.0015, 0.0015}, {0.01, 0.0015, 0.0015}};
    mesh.edges = {{0, 1}, {2, 3}};
    mesh.radius.assign(4, 0.001);
    mesh.moves.assign(4, 1);
    mesh.object = {0, 0, 1, 1};
    mesh.anchor.assign(4, -1);
    PairCache near(mesh);
    near.update_bounds({mesh.rest, mesh.rest}, {.margin = 0.001, .max_path = 0.0});
    BOOST_TEST(touching(near, mesh.rest).empty());
    std::vector<Vec3> to = mesh.rest;
    for (int v = 0; v < 4; ++v) to[v] += (v < 2 ? 1.0 : -1.0) * Vec3(0.0, 0.00006, 0.00006);
    near.begin_rigid_move({mesh.rest, to}, RigidMotion(), mesh.object);
    near.commit_rigid_move(mesh.rest, to);
    BOOST_TEST(near.transient_pairs().empty());
    BOOST_TEST(touching(near, to).size() == 1u);
}

BOOST_AUTO_TEST_CASE(a_rotation_by_half_a_turn_is_looked_at_as_a_whole) {
    Scene scene(8, 0.0);
    const CollisionMesh &mesh = scene.mesh;
    const RigidMotion motion{Eigen::AngleAxisd(3.0, Vec3::UnitX()).toRotationMatrix(), scene.start[0], scene.start[0]};
    for (size_t v = 0; v < scene.end.size(); ++v) scene.end[v] = motion(scene.start[v]);
    PairCache near(mesh), unknowing(mesh);
    near.update_bounds({scene.start, scene.start}, {.margin = 0.01, .max_path = 0.0});
    near.begin_rigid_move({scene.start, scene.end}, motion, mesh.object);
    unknowing.begin_move({scene.start, scene.end});
    BOOST_TEST((coming_near(mesh, near, scene.start, scene.end) == coming_near(mesh, unknowing, scene.start, scene.end)));
}

BOOST_AUTO_TEST_CASE(nothing_meets_nothing) {
    CollisionMesh mesh;
    Candidates candidates;
    BroadPhase(mesh).find(SweptBoxes(mesh), candidates);
    BOOST_TEST((candidates.edge_edge.empty() && candidates.point_triangle.empty()));
}

BOOST_AUTO_TEST_SUITE_END()
