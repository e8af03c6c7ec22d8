// What contacts do: forces from energies, and moves that pass through nothing.
#include "ringlet/ccd/impact_zones.h"
#include "ringlet/ccd/motion_limiter.h"
#include "ringlet/contact/contact.h"
#include "ringlet/contact/contact_set.h"

#include <boost/test/unit_test.hpp>

#include <Eigen/Eigenvalues>
#include <limits>
#include <random>

using namespace ringlet;

namespace {

struct Random {
    std::mt19937 engine{7};
    double operator()(double low, double high) { return std::uniform_real_distribution<>(low, high)(engine); }
    Vec3 vector(double size) { return {(*this)(-size, size), (*this)(-size, size), (*this)(-size, size)}; }
};

Contact some_contact(Random &random) {
    Contact contact{};
    contact.first = 2;
    contact.normal = random.vector(1.0).normalized();
    contact.distance = 1e-3;
    contact.barrier_end = 1e-3 / 64;
    contact.stiffness = random(0.1, 10.0);
    contact.friction = random(0.0, 1.0);
    contact.give = 2e-5;
    contact.start = random.vector(1e-3);
    contact.force = random(0.0, 1e-3);
    return contact;
}

// Strands that start anywhere and wish to be anywhere else.
struct Crowd {
    CollisionMesh mesh;
    std::vector<Vec3> start, end;
    std::vector<int> offsets{0};
    std::vector<double> mass;

    Crowd(int strands, double size, double way, unsigned seed, int vertices = 3) {
        Random random{std::mt19937(seed)};
        for (int s = 0; s < strands; ++s) {
            const Vec3 place = random.vector(size), along = random.vector(size), wish = random.vector(way);
            for (int k = 0; k < vertices; ++k) {
                const int v = int(start.size());
                start.push_back(place + k * along);
                end.push_back(start.back() + wish + random.vector(0.3 * way));
                mesh.points.push_back(v);
                mesh.radius.push_back(1e-3);
                mesh.moves.push_back(1);
                mesh.object.push_back(s);
                mesh.anchor.push_back(-1);
                mass.push_back(random(0.5, 2.0));
                if (k > 0) mesh.edges.push_back({v - 1, v});
            }
            offsets.push_back(int(start.size()));
        }
        mesh.rest = start;
    }

    ConnectedMesh connected() const { return {mesh, View<int>(offsets)}; }

    CcdReport limit(std::vector<Vec3> &limited) const {
        PairCache pairs(mesh);
        pairs.update_bounds({start, start}, {.margin = 0.005, .max_path = 0.0});
        limited = end;
        return limit_motion({.connected = connected(), .start = start}, pairs, limited);
    }

    CcdReport resolve(std::vector<Vec3> &resolved) const {
        PairCache pairs(mesh);
        resolved = end;
        return resolve_impact_zones({.connected = connected(),
                                     .start = start,
                                     .mass = View<double>(mass),
                                     .advect = [](int, const Vec3 &point) { return point; }},
                                    pairs, resolved);
    }

    // Limits a move; then every third strand is shortened further, and the rest of the move is limited again.
    CcdReport limit_and_shorten(std::vector<Vec3> &limited) const {
        PairCache pairs(mesh);
        pairs.update_bounds({start, end}, {.margin = 0.0005, .max_path = 0.1});
        limited = end;
        limit_motion({.connected = connected(), .start = start}, pairs, limited);
        std::vector<unsigned char> changed(start.size(), 0);
        for (size_t v = 0; v < start.size(); ++v)
            if (mesh.object[v] % 3 == 0) {
                changed[v] = 1;
                limited[v] = start[v] + 0.3 * (limited[v] - start[v]);
            }
        return limit_motion({.connected = connected(), .start = start, .whole_strands = true, .changed = changed}, pairs,
                            limited);
    }

