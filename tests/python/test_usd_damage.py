"""Damaged crates are refused: OpenUSD would abort the process on some of them, or fill its memory.

Files that may abort are read in a process of its own, so that an abort is a failure of one test.
"""

from __future__ import annotations

import random
import struct
import subprocess
import sys
from pathlib import Path

import pytest
from pxr import Sdf, Usd, UsdGeom, UsdUtils
from ringlet.io import open_scene, problems, read_meshes
from usd_scenes import write_head

from ringlet import UserError

DAMAGED = Path(__file__).parents[1] / "cases" / "usdc_abort" / "damaged.usdc"
SECTIONS = ("TOKENS", "STRINGS", "FIELDS", "FIELDSETS", "PATHS", "SPECS")
READ = """
import sys
from ringlet import UserError, io
refused = 0
for path in sys.argv[1:]:
    for read in (io.read_meshes, io.read_groom, io.read_cache, io.read_curves, io.read_stage, io.problems, io.is_cache):
        try:
            read(path)
        except UserError:
            refused += 1
print(refused)
"""


def in_a_process(code: str, *words: object) -> str:
    """What a program prints; an abort fails the test."""
    call = [sys.executable, "-c", code, *map(str, words)]
    done = subprocess.run(call, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr[-2000:]
    return done.stdout


def section(data: bytes | bytearray, name: str) -> tuple[int, int]:
    """Place of the entry of a section in the table of contents, and of the section itself."""
    (contents,) = struct.unpack_from("<q", data, 16)
    row = data.index(name.encode() + b"\0", contents)
    return row, struct.unpack_from("<q", data, row + 16)[0]


def test_commands_refuse_a_crate_on_which_the_library_aborts(tmp_path):
    code = """
import sys
from ringlet.cli.app import app
from typer.testing import CliRunner
path, out = sys.argv[1:]
for words in (["convert", path, f"{out}/o.usda"], ["adopt", path, "-o", f"{out}/o.toml"], ["check", path],
              ["hair", path, "-o", f"{out}/o.usdc"]):
    print(CliRunner().invoke(app, words).exit_code)
"""
    assert in_a_process(code, DAMAGED, tmp_path).split() == ["2"] * 4
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", [*SECTIONS, "encoded paths", "sections"])
def test_a_count_that_the_file_cannot_hold_is_refused_before_memory_is_reserved(tmp_path, name):
    data = bytearray(write_head(tmp_path / "head.usdc").read_bytes())
    places = {"sections": struct.unpack_from("<q", data, 16)[0], "encoded paths": section(data, "PATHS")[1] + 8}
    struct.pack_into("<Q", data, places[name] if name in places else section(data, name)[1], 2**40)
    (tmp_path / "a.usdc").write_bytes(data)
    with pytest.raises(UserError, match=r"a\.usdc: cannot be read as USD \(damaged: "):
        read_meshes(tmp_path / "a.usdc")


@pytest.mark.parametrize("name", SECTIONS)
def test_a_section_outside_the_file_is_refused(tmp_path, name):
    data = bytearray(write_head(tmp_path / "head.usdc").read_bytes())
    struct.pack_into("<q", data, section(data, name)[0] + 24, len(data))
    (tmp_path / "a.usdc").write_bytes(data)
    with pytest.raises(UserError, match="damaged: a section of"):
        read_meshes(tmp_path / "a.usdc")


@pytest.fixture(scope="module")
def counted(tmp_path_factory):
    """A crate in which each kind of value has a number of entries of its own."""
    path = tmp_path_factory.mktemp("counted") / "a.usdc"
    stage = Usd.Stage.CreateNew(str(path))
    mesh = UsdGeom.Mesh.Define(stage, "/mesh")
    mesh.CreatePointsAttr([(k, k * k, 0.5) for k in range(1201)])
    mesh.CreateFaceVertexIndicesAttr([k * k for k in range(1301)])
    mesh.GetPrim().SetMetadata("apiSchemas", Sdf.TokenListOp.CreateExplicit([f"of_{k}" for k in range(1401)]))
    mesh.GetPrim().SetChildrenReorder([f"child_{k}" for k in range(1501)])
    for frame in range(1601):
        mesh.GetExtentAttr().Set([(0, 0, 0), (1, 1, frame)], frame)
    stage.Save()
    return path.read_bytes()


@pytest.mark.parametrize("entries", [1201, 1301, 1401, 1501, 1601])
def test_a_value_of_more_entries_than_the_file_can_hold_is_refused(counted, tmp_path, entries):
    """Numbers, packed numbers, a list, names, times and the values at times; a billion of them took 75 s and 12 GB."""
    path, places = tmp_path / "a.usdc", [counted.find(struct.pack("<Q", entries))]
    while (more := counted.find(struct.pack("<Q", entries), places[-1] + 1)) >= 0:
        places.append(more)
    path.write_bytes(counted)
    read_meshes(path)
    for place in places:
        path.write_bytes(counted[:place] + struct.pack("<Q", 2**30) + counted[place + 8 :])
        with pytest.raises(UserError, match=r"a\.usdc: cannot be read as USD \(damaged: 1073741824 entries are not in"):
            read_meshes(path)


@pytest.mark.parametrize("arc", ["sublayer", "reference", "payload", "clip", "template"])
def test_layers_under_a_file_are_checked_too(tmp_path, arc):
    write_head(tmp_path / "head.usdc")
    data = bytearray((tmp_path / "head.usdc").read_bytes())
    struct.pack_into("<Q", data, section(data, "SPECS")[1], 2**40)
    (tmp_path / "bad.1.usdc").write_bytes(data)
    stage = Usd.Stage.CreateNew(str(tmp_path / "a.usda"))
    prim, name = UsdGeom.Xform.Define(stage, "/head").GetPrim(), "./bad.1.usdc"
    stage.SetDefaultPrim(prim)
    if arc == "sublayer":
        stage.GetRootLayer().subLayerPaths.append(name)
    elif arc == "reference":
        prim.GetReferences().AddReference(name, "/head")
    elif arc == "payload":
        prim.GetPayloads().AddPayload(name, "/head")
    elif arc == "clip":
        Usd.ClipsAPI(prim).SetClipAssetPaths([Sdf.AssetPath(name)])
    else:
        Usd.ClipsAPI(prim).SetClipTemplateAssetPath("./bad.#.usdc")
    stage.GetRootLayer().Export(str(tmp_path / "over.usda"))
    with pytest.raises(UserError, match=r"bad\.1\.usdc: cannot be read as USD \(damaged: "):
        problems(tmp_path / "over.usda")


def test_a_crate_in_a_package_is_checked_too(tmp_path):
    data, package = write_head(tmp_path / "head.usdc").read_bytes(), tmp_path / "head.usdz"
    UsdUtils.CreateNewUsdzPackage(str(tmp_path / "head.usdc"), str(package))
    assert len(read_meshes(package)) == 1
    whole = bytearray(package.read_bytes())
    struct.pack_into("<Q", whole, whole.index(data) + section(data, "SPECS")[1], 2**40)
    (tmp_path / "bad.usdz").write_bytes(whole)
    with pytest.raises(UserError, match=r"bad\.usdz.*: cannot be read as USD \(damaged"):
        read_meshes(tmp_path / "bad.usdz")
    (tmp_path / "cut.usdz").write_bytes(whole[:-30])
    with pytest.raises(UserError, match=r"cut\.usdz: cannot be read as USD"):
        read_meshes(tmp_path / "cut.usdz")


def test_no_changed_bytes_end_the_process(tmp_path):
    """A byte, a bit, or the end of a file is changed, as often in each section."""
    rng, good = random.Random(7), write_head(tmp_path / "head.usdc").read_bytes()
    starts = [0, 88, *sorted(section(good, name)[1] for name in SECTIONS), struct.unpack_from("<q", good, 16)[0]]
    spans = list(zip(starts, [*starts[1:], len(good)], strict=True))
    for k in range(6 * len(spans)):
        data = bytearray(good)
        for _ in range(rng.choice((1, 1, 2, 5))):
            place = rng.randrange(*spans[k % len(spans)])
            data[place] = rng.choice((rng.randrange(256), data[place] ^ (1 << rng.randrange(8))))
        if k % 10 == 9:
            del data[rng.randrange(len(data)) :]
        (tmp_path / f"{k}.usdc").write_bytes(data)
    assert int(in_a_process(READ, *(tmp_path / f"{k}.usdc" for k in range(6 * len(spans))))) > 100


def test_a_file_that_is_damaged_while_a_stage_holds_it_is_refused(tmp_path):
    """The open stage shares its layers; what would be reloaded is checked apart."""
    path = write_head(tmp_path / "head.usdc")
    with open_scene(path):
        path.unlink()
        path.write_bytes(DAMAGED.read_bytes())
        with pytest.raises(UserError, match="damaged: "):
            read_meshes(path)
