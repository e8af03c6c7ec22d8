#!/bin/bash
# Cross-builds the core, its tests and a wheel for Linux ARM64 on Debian, and runs them with qemu-user.
# Usage: tools/arm.sh [core [options of the C++ tests] | wheel | python [options of pytest]]; all three without a word.
# Everything is below build/arm: the libraries and the Python of Debian for ARM64 are unpacked there and not installed.
set -eu
cd "$(dirname "$0")/.."
bin=$PWD/.venv/bin arm=$PWD/build/arm
sysroot=$arm/sysroot
which=${1:-all}
(($#)) && shift

say() { printf '%s\n' "$*" >&2; }
need() { # command, package of Debian
    command -v "$1" >/dev/null || { say "error: $1: not found; get it with: apt-get install $2"; exit 2; }
}

case $which in all | core | wheel | python) ;; *) say "error: $which: not known; say core, wheel or python"; exit 2 ;; esac
need apt-get apt # so this is Debian or Ubuntu
need dpkg-deb dpkg
need aarch64-linux-gnu-g++ g++-aarch64-linux-gnu
need qemu-aarch64 qemu-user
[ -e .venv/tooled ] || { say "error: .venv lacks what tests need; make .venv/tooled"; exit 2; }
"$bin/python" -c 'import sys; sys.exit(sys.version_info[:2] != (3, 11))' ||
    { say "error: .venv has another Python than 3.11, that of Debian 12 for ARM64; make .venv with python3.11"; exit 2; }

# Debian's packages for ARM64, unpacked; apt keeps its lists there too, so the system stays as it is.
make_sysroot() {
    local apt=$arm/apt package
    local options=(-qq -y -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o APT::Install-Recommends=false
        -o APT::Sandbox::User=root -o Dir::State::lists="$apt/lists" -o Dir::State::status="$apt/status"
        -o Dir::Cache="$apt/cache")
    mkdir -p "$apt/lists/partial" "$apt/cache/archives/partial"
    : >"$apt/status"
    apt-get "${options[@]}" update
    apt-get "${options[@]}" --download-only install python3.11 libatomic1 libgomp1 libstdc++6
    (cd "$apt/cache/archives" && apt-get "${options[@]}" download libpython3.11-dev) # whose dependencies are not needed
    rm -rf "$sysroot.part"
    mkdir -p "$sysroot.part/usr/"{lib,bin,sbin}
    for package in lib bin sbin; do ln -s usr/$package "$sysroot.part/$package"; done
    for package in "$apt"/cache/archives/*.deb; do dpkg-deb --extract "$package" "$sysroot.part"; done
    rm -rf "$sysroot"
    mv "$sysroot.part" "$sysroot"
}

# A virtual environment whose programs are scripts, which run Debian's Python for ARM64 with qemu.
make_environment() {
    local venv=$arm/venv
    rm -rf "$venv"
    mkdir -p "$venv/bin" "$venv/lib/python3.11/site-packages"
    printf 'home = %s/usr/bin\nversion = 3.11\n' "$sysroot" >"$venv/pyvenv.cfg"
    printf '#!/bin/sh\nexec qemu-aarch64 -L %q -0 %q %q "$@"\n' "$sysroot" "$venv/bin/python" "$sysroot/usr/bin/python3.11" \
        >"$venv/bin/python"
    printf '#!/bin/sh\nexec %q -c "from ringlet.cli import main; main()" "$@"\n' "$venv/bin/python" >"$venv/bin/ringlet"
    chmod +x "$venv"/bin/*
}

# Wheels for ARM64, chosen by the pip of this machine.
install() { # packages, or options of pip
    local glibc platforms=(--platform manylinux2014_aarch64)
    for glibc in $(seq 18 36); do platforms+=(--platform "manylinux_2_${glibc}_aarch64"); done
    "$bin/python" -m pip --python "$bin/python" install --quiet --upgrade --only-binary=:all: --python-version 3.11 \
        --implementation cp --abi cp311 --abi abi3 --abi none "${platforms[@]}" \
        --target "$arm/venv/lib/python3.11/site-packages" "$@"
}

build() { # the core, its tests and the wheel
    PATH=$bin:$PATH CMAKE_BUILD_PARALLEL_LEVEL=${JOBS:-2} _PYTHON_HOST_PLATFORM=linux-aarch64 \
        SETUPTOOLS_EXT_SUFFIX=.cpython-311-aarch64-linux-gnu.so \
        "$bin/python" -m pip wheel --quiet --no-build-isolation --no-deps --wheel-dir "$arm/wheel" \
        --config-settings=build-dir="$arm/core" --config-settings=build.targets="_core;ringlet_tests" \
        --config-settings=cmake.define.CMAKE_TOOLCHAIN_FILE="$PWD/cmake/arm64.cmake" \
        --config-settings=cmake.define.Python_INCLUDE_DIR="$sysroot/usr/include/python3.11" \
        --config-settings=cmake.define.CMAKE_CXX_FLAGS="-idirafter $sysroot/usr/include" . # where Debian's pyconfig.h looks
}

core_tests() { OMP_NUM_THREADS=${OMP_NUM_THREADS:-1} qemu-aarch64 -L "$sysroot" "$arm/core/ringlet_tests" "$@"; }

wheel() { # with the platform tag that fits, and libgomp in it
    PATH=$bin:$PATH LD_LIBRARY_PATH=$sysroot/usr/lib/aarch64-linux-gnu \
        "$bin/auditwheel" repair --wheel-dir dist "$arm"/wheel/ringlet-*.whl
    make_environment
    install "$(ls -t dist/ringlet-*aarch64.whl | head -1)[pictures,review]" pytest pytest-timeout httpx hypothesis
    PATH=$arm/venv/bin:$PATH bash tools/try_wheel.sh
}

python_tests() {
    local tests=("$@")
    [ -x "$arm/venv/bin/ringlet" ] || { say "error: no wheel is installed for ARM64; tools/arm.sh wheel"; exit 2; }
    ((${#tests[@]})) || tests=(tests/python/test_{curl,curves,binding,checkpoint,io_groom,io_curves,groom_operators}.py)
    OMP_NUM_THREADS=${OMP_NUM_THREADS:-1} "$arm/venv/bin/python" -m pytest -p no:cacheprovider --timeout 3600 "${tests[@]}"
}

[ -e "$sysroot" ] || make_sysroot
case $which in
    core) build && core_tests "$@" ;;
    wheel) build && wheel ;;
    python) python_tests "$@" ;;
    all) build && core_tests && wheel && python_tests ;;
esac
