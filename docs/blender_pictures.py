"""Makes the pictures of docs/blender.md: grooms of the example head, made by the extension.

python docs/blender_pictures.py [NAME …]    rendered by Cycles; needs `make blender`
python docs/blender_pictures.py window      of Blender's window; needs a Blender with one (RINGLET_BLENDER names its
                                            command), and `apt-get install xvfb imagemagick xdotool`
"""

from __future__ import annotations

import json
import os
import runpy
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image
from pxr import Usd, UsdGeom

DOCS = Path(__file__).parent
ROOT = DOCS.parent
HEAD = ROOT / "examples/child/head.usdc"
PICTURES = {  # recipe, and the fraction of its hairs
    "blender_curls": (ROOT / "examples/child/curls.recipe.toml", 0.35),
    "blender_box_braids": (ROOT / "examples/looks/box_braids.recipe.toml", 0.4),
    "blender_high_puff": (ROOT / "examples/looks/high_puff.recipe.toml", 0.6),
}
SCREEN = (1100, 760)  # pixels
WINDOWS = ("head", "groom", "slider", "simulation")


def scalp(stage: Usd.Stage) -> list[int]:
    """Faces of the skin that carry hair."""
    return list(UsdGeom.Subset(stage.GetPrimAtPath("/child/skin/scalp")).GetIndicesAttr().Get())


def meshes(stage: Usd.Stage) -> dict[str, dict]:
    """Meshes of the head, its skin first: ``points`` [m] with Z up, ``faces`` and ``color``."""
    unit, found = UsdGeom.GetStageMetersPerUnit(stage), {}
    for prim in stage.Traverse():
        if prim.GetTypeName() == "Mesh":
            mesh = UsdGeom.Mesh(prim)
            corners, ends = mesh.GetFaceVertexIndicesAttr().Get(), np.cumsum(mesh.GetFaceVertexCountsAttr().Get())
            placed = np.array(mesh.ComputeLocalToWorldTransform(Usd.TimeCode.Default()))
            points = np.array(mesh.GetPointsAttr().Get()) @ placed[:3, :3] + placed[3, :3]
            points = unit * points[:, [0, 2, 1]] * [1, -1, 1]
            found[str(prim.GetPath())] = {
                "points": points.tolist(),
                "faces": [part.tolist() for part in np.split(np.array(corners), ends[:-1])],
                "color": list(mesh.GetDisplayColorAttr().Get()[0]),
            }
    return found


def window() -> None:
    """Walks through the extension in Blender's window."""
    stage = Usd.Stage.Open(str(HEAD))
    with tempfile.TemporaryDirectory() as folder:
        named = {"Kim" if path == "/child/skin" else path: mesh for path, mesh in meshes(stage).items()}
        task = {
            "extension": str(runpy.run_path(str(ROOT / "tools/blender_extension.py"))["build"](Path(folder))),
            "command": str(Path(sys.executable).with_name("ringlet")),
            "folder": folder,
            "scalp": scalp(stage),
            "meshes": named,
        }
        (Path(folder) / "task.json").write_text(json.dumps(task))
        blender = shlex.split(os.environ.get("RINGLET_BLENDER", "blender"))
        words = ["--factory-startup", "-p", "0", "0", *map(str, SCREEN), "--python", DOCS / "blender_window.py", "--"]
        screen = f"-screen 0 {SCREEN[0]}x{SCREEN[1]}x24"
        command = ["xvfb-run", "-a", "-s", screen, *blender, *map(str, words), f"{folder}/task.json"]
        clean = {**os.environ, "BLENDER_USER_RESOURCES": f"{folder}/user", "LIBGL_ALWAYS_SOFTWARE": "1"}
        subprocess.run(command, check=True, env=clean)
        for name in WINDOWS:
            picture = Image.open(Path(folder) / f"{name}.png").convert("RGB")
            picture.save(DOCS / f"images/blender_window_{name}.webp", quality=75, method=6)


def main() -> None:
    """Renders all pictures that are asked for by name, or all there are."""
    if sys.argv[1:] == ["window"]:
        window()
        return
    python = ROOT / ".venv-blender/bin/python"
    chosen = sys.argv[1:] or list(PICTURES)
    faces = scalp(Usd.Stage.Open(str(HEAD)))
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
                "picture": str(DOCS / f"images/{name}.jpg"),
            }
            script = DOCS / "blender_render.py"
            subprocess.run([python, script], input=json.dumps(task), text=True, check=True, env=clean)


if __name__ == "__main__":
    main()
