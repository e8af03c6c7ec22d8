"""USD files whose layer somebody still holds: an open stage, or the error of an attempt to write."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from pxr import Usd, UsdGeom, Vt
from ringlet.data.stage import StageSpace
from ringlet.io.usd.stage import new_stage, writing

from ringlet import io

EXAMPLE = Path(__file__).parents[2] / "examples" / "child"


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


OPEN_AT_ONCE = """
import shutil, sys, threading, time
from pathlib import Path
from ringlet.io.usd.stage import reading

OVER = '#usda 1.0\\n(subLayers = [@./head.usdc@]\\n metersPerUnit = 1\\n upAxis = "Y")\\ndef "x{}" {{}}\\n'
folder, end, opened = Path(sys.argv[2]), time.monotonic() + 2.0, []
shutil.copyfile(sys.argv[1], folder / "head.usdc")  # a moment ago, so that it is reloaded

def read(number):
    while time.monotonic() < end:
        path = folder / "head.usdc"
        if number:
            path = folder / f"over{number}{len(opened) % 5}.usda"
            path.write_text(OVER.format(len(opened)))
        with reading(path) as source:
            opened.append(len(list(source.stage.Traverse())))

threads = [threading.Thread(target=read, args=(number,)) for number in (0, 0, 1, 2)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
print(len(opened) > 10)
"""


def test_threads_open_files_over_the_same_layer_at_once(tmp_path):
    """OpenUSD crashed within seconds where one thread reloaded a layer that another was opening."""
    head = str(EXAMPLE / "head.usdc")
    done = subprocess.run([sys.executable, "-c", OPEN_AT_ONCE, head, str(tmp_path)], capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (0, "True\n"), done.stderr[-400:]
