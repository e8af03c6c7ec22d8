"""``ringlet convert --unreal``: archives against Epic's specification of grooms, as alembic3d reads them."""

from __future__ import annotations

import importlib.util
import time

import numpy as np
import pytest
from commands import refused, run
from ringlet.data.curves import Curves
from ringlet.data.groom import GROOM
from ringlet.data.hair_scene import CurveSet, HairScene
from ringlet.data.mesh import Mesh
from ringlet.data.stage import StageSpace
from ringlet.io import for_unreal, open_scene, write_scene
from ringlet.io import unreal as limits

from ringlet import convert

pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("alembic3d") is None, reason="alembic3d is not installed: pip install 'ringlet[alembic]'"
)
SPACE = StageSpace(0.01)
# Of the specification: the type of each attribute, with its extent, and the scope that it may have.
SPECIFIED = {
    "groom_guide": ("Int32", "kUniformScope"),
    "groom_group_id": ("Int32", "kUniformScope"),
    "groom_id": ("Int32", "kUniformScope"),
    "groom_root_uv": ("V2f", "kUniformScope"),
    "groom_color": ("V3f", "kVertexScope"),
    "groom_closest_guides": ("V3i", "kUniformScope"),
    "groom_guide_weights": ("V3f", "kUniformScope"),
}


def scene(points=(300, 40, 7)):
    """Three hairs of two grooms, two guides with 100 points each, a head, and three samples between frames."""

    def helix(root, count):
        angle = np.linspace(0.0, 40.0, count)
        return np.stack([root + 0.01 * np.cos(angle), 0.002 * angle, 0.01 * np.sin(angle)], axis=1)

    hairs = Curves.from_list([helix(0.1 * k, count) for k, count in enumerate(points)], [10**15, -3, 7])
    hairs.curve = {
        GROOM: np.array([0, 1, 1], np.int32),
        "guide_curve_index": np.array([1, 0, 0], np.int32),
        "st": np.full((3, 2), 0.5, np.float32),
    }
    hairs.point = {
        "width": np.full(sum(points), 1e-4, np.float32),
        "groom_color": np.ones((sum(points), 3), np.float32),
    }
    guides = Curves.from_list([helix(0.1 * k, 100) for k in (1, 0)], [5, 6])
    guides.curve = {GROOM: np.array([1, 0], np.int32)}
    sets = [
        CurveSet("hairs", hairs, motion=lambda frame: hairs.points + [0.0, frame, 0.0]),
        CurveSet("guides", guides, True, lambda frame: guides.points + [0.0, frame, 0.0]),
    ]
    head = Mesh("head", np.eye(3), np.array([[0, 1, 2]], np.int32))
    return HairScene(sets, [(head, None)], np.array([0.25, 1.25, 2.25]), StageSpace())


def write(path, given=None):
    written, lost = for_unreal(given or scene())
    return written, lost + write_scene(written, path, SPACE)[1]


def opened(path):
    """The top transform, and by name of each object with curves its schema; no other geometry may be there."""
    from alembic3d import Abc, AbcGeom

    archive = Abc.IArchive(str(path))
    wrap = Abc.WrapExistingFlag.kWrapExisting
    (root,) = (archive.getTop().getChild(k) for k in range(archive.getTop().getNumChildren()))
    shapes = [root.getChild(k).getChild(0) for k in range(root.getNumChildren())]
    assert all(AbcGeom.ICurves.matches(shape.getMetaData()) for shape in shapes)  # a mesh makes it no groom
    found = {shape.getName(): AbcGeom.ICurves(shape, wrap).getSchema() for shape in shapes}
    return archive, AbcGeom.IXform(root, wrap).getSchema(), found


def values(parameters, name, kind):
    from alembic3d import AbcGeom

    found = getattr(AbcGeom, f"I{kind}GeomParam")(parameters, name).getExpandedValue().getVals()
    try:
        return np.array(memoryview(found))
    except TypeError:
        return np.array([tuple(row) for row in found])