    // Whether any pair has an impact, asked of all pairs.
    bool has_impacts(const std::vector<Vec3> &to) const {
        PairCache all(mesh);
        all.begin_move({start, to});
        return !find_impacts(mesh, all.impact_candidates(), start, to).empty();
    }

    // The least distance of any two strands on the way, by dense sampling.
    double closest(const std::vector<Vec3> &to) const {
        double least = 1.0;
        std::vector<Vec3> now(start.size());
        for (int step = 0; step <= 400; ++step) {
            for (size_t v = 0; v < start.size(); ++v) now[v] = start[v] + (step / 400.0) * (to[v] - start[v]);
            for (size_t a = 0; a < mesh.edges.size(); ++a)
                for (size_t b = 0; b < a; ++b)
                    if (!share_vertex(mesh.edges[a], mesh.edges[b]))
                        least = std::min(least, std::sqrt(closest_points(now, mesh.edges[a], mesh.edges[b]).distance2));
        }
        return least;
    }

    // Of what every pair keeps on the way, the least relative to what it is to keep.
    double least_kept(const std::vector<Vec3> &to) const {
        double least = 1e9;
        std::vector<Vec3> now(start.size());
        for (int step = 0; step <= 100; ++step) {
            for (size_t v = 0; v < start.size(); ++v) now[v] = start[v] + (step / 100.0) * (to[v] - start[v]);
            for (const auto &a : mesh.edges)
                for (const auto &b : mesh.edges) {
                    if (share_vertex(a, b)) continue;
                    const double first = std::sqrt(closest_points(start, a, b).distance2);
                    const double kept = std::min(0.5 * activation_distance(mesh, a, b), 0.2 * first);
                    least = std::min(least, std::sqrt(closest_points(now, a, b).distance2) / kept);
                }
        }
        return least;
    }
};

} // namespace

BOOST_AUTO_TEST_SUITE(contact_forces)

BOOST_AUTO_TEST_CASE(potentials_are_the_integrals_of_their_forces) {
    Random random;
    const double h = 1e-7;
    for (int i = 0; i < 1000; ++i) {
        const double r = 1.0, g = random(-0.5, 1.2);
        const auto at = [&](double gap) { return contact_potential(gap, r, r / 64); };
        const double scale = 1.0 + at(g).second;
        BOOST_TEST(std::abs((at(g + h).value - at(g - h).value) / (2 * h) - at(g).first) < 1e-5 * scale);
        if (std::abs(g - r) > 1e-3 && std::abs(g - r / 64) > 1e-4)
            BOOST_TEST(std::abs((at(g + h).first - at(g - h).first) / (2 * h) - at(g).second) < 1e-4 * scale);
        BOOST_TEST(at(g).first <= 0.0);
        BOOST_TEST(at(g).second >= 0.0);

        const double y = random(0.0, 2.0);
        const auto rub = [&](double slid) { return friction_potential(slid, 1.0); };
        if (y > h) BOOST_TEST(std::abs((rub(y + h).value - rub(y - h).value) / (2 * h) - rub(y).first) < 1e-6);
    }
}

BOOST_AUTO_TEST_CASE(a_contact_bears_what_it_is_to_bear_where_it_began) {
    Random random;
    for (int i = 0; i < 1000; ++i) {
        const double gap = random(1e-3, 1.0), force = random(1e-3, 3.0), r = distance_to_bear(force, gap);
        BOOST_TEST(std::abs(contact_potential(gap, r, 0.0).first + force) < 1e-12);
        const double part = random(0.0, 1.0);
        BOOST_TEST(std::abs(friction_potential(sheared_to_hold(part), 1.0).first - part) < 1e-12);
    }
}

