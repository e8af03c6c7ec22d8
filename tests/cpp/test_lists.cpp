// Lists of varying length.
#include "ringlet/math/lists.h"

#include <boost/test/unit_test.hpp>
#include <random>

using namespace ringlet;

BOOST_AUTO_TEST_SUITE(lists)

// Of many items, so that they are sorted in several ranges and bins, and of few.
BOOST_AUTO_TEST_CASE(lists_have_their_items_in_the_order_of_those_who_added_them) {
    std::mt19937 random(1);
    for (const auto [lists, count] : {std::array{0, 0}, {5, 0}, {1, 9}, {3, 40}, {3, 20000}, {64, 5000}, {10000, 300000}}) {
        std::vector<std::array<int, 2>> into(count);
        for (auto &two : into)
            for (int &list : two) list = int(random() % unsigned(lists));
        std::vector<std::vector<int>> expected(lists);
        for (int k = 0; k < count; ++k)
            for (const int list : into[k])
                if (list % 7 != 3) expected[list].push_back(k);
        const Lists<int> found(lists, count, [&](int k, const auto &add) {
            for (const int list : into[k])
                if (list % 7 != 3) add(list, k);
        });
        int begin = 0;
        for (int list = 0; list < lists; ++list) {
            BOOST_TEST(std::vector<int>(found.of(list).begin(), found.of(list).end()) == expected[list]);
            BOOST_TEST(found.begin(list) == begin);
            begin = found.end(list);
        }
        BOOST_TEST(begin == int(found.items().size()));
    }
}

BOOST_AUTO_TEST_SUITE_END()
