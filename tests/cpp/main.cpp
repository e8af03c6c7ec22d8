#define BOOST_TEST_MODULE ringlet
#include <boost/test/included/unit_test.hpp>
