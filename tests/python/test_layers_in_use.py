"""USD files whose layer somebody still holds: an open stage, or the error of an attempt to write."""

import os

import numpy as np
import pytest
from pxr import Usd, UsdGeom, Vt
from ringlet.data.stage import StageSpace
from ringlet.io.usd.stage import new_stage, writing

from ringlet import io


def write(file, height: float, fails: bool = False) -> None:
    """Writes a triangle at a height."""
    with writing(file) as aside:
        stage = new_stage(aside, StageSpace())
        mesh = UsdGeom.Mesh.Define(stage, "/groom")
        mesh.CreatePointsAttr(Vt.Vec3fArray([(0, height, 0), (1, height, 0), (0, height, 1)]))
        mesh.CreateFaceVertexCountsAttr([3])
        mesh.CreateFaceVertexIndicesAttr([0, 2, 1])
        if fails:
            raise ZeroDivisionError
        stage.Save()


def height(file) -> float:
    return float(np.unique(io.read_mesh(file).points[:, 1]).item())


def test_a_file_that_was_written_twice_in_a_tick_is_read_anew(tmp_path):
    file = tmp_path / "mesh.usda"
    write(file, 1.0)
    held, time = Usd.Stage.Open(str(file)), file.stat().st_mtime_ns
    write(file, 2.0)
    os.utime(file, ns=(time, time))
    assert height(file) == 2.0
    assert held


def test_a_file_is_written_after_an_attempt_whose_error_is_kept(tmp_path):
    file = tmp_path / "mesh.usdc"
    with pytest.raises(ZeroDivisionError) as kept:
        write(file, 1.0, fails=True)
    write(file, 2.0)
    assert height(file) == 2.0 and kept.value
