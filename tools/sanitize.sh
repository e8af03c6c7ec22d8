#!/bin/bash
# Builds the core's tests with sanitizers and runs them: addresses and undefined behaviour together, then threads.
# Usage: tools/sanitize.sh [address|thread] [options of the tests, such as --run_test=contact]
set -eu
cd "$(dirname "$0")/.."
bin=$PWD/.venv/bin
which=${1:-both}
(($#)) && shift

sanitized() { # folder, sanitizers, then options of the tests
    local folder=build/$1 sanitizers=$2
    shift 2
    "$bin/cmake" -S . -B "$folder" -G Ninja -D CMAKE_BUILD_TYPE=RelWithDebInfo -D CMAKE_CXX_FLAGS_RELWITHDEBINFO="-O1" \
        -D CMAKE_MAKE_PROGRAM="$bin/ninja" -D Python_EXECUTABLE="$bin/python" -D SKBUILD_PROJECT_VERSION=0 \
        -D RINGLET_SANITIZE="$sanitizers" >"$folder.log" 2>&1 || { cat "$folder.log" >&2; return 1; }
    "$bin/cmake" --build "$folder" --target ringlet_tests -j "${JOBS:-2}"
    if [ "$sanitizers" = thread ] && nm "$folder/ringlet_tests" | grep -E ' U (GOMP|omp)_'; then
        echo "error: tests/sanitize/openmp.cpp lacks what is named above" >&2
        return 1
    fi
    echo "sanitize: $sanitizers"
    ASAN_OPTIONS=detect_leaks=1:strict_init_order=1 UBSAN_OPTIONS=print_stacktrace=1 \
        TSAN_OPTIONS=second_deadlock_stack=1 OMP_NUM_THREADS=${OMP_NUM_THREADS:-4} OMP_WAIT_POLICY=passive \
        "$folder/ringlet_tests" "$@"
}

mkdir -p build
[ "$which" = thread ] || sanitized address address,undefined "$@"
[ "$which" = address ] || sanitized thread thread "$@"
