// Strands of different lengths, gathered into lanes and scattered back.
#include "ringlet/strand/lane_gather.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <numeric>
#include <vector>

using namespace ringlet::baseline;
using ringlet::StrandGroup;

namespace {

// Strands of 3, 4, 5 … vertices, each number different from all others.
struct Arrays {
    Arrays() : offsets{0} {
        for (int k = 0; k < lanes + 1; ++k) offsets.push_back(offsets.back() + 3 + k);
        scalars.resize(offsets.back());
        vectors.resize(3 * offsets.back());
        std::iota(scalars.begin(), scalars.end(), 1.0);
        std::iota(vectors.begin(), vectors.end(), 1001.0);
        order.resize(lanes);
        std::iota(order.rbegin(), order.rend(), 1); // the longest first; strand 0 is in no lane
    }
    LaneGather gather(int count) const { return {offsets.data(), StrandGroup{order.data(), count}}; }

    std::vector<int> offsets, order;
    std::vector<double> scalars, vectors;
};

} // namespace

BOOST_AUTO_TEST_SUITE(lane_gather)

BOOST_AUTO_TEST_CASE(a_round_trip_leaves_arrays_as_they_were) {
    const Arrays arrays;
    const LaneGather gather = arrays.gather(lanes);
    std::vector<double> copy(arrays.vectors.size(), 0.0);
    BOOST_TEST(gather.strands() == lanes);
    BOOST_TEST(gather.vertices() == 3 + lanes);
    for (int k = 0; k < gather.strands(); ++k)
        for (int i = 0; i < gather.lane(k).vertices; ++i)
            LaneGather::scatter(gather.vector(arrays.vectors.data(), i), gather.lane(k), i, copy.data());
    BOOST_TEST(std::all_of(copy.begin(), copy.begin() + 9, [](double x) { return x == 0.0; })); // of strand 0
    BOOST_TEST(std::equal(copy.begin() + 9, copy.end(), arrays.vectors.begin() + 9));
}

BOOST_AUTO_TEST_CASE(rows_of_a_lane_are_those_of_its_strand) {
    const Arrays arrays;
    const LaneGather gather = arrays.gather(lanes);
    for (int i = 0; i < gather.vertices(); ++i) {
        const Pack scalar = gather.scalar(arrays.scalars.data(), i, -7.0);
        for (int k = 0; k < lanes; ++k) {
            const StrandLane &strand = gather.lane(k);
            BOOST_TEST(strand.strand == arrays.order[k]);
            BOOST_TEST(scalar[k] == (i < strand.vertices ? arrays.scalars[strand.first + i] : -7.0));
        }
    }
}

BOOST_AUTO_TEST_CASE(behind_a_tip_positions_go_on_in_steps_of_a_metre) {
    const Arrays arrays;
    const LaneGather gather = arrays.gather(lanes);
    for (int k = 0; k < lanes; ++k) {
        const StrandLane &strand = gather.lane(k);
        const Vec<Pack> tip = gather.position(arrays.vectors.data(), strand.vertices - 1);
        for (int i = strand.vertices; i < gather.vertices(); ++i) {
            const Vec<Pack> p = gather.position(arrays.vectors.data(), i);
            BOOST_TEST(p.x[k] == tip.x[k] + (i - strand.vertices + 1));
            BOOST_TEST(p.y[k] == tip.y[k]);
            BOOST_TEST(p.z[k] == tip.z[k]);
        }
    }
}

BOOST_AUTO_TEST_CASE(lanes_without_a_strand_repeat_the_first_and_scatter_zero) {
    const Arrays arrays;
    const LaneGather gather = arrays.gather(1);
    BOOST_TEST(gather.strands() == 1);
    BOOST_TEST(gather.lane(lanes - 1).strand == arrays.order[0]);
    std::vector<double> values(lanes, -1.0);
    gather.scatter(constant<Pack>(4.0), values.data());
    BOOST_TEST(values[0] == 4.0);
    BOOST_TEST(values[lanes - 1] == 0.0);
}

BOOST_AUTO_TEST_CASE(edges_corners_and_hinges_need_two_three_and_four_vertices) {
    const StrandLane strand{0, 0, 0, 4};
    for (int i = 0; i < 6; ++i) {
        BOOST_TEST(strand.has_vertex(i) == (i < 4));
        BOOST_TEST(strand.has_edge(i) == (i < 3));
        BOOST_TEST(strand.has_corner(i) == (i == 1 || i == 2));
        BOOST_TEST(strand.has_hinge(i) == (i == 1));
    }
}

BOOST_AUTO_TEST_SUITE_END()
