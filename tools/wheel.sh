#!/bin/bash
# Builds a wheel from the working tree, gives it the platform tag that fits, and tries it out where nothing else is installed.
set -eu
cd "$(dirname "$0")/.."
bin=$PWD/.venv/bin
[ -e python/ringlet/viewer/static/index.html ] || { echo "error: the review page is not built; make build" >&2; exit 2; }

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$bin/python" -m pip wheel --quiet --no-build-isolation --no-deps --wheel-dir "$work" .
PATH=$bin:$PATH "$bin/auditwheel" show "$work"/ringlet-*.whl
PATH=$bin:$PATH "$bin/auditwheel" repair --wheel-dir dist "$work"/ringlet-*.whl
wheel=$(ls -t dist/ringlet-*.whl | head -1)

"$bin/python" -m venv "$work/venv"
"$work/venv/bin/python" -m pip install --quiet "$wheel"
echo "installed $wheel"
cd "$work"
PATH=$work/venv/bin:$PATH bash "$OLDPWD/tools/try_wheel.sh" # without extras
"$work/venv/bin/python" -m pip install --quiet "$OLDPWD/$wheel[pictures,review]"
"$work/venv/bin/ringlet" doctor
