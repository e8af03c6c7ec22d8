#!/bin/bash
# Builds a wheel from the working tree for glibc 2.28 and later, and tries it out where nothing else is installed.
# The compiler is that of this machine. What it links with is in build/glibc: zig's symbols of the C library of that version, and the
# OpenMP of GCC that scikit-learn's wheel has. libstdc++ goes into the extension.
set -eu
cd "$(dirname "$0")/.."
bin=$PWD/.venv/bin
glibc=2.28
libraries=$PWD/build/glibc
[ -e python/ringlet/viewer/static/index.html ] || { echo "error: the review page is not built; make build" >&2; exit 2; }

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

make_libraries() {
    local library
    [ -e build/zig ] || "$bin/python" -m pip install --quiet --target build/zig ziglang
    mkdir -p "$libraries.part"
    # zig makes them when it links, and keeps them in its cache.
    echo 'void none(void) {}' |
        ZIG_GLOBAL_CACHE_DIR=$work/zig build/zig/ziglang/zig cc -target "$(uname -m)-linux-gnu.$glibc" -shared -x c - -o "$work/none.so"
    for library in c m pthread dl; do find "$work/zig" -name "lib$library.so.*" -exec cp {} "$libraries.part/lib$library.so" \;; done
    # Headers of glibc 2.32 and later read it; 0 says that there may be threads.
    echo 'char __libc_single_threaded __attribute__((visibility("hidden")));' | cc -x c - -c -fPIC -o "$libraries.part/threads.o"
    "$bin/python" -m pip download --quiet --no-deps --only-binary=:all: --dest "$work/openmp" scikit-learn
    "$bin/python" -m zipfile --extract "$work"/openmp/*.whl "$work/openmp"
    cp "$work"/openmp/scikit_learn.libs/libgomp-*.so* "$libraries.part/libgomp.so.1"
    mv "$libraries.part" "$libraries"
}

[ -e "$libraries" ] || make_libraries
export PATH=$bin:$PATH
"$bin/python" -m pip wheel --quiet --no-build-isolation --no-deps --wheel-dir "$work" \
    --config-settings=cmake.define.CMAKE_MODULE_LINKER_FLAGS="-L$libraries $libraries/threads.o -static-libstdc++ -Wl,--exclude-libs,ALL" .
# A function of a later glibc has no version here, and auditwheel does not see it.
later=$(nm -D --undefined-only build/wheel/_core.*.so | awk '$1 == "U" && $2 !~ /@|^_?Py|^__tls_get_addr$/ { print $2 }')
[ -z "$later" ] || { echo "error: not in glibc $glibc:" $later >&2; exit 1; }
LD_LIBRARY_PATH=$libraries "$bin/auditwheel" repair --plat "manylinux_${glibc/./_}_$(uname -m)" --wheel-dir dist "$work"/ringlet-*.whl
wheel=$(ls -t dist/ringlet-*.whl | head -1)

"$bin/python" -m venv "$work/venv"
"$work/venv/bin/python" -m pip install --quiet "$wheel"
echo "installed $wheel"
cd "$work"
PATH=$work/venv/bin:$PATH bash "$OLDPWD/tools/try_wheel.sh" # without extras
"$work/venv/bin/python" -m pip install --quiet "$OLDPWD/$wheel[pictures,review]"
"$work/venv/bin/ringlet" doctor
