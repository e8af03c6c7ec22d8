#!/bin/sh
# Makes .venv with the newest suitable Python, after checking that everything a build needs is there.
# What is missing is named in one line; as root on Debian or Ubuntu it is installed (not with RINGLET_NO_INSTALL=1).
set -eu
cd "$(dirname "$0")/.."

say() { printf '%s\n' "$*" >&2; }

may_install() { command -v apt-get >/dev/null && [ "$(id -u)" = 0 ] && [ -z "${RINGLET_NO_INSTALL:-}" ]; }

how_to_get() { # names for apt, dnf, brew
    if command -v apt-get >/dev/null; then echo "apt-get install $1"
    elif command -v dnf >/dev/null; then echo "dnf install $2"
    elif command -v brew >/dev/null; then echo "brew install $3"
    else echo "install $1 with the package manager of your system"; fi
}

need() { # check, what it is, names for apt, dnf, brew
    check=$1 what=$2
    shift 2
    if $check; then return; fi
    if may_install; then
        say "$what: not found, installing $1"
        # $1 holds several names, so it is not quoted.
        # shellcheck disable=SC2086
        { apt-get update && DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends $1; } >/dev/null 2>&1 || true
        if $check; then return; fi
    fi
    say "error: $what: not found; get it with: $(how_to_get "$@")"
    exit 2
}

compiler_works() {
    folder=$(mktemp -d)
    cat >"$folder/try.cpp" <<'PROGRAM'
#include <concepts>
#include <omp.h>
#include <span>
int main() { return static_cast<int>(std::span<int>().size()) + omp_get_num_threads() - 1; }
PROGRAM
    works=0
    "${CXX:-c++}" -std=c++20 -fopenmp "$folder/try.cpp" -o "$folder/try" >/dev/null 2>&1 || works=1
    rm -rf "$folder"
    return $works
}

# With venv and pip for it, and with the headers that an extension module is built against. The upper bound is that of usd-core.
is_suitable() {
    "$1" - <<'PROGRAM' >/dev/null 2>&1
import ensurepip, pathlib, sys, sysconfig, venv
assert (3, 11) <= sys.version_info < (3, 15)
assert (pathlib.Path(sysconfig.get_path("include")) / "Python.h").exists()
PROGRAM
}

find_python() {
    for python in ${PYTHON:-python3.14 python3.13 python3.12 python3.11 python3}; do
        if command -v "$python" >/dev/null && is_suitable "$python"; then return; fi
    done
    return 1
}

need compiler_works "a C++20 compiler with OpenMP" "g++" "gcc-c++" "gcc, then: make CXX=g++-15"
need find_python "Python 3.11 to 3.14 with venv and headers" "python3 python3-venv python3-dev" "python3 python3-devel" "python@3.13"

if ! .venv/bin/python -c 'import pip' >/dev/null 2>&1; then
    find_python
    say "Making .venv with $("$python" --version)"
    "$python" -m venv --clear .venv
fi
