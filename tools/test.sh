#!/bin/bash
# Everything that must hold, one step after the other; what fails is shown, and the rest still runs.
set -u
cd "$(dirname "$0")/.."
bin=.venv/bin
results=$(mktemp -d)
trap 'rm -rf "$results"' EXIT

step() { # name, command …
    local name=$1 start=$SECONDS log
    log=$(mktemp -p "$results" --suffix .log)
    if "${@:2}" >"$log" 2>&1; then
        printf 'ok      %-40s %4d s\n' "$name" $((SECONDS - start))
    else
        (
            flock 9 # of two that fail at once
            printf 'FAILED  %-40s %4d s\n' "$name" $((SECONDS - start))
            sed 's/^/        /' "$log"
            echo "$name" >&9
        ) 9>>"$results/failed"
    fi
}

cpp_tests() {
    $bin/cmake -S . -B build/editable && $bin/cmake --build build/editable --target ringlet_tests &&
        $bin/ctest --test-dir build/editable --output-on-failure
}

# Two tests at a time, each on one thread: threads that wait for one another would take the processors from the other test.
# Each worker begins with half of the files in a row, so that what a file shares is made once.
pytests() { OMP_NUM_THREADS=1 $bin/python -m pytest -n 2 --dist worksteal --durations 8 "$@"; }

step "C++ tests" cpp_tests
# Beside the Python tests: at a lower priority they would end last, each on one processor.
step "lints" tools/lint.sh &
step "documents" tools/docs.sh &
step "counts of instructions and calls" $bin/python -m pytest -rs tests/counts & # with valgrind, where there is one
step "tests of the page" tools/web.sh test & # in a DOM, without a browser
step "Python tests" pytests tests/python
step "physics tests" pytests tests/physics
step "browser tests" pytests -rs tests/browser # in headless Chromium; where there is none they are skipped, and say so
wait

printf '\nThe slowest tests:\n'
grep -hE '^[0-9.]+s (call|setup|teardown) ' "$results"/*.log | sort -rn | head -n 8

if [ -s "$results/failed" ]; then
    printf '\nRinglet: %d of 8 steps failed: %s\n' "$(wc -l <"$results/failed")" "$(paste -sd, "$results/failed")"
    exit 1
fi
printf '\nRinglet: everything holds (%d s).\n' $SECONDS
