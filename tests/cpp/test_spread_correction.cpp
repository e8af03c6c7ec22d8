// Corrections that are spread along strands and over cloths.
#include "ringlet/ccd/settings.h"
#include "ringlet/ccd/spread_correction.h"

#include <boost/test/unit_test.hpp>

using namespace ringlet;

namespace {

// A chain of vertices 1 cm apart that all move by 3 mm.
struct Chain {
    static constexpr int count = 12;
    CollisionMesh mesh;
    std::vector<Vec3> start, end;
    std::vector<Correction> corrections = std::vector<Correction>(count);

    Chain() {
        for (int v = 0; v < count; ++v) {
            start.emplace_back(0.01 * v, 0.0, 0.0);
            end.push_back(start.back() + Vec3(0.0, 0.003, 0.0));
            if (v > 0) mesh.edges.push_back({v - 1, v});
        }
        mesh.moves.assign(count, 1);
        mesh.radius.assign(count, 1e-3);
        mesh.object.assign(count, 0);
        mesh.anchor.assign(count, -1);
        mesh.rest = start;
        corrections[5].weight = 1.0;
    }

    void spread() { spread_correction(Candidates(mesh), start, end, ccd::max_strain, corrections); }

    // The largest length of an edge's change, relative to its length at the start.
    double strain() const {
        std::vector<Vec3> corrected;
        for (int v = 0; v < count; ++v)
            corrected.push_back(end[v] + corrections[v].weight * (start[v] + corrections[v].motion - end[v]));
        double most = 0.0;
        for (const auto &[a, b] : mesh.edges)
            most = std::max(most, (corrected[b] - corrected[a] - (end[b] - end[a])).norm() / (start[b] - start[a]).norm());
        return most;
    }
};

} // namespace

BOOST_AUTO_TEST_SUITE(corrections)

BOOST_AUTO_TEST_CASE(no_edge_is_strained_beyond_the_limit_and_the_weight_vanishes_far_away) {
    Chain chain;
    BOOST_TEST(chain.strain() > 0.2);
    chain.spread();
    BOOST_TEST(chain.strain() <= ccd::max_strain + 1e-12);
    BOOST_TEST(chain.corrections[5].weight == 1.0);
    BOOST_TEST(chain.corrections[4].weight > 0.8);
    BOOST_TEST(chain.corrections[11].weight < 1e-9);
}

BOOST_AUTO_TEST_CASE(a_kinematic_vertex_is_not_corrected) {
    Chain chain;
    chain.mesh.moves[7] = 0;
    chain.spread();
    BOOST_TEST(chain.corrections[6].weight > 0.0);
    BOOST_TEST(chain.corrections[7].weight == 0.0);
    BOOST_TEST(chain.corrections[8].weight == 0.0);
}

BOOST_AUTO_TEST_SUITE_END()
