// The bounding volume hierarchy against all pairs of boxes.
#include "ringlet/geometry/bvh.h"

#include <boost/test/unit_test.hpp>
#include <random>
#include <set>

using namespace ringlet;

namespace {

SweptBox box_at(const Eigen::Array3f &start, const Eigen::Array3f &end, float half) {
    SweptBox box;
    box.low.head<3>() = start - half, box.high.head<3>() = start + half;
    box.end_low.head<3>() = end - half, box.end_high.head<3>() = end + half;
    box.set_flags(true, true);
    return box;
}

using LeafPairs = std::set<std::array<int, 2>>;

LeafPairs traversed(const Bvh &tree) {
    Traversal traversal;
    traversal.a = traversal.b = tree.nodes();
    traversal.one_tree = true, traversal.is_static = false;
    traversal.left = 1, traversal.found = 0;
    traversal.nodes[0] = {{0, 0}};
    LeafPairs pairs;
    for (; traversal.left > 0; traversal.found = 0) {
        RINGLET_DISPATCH(traverse, traversal, 1000000);
        for (int k = 0; k < traversal.found; ++k) {
            const auto &[a, b] = traversal.boxes[k].of;
            const auto [i, j] = std::minmax({tree.primitive(a), tree.primitive(b)});
            BOOST_REQUIRE(pairs.insert({i, j}).second); // each once
        }
    }
    return pairs;
}

LeafPairs all_pairs(const std::vector<SweptBox> &boxes) {
    LeafPairs pairs;
    for (int i = 0; i < int(boxes.size()); ++i)
        for (int j = i + 1; j < int(boxes.size()); ++j)
            if (may_overlap(boxes[i], boxes[j]) && overlap_at_one_time(boxes[i], boxes[j], 0.0f)) pairs.insert({i, j});
    return pairs;
}

} // namespace

BOOST_AUTO_TEST_SUITE(bvh)

BOOST_AUTO_TEST_CASE(a_traversal_finds_the_boxes_that_overlap_at_one_time_also_after_a_refit) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> in(0.0f, 1.0f);
    const auto anywhere = [&] { return Eigen::Array3f(in(random), in(random), in(random)); };
    for (const int count : {1, 5, 16, 300}) {
        std::vector<SweptBox> boxes;
        const auto random_box = [&] {
            const Eigen::Array3f start = anywhere();
            return box_at(start, start + 0.2f * anywhere(), 0.05f);
        };
        for (int i = 0; i < count; ++i) boxes.push_back(random_box());
        Bvh tree;
        tree.fit(count, [&](int i) { return boxes[i]; });
        BOOST_TEST((traversed(tree) == all_pairs(boxes)));
        std::vector<int> some;
        for (int i = 0; i < count; i += 3) some.push_back(i), boxes[i] = random_box();
        tree.refit(some, [&](int i) { return boxes[i]; });
        BOOST_TEST((traversed(tree) == all_pairs(boxes)));
        tree.deactivate();
        BOOST_TEST(traversed(tree).empty());
    }
}

BOOST_AUTO_TEST_CASE(boxes_that_cross_at_different_times_do_not_overlap) {
    const SweptBox right = box_at({0, 0, 0}, {2, 0, 0}, 0.1f), late = box_at({1, 3, 0}, {1, -1, 0}, 0.1f),
                   same_time = box_at({1, 1, 0}, {1, -1, 0}, 0.1f);
    BOOST_TEST(paths_overlap(right, late));
    BOOST_TEST(!overlap_at_one_time(right, late, 0.0f));
    BOOST_TEST(overlap_at_one_time(right, same_time, 0.0f));
    BOOST_TEST(!overlap_at_one_time(right, same_time, 0.5f)); // shrunk by more than their size
}

BOOST_AUTO_TEST_SUITE_END()
