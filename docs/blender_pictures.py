"""Makes the pictures of docs/blender.md: grooms of the example head, made by the extension and rendered by Cycles.

Usage: python docs/blender_pictures.py [NAME …]; needs `make blender`.
"""

from __future__ import annotations

import json
import os
import runpy
import subprocess
import sys
import tempfile
from pathlib import Path

from pxr import Usd, UsdGeom

ROOT = Path(__file__).parents[1]
HEAD = ROOT / "examples/child/head.usdc"
PICTURES = {  # recipe, and the fraction of its hairs
    "blender_curls": (ROOT / "examples/child/curls.recipe.toml", 0.35),
    "blender_box_braids": (ROOT / "examples/looks/box_braids.recipe.toml", 0.4),
    "blender_high_puff": (ROOT / "examples/looks/high_puff.recipe.toml", 0.6),
}


def main() -> None:
    """Renders all pictures that are asked for by name, or all there are."""
    python = ROOT / ".venv-blender/bin/python"
    chosen = sys.argv[1:] or list(PICTURES)
    stage = Usd.Stage.Open(str(HEAD))
    faces = list(UsdGeom.Subset(stage.GetPrimAtPath("/child/skin/scalp")).GetIndicesAttr().Get())
    clean = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    clean["PATH"] = f"{Path(sys.executable).parent}{os.pathsep}{clean['PATH']}"
    with tempfile.TemporaryDirectory() as folder:
        build = runpy.run_path(str(ROOT / "tools/blender_extension.py"))["build"]
        clean["BLENDER_USER_RESOURCES"] = folder
        for name in chosen:
            task = {
                "extension": str(build(Path(folder))),
                "head": str(HEAD),
                "scalp": faces,
                "recipe": str(PICTURES[name][0]),
                "fraction": PICTURES[name][1],
                "picture": str(ROOT / f"docs/images/{name}.jpg"),
            }
            script = Path(__file__).with_name("blender_render.py")
            subprocess.run([python, script], input=json.dumps(task), text=True, check=True, env=clean)


if __name__ == "__main__":
    main()
