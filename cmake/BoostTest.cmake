# Boost.Test, used through its headers alone, from the PyPI package cmeel-boost.
include(PythonPrefix)
find_in_python_packages(boost_include cmeel.prefix/include/boost)
if(NOT boost_include)
  message(FATAL_ERROR "Boost.Test is missing: pip install cmeel-boost, or configure with RINGLET_TESTS=OFF")
endif()
cmake_path(GET boost_include PARENT_PATH boost_include)
add_library(BoostTest INTERFACE)
target_include_directories(BoostTest SYSTEM INTERFACE "${boost_include}")
