#!/bin/bash
# Everything that must hold, one step after the other; what fails is shown, and the rest still runs.
set -u
cd "$(dirname "$0")/.."
bin=.venv/bin
log=$(mktemp) slow=$(mktemp)
trap 'rm -f "$log" "$slow"' EXIT
failed=()

step() { # name, command …
    local name=$1 start=$SECONDS
    shift
    if "$@" >"$log" 2>&1; then
        printf 'ok      %-40s %4d s\n' "$name" $((SECONDS - start))
    else
        printf 'FAILED  %-40s %4d s\n' "$name" $((SECONDS - start))
        sed 's/^/        /' "$log"
        failed+=("$name")
    fi
    grep -E '^[0-9.]+s (call|setup|teardown) ' "$log" >>"$slow"
}

cpp_tests() {
    $bin/cmake -S . -B build/editable -D RINGLET_TESTS=ON && $bin/cmake --build build/editable --target ringlet_tests &&
        $bin/ctest --test-dir build/editable --output-on-failure
}

# Two tests at a time, each on one thread: threads that wait for one another would take the processors from the other test.
pytests() { OMP_NUM_THREADS=1 $bin/python -m pytest -n 2 --durations 8 "$@"; }

step "C++ tests" cpp_tests
step "Python tests" pytests tests/python
step "physics tests" pytests tests/physics
step "counts of instructions and calls" $bin/python -m pytest -rs tests/counts # with valgrind, where there is one
step "browser tests" pytests -rs tests/browser # in headless Chromium; where there is none they are skipped, and say so
step "known answers (ringlet validate)" $bin/ringlet validate
step "lints" tools/lint.sh
step "documents" tools/docs.sh

printf '\nThe slowest tests:\n'
sort -rn "$slow" | head -n 8

if ((${#failed[@]})); then
    printf '\nRinglet: %d of 8 steps failed: %s\n' ${#failed[@]} "$(IFS=,; echo "${failed[*]}")"
    exit 1
fi
printf '\nRinglet: everything holds (%d s).\n' $SECONDS