def test_an_archive_has_the_properties_types_and_scopes_that_epic_specifies(tmp_path):
    from alembic3d import Abc, AbcGeom

    write(tmp_path / "a.abc")
    archive, top, found = opened(tmp_path / "a.abc")
    properties = top.getUserProperties()  # of the first transform, where the importer looks
    assert Abc.IInt16Property(properties, "groom_version_major").getValue() == 1
    assert Abc.IInt16Property(properties, "groom_version_minor").getValue() == 5
    assert Abc.IStringProperty(properties, "groom_tool").getValue().startswith("Ringlet 0.")
    ids = []
    for name, schema in found.items():
        parameters = schema.getArbGeomParams()
        names = [parameters.getPropertyHeader(k).getName() for k in range(parameters.getNumProperties())]
        assert SPECIFIED.keys() <= set(names) or (name == "guidesShape" and {"groom_id", "groom_guide"} <= set(names))
        for attribute, (kind, scope) in SPECIFIED.items():
            if attribute in names:
                typed = getattr(AbcGeom, f"I{kind}GeomParam")
                assert typed.matches(parameters.getPropertyHeader(names.index(attribute))), attribute
                assert str(typed(parameters, attribute).getScope()) == scope
        ids += values(parameters, "groom_id", "Int32").tolist()
        widths = schema.getWidthsParam()
        assert widths.valid() == (name == "hairsShape")
        assert not widths.valid() or str(widths.getScope()) == "kVertexScope"
    assert len(set(ids)) == len(ids) == 5 and min(ids) >= 0 and max(ids) <= 2**24
    del archive


def test_each_hair_names_its_lock_in_its_own_group(tmp_path):
    write(tmp_path / "a.abc")
    archive, _, found = opened(tmp_path / "a.abc")
    hairs, guides = (found[f"{name}Shape"].getArbGeomParams() for name in ("hairs", "guides"))
    groups = dict(
        zip(values(guides, "groom_id", "Int32").tolist(), values(guides, "groom_group_id", "Int32"), strict=True)
    )
    closest, weights = values(hairs, "groom_closest_guides", "V3i"), values(hairs, "groom_guide_weights", "V3f")
    ids = values(guides, "groom_id", "Int32")
    assert closest.tolist() == [[ids[1]] * 3, [ids[0]] * 3, [ids[0]] * 3]
    assert weights.tolist() == [[1, 0, 0]] * 3
    assert [groups[row[0]] for row in closest.tolist()] == values(hairs, "groom_group_id", "Int32").tolist()
    assert values(guides, "groom_guide", "Int32").tolist() == [1, 1]
    assert values(hairs, "groom_guide", "Int32").tolist() == [0, 0, 0]
    del archive
    with open_scene(tmp_path / "a.abc", SPACE) as back:
        assert back.unread == []
        assert back.sets[0].curves.curve["guide_curve_index"].tolist() == [1, 0, 0]
        assert back.sets[0].curves.ids.tolist() == [10**15, -3, 7]


def test_points_are_few_enough_and_those_of_shorter_curves_stay(tmp_path):
    before, (after, lost) = scene(), write(tmp_path / "a.abc")
    hairs, guides = (one.curves for one in after.sets)
    assert hairs.counts.tolist() == [255, 40, 7] and guides.counts.tolist() == [32, 32]
    np.testing.assert_array_equal(hairs.points[255:], before.sets[0].curves.points[300:])
    for now, old in ((hairs, before.sets[0].curves), (guides, before.sets[1].curves)):
        np.testing.assert_allclose(now.roots, old.roots, atol=1e-12)
        np.testing.assert_allclose(now.points[now.offsets[1:] - 1], old.points[old.offsets[1:] - 1], atol=1e-12)
    assert "Unreal takes curves of at most 255 points: 1 of 3 hairs were resampled, and are up to 0.053 mm" in lost[1]
    assert "Unreal simulates guides of at most 32 points: 2 of 2 guides were resampled, and are up to 2" in lost[2]
    assert lost[0] == "Unreal takes an archive with surfaces for no groom: without head; write them apart"


