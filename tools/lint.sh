#!/bin/bash
# Formatting, types, static analysis, who may call whom, and words. All of them run, and one that fails fails the whole.
set -u
cd "$(dirname "$0")/.."
bin=.venv/bin
status=0
check() { # name, command …
    echo "lint: $1"
    "${@:2}" || { status=1 && echo "lint: $1 failed" >&2; }
}

types() { # the compiled module is seen through its stub
    $bin/python -m nanobind.stubgen -q -m ringlet._core -o python/ringlet/_core.pyi && $bin/pyright --warnings
}

tidy() {
    $bin/cmake -S . -B build/tidy -D RINGLET_UNITY=OFF -D SKBUILD_PROJECT_VERSION=0 -D Python_EXECUTABLE="$PWD/$bin/python" >/dev/null &&
        $bin/python tools/tidy.py build/tidy
}

mapfile -d '' cpp < <(find src bindings tests/cpp -name '*.h' -print0 -o -name '*.cpp' -print0)
check "python" $bin/ruff check --quiet .
check "python format" $bin/ruff format --quiet --check .
check "python types" types
check "arrows" $bin/python tools/check_architecture.py
check "words" $bin/python tools/check_words.py
check "prose" $bin/python tools/check_prose.py
check "page" tools/web.sh check
check "protocol" $bin/python tools/make_protocol.py --check
check "c++ format" $bin/clang-format --dry-run -Werror "${cpp[@]}"
check "c++" tidy
exit $status
