# Eigen from the PyPI package cmeel-eigen, or one that CMake finds by itself.
include(PythonPrefix)
find_in_python_packages(eigen_config cmeel.prefix/share/eigen3/cmake)
find_package(Eigen3 3.4 REQUIRED NO_MODULE HINTS "${eigen_config}")
