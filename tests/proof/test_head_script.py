"""The example's head is what its script makes, which takes some twenty seconds."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from pxr import Usd
from scipy.spatial import cKDTree
from test_example_head import CHILD, HEAD, doubled_normals, read


def test_the_head_equals_the_output_of_its_script(tmp_path: Path) -> None:
    subprocess.run(
        [sys.executable, CHILD / "make_head.py", "-o", tmp_path / "head.usdc"], check=True, capture_output=True
    )
    stage = Usd.Stage.Open(str(HEAD))
    skin = read(stage, "/child/skin")
    again = Usd.Stage.Open(str(tmp_path / "head.usdc"))
    assert [str(p.GetPath()) for p in again.Traverse()] == [str(p.GetPath()) for p in stage.Traverse()]

    # Library versions may triangulate the surface differently, so surfaces are compared.
    made = read(again, "/child/skin")
    normals = np.zeros_like(skin.rest)
    for k in range(3):
        np.add.at(normals, skin.triangles[:, k], doubled_normals(skin.rest, skin.triangles))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    nearest = cKDTree(skin.rest).query(made.rest)[1]
    off = np.abs(((made.rest - skin.rest[nearest]) * normals[nearest]).sum(1))
    assert np.percentile(off, 99) < 0.1
    assert len(made.vertices("scalp")) == pytest.approx(len(skin.vertices("scalp")), rel=0.05)
    assert np.allclose(read(again, "/child/brow_left").clip, read(stage, "/child/brow_left").clip, atol=1e-3)