BOOST_AUTO_TEST_CASE(what_is_expanded_is_right_to_second_order) {
    Random random;
    for (int i = 0; i < 1000; ++i) {
        Contact contact = some_contact(random);
        const double r = contact.distance;
        contact.gap = random(0.05, 0.45) * r; // within the barrier
        const auto off = [&](double nearer) {
            const Vec3 apart = (contact.gap - nearer * contact.gap) * contact.normal;
            return std::abs(expanded_push_energy(contact, apart) - push_energy(contact, apart)) / (contact.stiffness * r * r);
        };
        BOOST_TEST(off(0.0) < 1e-15);
        BOOST_TEST(std::abs(off(2e-2) / off(1e-2) - 8.0) < 0.2);
    }
}

BOOST_AUTO_TEST_CASE(the_gradient_is_that_of_the_energy_and_the_hessian_semi_definite) {
    Random random;
    const double h = 1e-9;
    for (int i = 0; i < 1000; ++i) {
        const Contact contact = some_contact(random);
        const Vec3 separation = random.vector(1e-3);
        const ContactValue value = contact_value(contact, separation);
        const double scale = value.gradient.norm() + contact.stiffness * contact.distance;
        for (int k = 0; k < 3; ++k) {
            const Vec3 step = h * Vec3::Unit(k);
            const double slope =
                (contact_energy(contact, separation + step) - contact_energy(contact, separation - step)) / (2 * h);
            BOOST_TEST(std::abs(slope - value.gradient[k]) < 1e-4 * scale);
        }
        const Eigen::SelfAdjointEigenSolver<Mat3> eigen(value.hessian);
        BOOST_TEST(eigen.eigenvalues()[0] >= -1e-9 * eigen.eigenvalues()[2]);
    }
}

BOOST_AUTO_TEST_CASE(friction_never_exceeds_its_cone) {
    Random random;
    for (int i = 0; i < 1000; ++i) {
        const Contact contact = some_contact(random);
        const Vec3 gradient = contact_value(contact, random.vector(1e-3)).gradient;
        const Vec3 tangential = gradient - contact.normal.dot(gradient) * contact.normal;
        BOOST_TEST(tangential.norm() <=
                   contact.friction * contact.force + 1e-14 * gradient.norm()); // what rounding leaves of the push
    }
}

// Where the held ends of two edges touch, nothing that moves is nearest; as the others turn, it is, by a little.
BOOST_AUTO_TEST_CASE(edges_that_touch_at_held_ends_are_no_stiffer_than_their_other_ends) {
    constexpr double held = std::numeric_limits<double>::infinity();
    CollisionMesh mesh;
    mesh.edges = {{0, 1}, {2, 3}};
    mesh.strand_edges = 2;
    mesh.radius.assign(4, 1e-3);
    mesh.moves = {0, 1, 0, 1};
    mesh.object = {0, 0, 1, 1};
    mesh.anchor.assign(4, -1);
    const ContactMaterial material{{held, 2.0, held, 3.0}, {0, 0, 0, 0}, {0.3}, 1, 1e-5};
    for (const double turned : {0.0, 1e-6, 1e-3}) {
        const std::vector<Vec3> now = {{0, 0, 0}, {0.01, 0, 0}, {turned, -turned, 1e-3}, {turned, 0.01, 1e-3}};
        mesh.rest = now;
        PairCache near(mesh);
        near.update_bounds({now, now}, {.margin = 1e-3, .max_path = 0.1});
        ContactSet contacts;
        contacts.find(mesh, material, near.contact_pairs(now), now, now);
        BOOST_REQUIRE(contacts.contacts().size() == 1u);
        BOOST_TEST(contacts.contacts()[0].stiffness == 2.0, boost::test_tools::tolerance(1e-12));
    }
}

BOOST_AUTO_TEST_CASE(a_filtered_move_keeps_of_every_distance_half_of_contact_or_a_fifth) {
    int violations = 0;
    for (unsigned seed = 0; seed < 20; ++seed)
        for (const bool still : {true, false}) {
            const Crowd crowd(12, 0.02, 0.03, seed);
            if (crowd.closest(crowd.start) < 1e-5) continue;
            std::vector<Vec3> filtered;
            const CcdReport report = still ? crowd.limit(filtered) : crowd.resolve(filtered);
            violations += report.impacts;
            BOOST_TEST(crowd.closest(filtered) > 1e-6);
            BOOST_TEST(crowd.least_kept(filtered) > 1.0 - 1e-9);
        }
    BOOST_TEST(violations > 100);
}

