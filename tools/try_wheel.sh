#!/bin/bash
# Tries an installed Ringlet, the one on the path, far from the sources: the pieces that a wheel may lack.
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python - <<'PROGRAM'
import pathlib
import ringlet
from ringlet import _core, viewer
from ringlet.data.share import share

package = pathlib.Path(ringlet.__file__).parent
assert "site-packages" in package.parts, f"{package} is not installed, but a working tree"
assert share("examples/child").is_relative_to(package), "the examples are not in the wheel"
assert (package / "_core.pyi").exists(), "the types of the core are not in the wheel"
page = pathlib.Path(viewer.__file__).parent / "static/index.html"
assert page.exists(), "the review page is not in the wheel"
print(f"ringlet {ringlet.__version__}, {_core.simd()}, {_core.thread_count()} threads, {package}")
PROGRAM
example=$(python -c 'from ringlet.data.share import share; print(share("examples/child"))')
ringlet doctor
ringlet groom "$example/light.recipe.toml" -o groom.usdc
ringlet sim "$example/nod.shot.toml" --groom groom.usdc --frames 1:2 -o cache.usdc
ringlet hair groom.usdc --cache cache.usdc --fraction 0.05 -o hair.usdc
ringlet validate cantilever
ringlet bench strands --strands 50
echo "the installed wheel works"
