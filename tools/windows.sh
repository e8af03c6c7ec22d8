#!/bin/bash
# Cross-builds the core and its tests for Windows with zig, and runs them with Wine.
# Usage: tools/windows.sh [options of the C++ tests]. Everything is below build/windows and build/zig.
set -eu
cd "$(dirname "$0")/.."
bin=$PWD/.venv/bin windows=$PWD/build/windows
wine=$(command -v wine64 || command -v /usr/lib/wine/wine64) ||
    { echo "error: wine64: not found; get it with: apt-get install wine64" >&2; exit 2; }
[ -e .venv/tooled ] || { echo "error: .venv lacks what tests need; make .venv/tooled" >&2; exit 2; }

[ -e build/zig ] || "$bin/python" -m pip install --quiet --target build/zig ziglang
if [ ! -e "$windows/openmp" ]; then # Intel's, which takes what Clang compiles; it has a licence of its own, and goes into no wheel
    "$bin/python" -m pip download --quiet --no-deps --only-binary=:all: --platform win_amd64 --dest "$windows/wheels" intel-openmp
    "$bin/python" -m zipfile --extract "$windows"/wheels/intel_openmp-*.whl "$windows/unpacked"
    mkdir "$windows/openmp"
    find "$windows/unpacked" \( -name libiomp5md.dll -o -name libiomp5md.lib -o -name omp.h \) -exec mv {} "$windows/openmp" \;
    rm -r "$windows/unpacked"
fi

export PATH=$PWD/build/zig/ziglang:$bin:$PATH ZIG_GLOBAL_CACHE_DIR=$windows/cache
cmake -S . -B "$windows/core" -G Ninja -D CMAKE_BUILD_TYPE=Release -D CMAKE_TOOLCHAIN_FILE=cmake/windows.cmake \
    -D Python_EXECUTABLE="$bin/python" -D SKBUILD_PROJECT_VERSION=0 -D CMAKE_DISABLE_PRECOMPILE_HEADERS=ON \
    -D OpenMP_CXX_FLAGS="-fopenmp -I$windows/openmp" -D OpenMP_CXX_LIB_NAMES=libiomp5md \
    -D OpenMP_libiomp5md_LIBRARY="$windows/openmp/libiomp5md.lib"
cmake --build "$windows/core" --target ringlet_tests -j "${JOBS:-2}"
# Wine 8 lacks a function by which this OpenMP finds which processors are near each other.
WINEPREFIX=$windows/wine WINEDEBUG=-all WINEPATH=$windows/openmp KMP_AFFINITY=disabled \
    "$wine" "$windows/core/ringlet_tests.exe" "$@"