// Some are held back near what they meet, and stop as a whole for others: what met is asked again until it no longer does.
BOOST_AUTO_TEST_CASE(long_strands_that_are_in_one_another_s_way_everywhere_meet_nowhere) {
    int violations = 0;
    for (unsigned seed = 0; seed < 200; ++seed) {
        const Crowd crowd(60, 0.02, 0.01, seed, 30);
        std::vector<Vec3> filtered;
        violations += crowd.limit(filtered).impacts;
        BOOST_TEST(!crowd.has_impacts(filtered), "crowd " << seed);
    }
    BOOST_TEST(violations > 10000);
}

BOOST_AUTO_TEST_CASE(strands_that_go_less_far_than_they_were_let_meet_nothing_either) {
    int violations = 0;
    for (unsigned seed = 0; seed < 50; ++seed) {
        const Crowd crowd(60, 0.02, 0.01, seed, 30);
        std::vector<Vec3> filtered;
        violations += crowd.limit_and_shorten(filtered).impacts;
        BOOST_TEST(!crowd.has_impacts(filtered), "crowd " << seed);
    }
    BOOST_TEST(violations > 100);
}

BOOST_AUTO_TEST_CASE(a_move_that_meets_nothing_is_left_alone) {
    const Crowd crowd(1, 0.02, 0.03, 3);
    std::vector<Vec3> filtered;
    BOOST_TEST(crowd.limit(filtered).impacts == 0);
    BOOST_TEST((filtered == crowd.end));
}

// Strands in a row, 4 mm apart, that are drawn together towards the first, which stays: every one is in the way of the next.
BOOST_AUTO_TEST_CASE(a_chain_of_strands_stops_in_one_round) {
    constexpr int strands = 20;
    Crowd crowd(strands, 0.02, 0.03, 0);
    for (int v = 0; v < 3 * strands; ++v) {
        const int strand = v / 3;
        crowd.start[v] = crowd.mesh.rest[v] = {4e-3 * strand, 0.01 * (v % 3), 1e-4 * strand};
        crowd.end[v] = crowd.start[v] - Vec3(4.5e-3 * strand, 0.0, 0.0);
    }
    std::vector<Vec3> filtered;
    const CcdReport report = crowd.limit(filtered);
    BOOST_TEST(report.impacts >= strands - 1);
    BOOST_TEST(report.rounds == 1);
    BOOST_TEST(report.fraction == 1.0);
    BOOST_TEST(crowd.least_kept(filtered) > 1.0 - 1e-9);
    const double part = (filtered[3] - crowd.start[3]).norm() / 4.5e-3;
    BOOST_TEST(part > 0.6);
    for (int v = 3; v < 3 * strands; ++v) // each as a whole, and all the same part of their ways
        BOOST_TEST((filtered[v] - crowd.start[v] - part * (crowd.end[v] - crowd.start[v])).norm() < 1e-12);
}

BOOST_AUTO_TEST_CASE(only_relative_motion_is_filtered) {
    Crowd crowd(12, 0.02, 0.03, 5);
    std::vector<Vec3> filtered, filtered_flying;
    const CcdReport report = crowd.resolve(filtered);
    const Vec3 flight(100.0 / 24, 0.0, 0.0);
    for (Vec3 &place : crowd.end) place += flight;
    const CcdReport flying = crowd.resolve(filtered_flying);
    BOOST_TEST(report.impacts > 0);
    BOOST_TEST(report.impacts == flying.impacts);
    for (size_t v = 0; v < filtered.size(); ++v) BOOST_TEST((filtered_flying[v] - flight - filtered[v]).norm() < 1e-8);
}

BOOST_AUTO_TEST_SUITE_END()