def test_samples_that_start_between_frames_are_kept_with_the_new_points(tmp_path):
    after, _ = write(tmp_path / "a.abc")
    archive, _, found = opened(tmp_path / "a.abc")
    for name, schema in found.items():
        sampling = schema.getTimeSampling()
        seconds = [sampling.getSampleTime(k) for k in range(schema.getNumSamples())]
        np.testing.assert_allclose(seconds, np.array([0.25, 1.25, 2.25]) / 24, atol=1e-9)
        moved = np.array(schema.getValue().getPositions(), np.float64)  # of the first sample, in centimetres
        rest = after.sets[name == "guidesShape"].curves.points
        np.testing.assert_allclose(moved / 100, rest + [0.0, 0.25, 0.0], atol=1e-6)
    del archive


def test_how_far_resampling_moves_points_is_measured():
    """Points of a zigzag of 10 mm, of which every second one is dropped, are 10 mm away."""
    zigzag = np.stack([np.arange(511.0) * 1e-9, np.zeros(511), 0.01 * (np.arange(511) % 2)], axis=1)
    given = HairScene([CurveSet("hairs", Curves.from_list([zigzag]))])
    (sentence,) = for_unreal(given)[1]
    assert sentence.endswith("1 of 1 hairs were resampled, and are up to 10 mm away from where they were")


def test_more_than_a_group_takes_is_reported(monkeypatch):
    monkeypatch.setattr(limits, "CURVES", 1)
    monkeypatch.setattr(limits, "GROUP_POINTS", 50)
    given = scene((20, 20, 35))
    given.sets, given.bodies = given.sets[:1], []
    says = ["curves a group, and group 1 has 2: add --fraction", "points a group, and group 1 has 55: add --fraction"]
    assert [sentence.split("most ")[1].split(" ", 1)[1] for sentence in for_unreal(given)[1]] == says


def test_the_same_hair_makes_the_same_bytes(tmp_path):
    write(tmp_path / "a.abc")
    first = (tmp_path / "a.abc").read_bytes()
    time.sleep(1.1)  # the library writes its date to the second
    write(tmp_path / "a.abc")
    assert (tmp_path / "a.abc").read_bytes() == first


def test_guides_that_hairs_do_not_name_are_not_made_up(tmp_path):
    given = scene()
    given.sets[0].curves.curve["guide_curve_index"] = np.array([1, 0, 2], np.int32)  # there are two
    write(tmp_path / "a.abc", given)
    archive, _, found = opened(tmp_path / "a.abc")
    parameters = found["hairsShape"].getArbGeomParams()
    names = {parameters.getPropertyHeader(k).getName() for k in range(parameters.getNumProperties())}
    assert "groom_guide" in names and not {"groom_closest_guides", "groom_guide_weights"} & names
    del archive


def test_the_command_writes_a_groom_for_unreal(tmp_path):
    write_scene(scene(), tmp_path / "a.usda", SPACE)
    done = convert(tmp_path / "a.usda", tmp_path / "a.abc", unreal=True, fraction=0.67)
    assert (done["hairs"], done["guides"], done["bodies"], done["frames"]) == (2, 2, 0, 3)
    printed = run("convert", tmp_path / "a.usda", tmp_path / "b.abc", "--unreal").stdout
    assert "lost: Unreal simulates guides of at most 32 points" in printed
    opened(tmp_path / "b.abc")
    with open_scene(tmp_path / "b.abc", SPACE) as back:
        assert "guide_curve_index" in back.sets[0].curves.curve
    refused(run("convert", tmp_path / "a.usda", tmp_path / "b.usdc", "--unreal"), "must end in .abc")
    said = " ".join(convert(tmp_path / "a.usda", tmp_path / "c.abc")["lost"])
    assert "Unreal takes at most 255 points of a curve, and there are 300: add --unreal" in said
