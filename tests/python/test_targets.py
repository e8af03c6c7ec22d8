"""Locks end at a plane, a mesh or a drawn line: cut there, or grown up to it."""

import numpy as np
import pytest
from ringlet.data.groom import SECTION
from ringlet.groom.scalp import Scalp
from shapes import ball
from small_example import write_example

from ringlet import UserError, _core, build_groom
from ringlet.groom import Memory, make_groom, parse_recipe

ROUND = "[meshes.round]\nmiddle = [0, 3, 0]\nwidth = 32\nheight = 30\ndepth = 34\n"
BOB = "[curves.bob]\npoints = [[-20, -4, 0], [20, -10, 0]]\n"
SIDES = "mask = { where = 'y < 6' }\n"  # hair that hangs down


def groom(shape, top="", guides="length = 10\nlift = 0.3\ngravity_bend = 4", locks="count = 120\npoints = 24", more=""):
    text = f"ringlet = 2\n[scalp]\nregion = 'scalp'\n{top}[guides]\ncount = 30\n{guides}\n[locks]\n{locks}\n"
    return make_groom(parse_recipe(f"{text}[[shape]]\n{shape}\n{more}\n[collide]\nmargin = 0\n"), ball())


def tips(made):
    return made.locks.points.reshape(len(made.locks), -1, 3)[:, -1]


def test_tips_of_a_bob_lie_on_a_drawn_line_within_its_softness():
    plain = groom("op = 'bend'\nangle = 0", BOB)
    made = groom(f"op = 'grow_to'\nline = 'bob'\nspread = '2 mm'\n{SIDES}", BOB)
    changed = np.abs(tips(made) - tips(plain)).max(axis=1) > 1e-9
    ends = tips(made)[changed]
    off = ends[:, 1] - (-0.07 - 0.15 * ends[:, 0])
    longer = made.locks.lengths()[changed] - plain.locks.lengths()[changed]
    assert changed.sum() > 50 and (longer > 0.005).sum() > 20
    assert np.abs(off).max() < 2e-3 + 5e-4 and np.ptp(off) > 2e-3


def test_the_envelope_of_an_afro_follows_a_mesh():
    guides = "length = { value = 6, vary = 0.5 }\nlift = 1\ngravity_bend = 0"
    shape = "op = 'grow_to'\nmesh = 'round'\nspread = '1 mm'"
    solid = ellipsoid()

    def off(made):
        return np.abs(np.asarray(solid.above(np.ascontiguousarray(tips(made)))[0]))

    assert np.median(off(groom("op = 'bend'\nangle = 0", guides=guides))) > 0.01
    assert off(groom(shape, ROUND, guides)).max() < 1.05e-3
    curled = groom(shape, ROUND, guides, "count = 120\npoints = 200", "[curl]\npreset = '4A'")
    assert off(curled).max() < 6e-3  # a radius of the curl more


def ellipsoid():
    mesh = parse_recipe(f"ringlet = 2\n{ROUND}").meshes["round"].inline_mesh("round")
    a, b, c = (mesh.points[mesh.triangles[:, k]] for k in range(3))
    volume = np.sum(a * np.cross(b, c)) / 6.0
    assert volume == pytest.approx(np.pi / 6.0 * 0.32 * 0.30 * 0.34, rel=0.01)  # closed, faces outwards
    return _core.Solid(mesh.points, mesh.triangles)


def test_a_cut_takes_a_mesh_or_a_line_too_and_never_lengthens():
    plain = groom("op = 'bend'\nangle = 0", guides="length = 14\nlift = 1\ngravity_bend = 0")
    cut = groom("op = 'cut'\nmesh = 'round'\nspread = 0\nat = -2", ROUND, "length = 14\nlift = 1\ngravity_bend = 0")
    above = np.asarray(ellipsoid().above(np.ascontiguousarray(tips(cut)))[0])
    shorter = cut.locks.lengths() < plain.locks.lengths() - 1e-6
    assert shorter.sum() > 50 and (cut.locks.lengths() <= plain.locks.lengths() + 1e-9).all()
    np.testing.assert_allclose(above[shorter], -0.02, atol=2e-5)


def test_locks_that_cannot_reach_the_target_stay():
    plain = groom("op = 'bend'\nangle = 0")
    made = groom("op = 'grow_to'\nat = 60\nmost = 20")
    np.testing.assert_allclose(plain.locks.points, made.locks.points, atol=1e-12)


def test_tips_of_a_section_scatter_together():
    sections = "points = 24\n[locks.sections]\nsize = 4\nstrands = 3"
    middle = Scalp(ball(), "scalp").middle

    def offsets(each):
        made = groom(f"op = 'grow_to'\nspread = 1\neach = '{each}'\nat = 8\n{SIDES}", locks=sections)
        depth = middle[1] - tips(made)[:, 1]
        grown = (np.abs(depth - 0.08) < 0.0101) & (made.locks.roots[:, 1] < 0.06)  # the mask goes by strands
        section, depth = made.locks.curve[SECTION][grown], depth[grown]
        return np.array([np.ptp(depth[section == one]) for one in np.unique(section)]), np.ptp(depth)

    together, all_of_them = offsets("section")
    assert len(together) > 5 and together.max() < 1e-9 and all_of_them > 0.01
    assert np.median(offsets("lock")[0]) > 0.003


def test_a_mesh_is_read_from_a_file_and_read_again_when_it_changes(tmp_path):
    recipe = write_example(tmp_path) / "small.recipe.toml"
    memory = Memory()
    text = recipe.read_text().replace("points = 40", "points = 200")
    text = text.replace("[curl]", "[[shape]]\nop = 'grow_to'\nmesh = 'box'\nspread = 0\n[curl]", 1)
    recipe.write_text(text + "[meshes.box]\nfile = 'box.obj'\nunit = 'cm'\n")
    corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    faces = ["1 2 4 3", "5 7 8 6", "1 5 6 2", "3 4 8 7", "1 3 7 5", "2 6 8 4"]
    for half in (18, 20):
        lines = [f"v {half * x} {half * y} {half * z}" for x, y, z in corners] + [f"f {face}" for face in faces]
        (tmp_path / "box.obj").write_text("\n".join(lines) + "\n")
        shapes = build_groom(recipe, memory=memory).shapes
        ends = shapes.points.reshape(len(shapes), -1, 3)[:, -1]
        np.testing.assert_allclose(np.abs(ends).max(axis=1), 0.01 * half, atol=1e-6)
    (tmp_path / "variants").mkdir()
    variant = tmp_path / "variants" / "other.recipe.toml"
    variant.write_text('ringlet = 2\nextends = "../small.recipe.toml"\n')
    assert np.array_equal(build_groom(variant).shapes.points, shapes.points)


@pytest.mark.parametrize(
    ("top", "settings", "message"),
    [
        ("", "mesh = 'round'", "grow_to.mesh is 'round', which is no helper mesh; add a table [meshes.round]"),
        (ROUND, "mesh = 'rond'", "grow_to.mesh is 'rond', which is no helper mesh; did you mean 'round'"),
        (ROUND + BOB, "mesh = 'round'\nline = 'bob'", "has a line and also a mesh; give one of them"),
        ("[meshes.a]\nwidth = 3\n", "", "needs either a 'file' or the 'middle' of an ellipsoid; give one of them"),
    ],
)
def test_a_target_that_is_not_there_is_refused(top, settings, message):
    with pytest.raises(UserError) as refused:
        groom(f"op = 'grow_to'\n{settings}", top)
    assert message in str(refused.value)
