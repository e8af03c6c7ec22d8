"""Checking and repairing a groom: intersections with skin and hair are counted and removed."""

import json

import numpy as np
import pytest
from ringlet.cli.app import app
from ringlet.data.groom import STRAND_PROFILE, STRAND_RADIUS, Groom
from ringlet.groom.pins import PIN
from ringlet.groom.scalp import Scalp
from shapes import ball, sheet
from small_example import write_example
from typer.testing import CliRunner

import ringlet
from ringlet import Curves, Mesh, UserError, _core
from ringlet.groom import Allowed, check_groom, fix_groom, make_groom, parse_recipe

RADIUS = 0.09


def groom_of(lines, mesh=None):
    """A groom of the given locks on the ball."""
    mesh = mesh or ball(RADIUS, 32)
    locks = Curves.from_list([np.asarray(line, float) for line in lines])
    triangle, barycentric, _ = _core.bind_roots(mesh.points, mesh.triangles, np.ascontiguousarray(locks.roots))
    locks.curve |= {"root_triangle": triangle, "root_barycentric": barycentric}
    return Groom(guides=locks, locks=locks, scalp=mesh, region="scalp")


def up(count=41, height=0.05, x=0.0, z=0.0):
    root = np.array([x, np.sqrt(RADIUS**2 - x * x - z * z), z])
    return root + np.linspace(0, height, count)[:, None] * [0, 1, 0]


def dipping(depth=0.002):
    """A lock from the top of the ball that enters its side to a depth [m]."""
    angle = np.linspace(0, 0.9, 60)
    radius = RADIUS + 0.004 * np.sin(np.pi * angle / 0.45)
    radius[30:] = RADIUS - depth * np.sin(np.pi * (angle[30:] - angle[30]) / (0.9 - angle[30]))
    return np.stack([radius * np.sin(angle), radius * np.cos(angle), 0 * angle], axis=1)


def test_inside_and_outside_are_correct_at_sharp_edges():
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = np.array([t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))], np.int32)
    points = np.random.default_rng(1).uniform(-0.5, 1.5, (4000, 3))
    height, foot, _, _ = _core.Solid(corners, triangles).above(points)
    truly = ((points > 0) & (points < 1)).all(axis=1)
    np.testing.assert_array_equal(height < 0, truly)
    np.testing.assert_allclose(np.abs(height), np.linalg.norm(points - foot, axis=1), atol=1e-12)
    open_box = _core.Solid(corners, np.ascontiguousarray(triangles[2:]))  # one side is missing
    beyond = points[:, 0] < -0.05
    assert not (open_box.above(points[beyond])[0] < 0).any()


def test_a_lock_below_the_skin_is_reported_with_depth_and_position():
    found = check_groom(groom_of([up(x=0.03), dipping()])).summary()
    assert found["scalp"]["locks"] == 1 and found["body"]["places"] == 0
    assert found["scalp"]["depth"] == pytest.approx(0.002, abs=2e-4)
    worst = found["scalp"]["worst"][0]
    assert worst["lock"] == 1 and 40 <= worst["point"] <= 50
    assert np.linalg.norm(worst["place"]) == pytest.approx(RADIUS - worst["depth"], abs=2e-4)


def test_an_edge_that_intersects_between_its_points_is_found():
    chord = np.array([[0, RADIUS, 0], [0, RADIUS + 0.01, 0], [0.0505, 0.0805, 0], [0.09, 0.03, 0], [0.1, 0.02, 0]])
    height = _core.Solid(ball(RADIUS, 32).points, ball(RADIUS, 32).triangles).above(chord[1:])[0]
    assert (height > 0).all()  # all points are outside
    assert check_groom(groom_of([chord])).summary()["scalp"]["places"] > 0


def test_roots_may_be_below_the_skin_to_the_allowed_depth():
    sunk = up(401) - np.array([0, 4e-4, 0])
    assert len(check_groom(groom_of([sunk]))) == 0
    found = check_groom(groom_of([sunk]), allowed=Allowed(root_depth=1e-4)).summary()
    assert found["scalp"]["depth"] == pytest.approx(2e-4, abs=1e-4)  # next to the root, which is excluded


def test_locks_with_a_radius_of_their_own_count_at_it():
    groom = groom_of([up(), up(x=0.004), up(x=0.009), up(x=0.0095)])
    assert len(check_groom(groom)) == 0
    groom.locks.curve[STRAND_RADIUS] = np.array([0.003, 0.003, 0.0, 0.0], np.float32)  # two locs, two hairs
    found = check_groom(groom).summary()["hair"]
    assert found["locks"] == 2 and found["depth"] == pytest.approx(2 * 0.85 * 0.003 - 0.004, rel=0.02)
    assert check_groom(groom, allowed=Allowed(own_radius=0.6)).summary()["hair"]["places"] == 0
    thin = Allowed(thickness=1e-3)  # hairs half a millimetre apart count too, and are not counted twice
    assert check_groom(groom, allowed=thin).summary()["hair"]["locks"] == 4
    groom.locks.curve[STRAND_PROFILE] = np.array([[1, 0.1, 0.1]] * 4, np.float32)
    places = [row["place"][1] for row in check_groom(groom).summary()["hair"]["worst"]]
    assert places and max(places) < RADIUS + 0.02  # near the roots, where they are thick
    groom.locks.point[PIN] = np.ones(len(groom.locks.points), np.float32)
    assert len(check_groom(groom)) == 0


def test_single_hairs_beside_a_loc_are_only_paired_where_they_touch():
    hairs = [up(11, 0.01, x, z) for x in np.arange(-8, 9) * 1e-3 for z in np.arange(-8, 9) * 1e-3]
    groom = groom_of([up(11, 0.01), *hairs])
    groom.locks.curve[STRAND_RADIUS] = np.array([0.003] + [0.0] * len(hairs), np.float32)
    radius = np.repeat(0.85 * groom.locks.curve[STRAND_RADIUS].astype(float) + 5e-5, groom.locks.counts)
    pair = _core.crossings(groom.locks.points, groom.locks.offsets, radius)[0]
    assert (pair.min(axis=1) < 11).all() and len(pair) < 11 * 11 * 9 * np.pi  # each with the loc
    assert check_groom(groom).summary()["hair"]["locks"] == 1 + 21  # those within 2.6 mm of its middle


def test_the_command_says_how_thick_locks_with_a_radius_of_their_own_are(tmp_path):
    groom = groom_of([up(), up(x=0.004)])
    bound = groom.locks.curve["root_triangle"], groom.locks.curve["root_barycentric"]
    off = Scalp(groom.scalp, None).positions(*bound) - groom.locks.roots  # the ball has facets
    groom.locks.points += np.repeat(off, groom.locks.counts, axis=0)
    groom.locks.curve[STRAND_RADIUS] = np.full(2, 0.003, np.float32)
    ringlet.write_groom(groom, tmp_path / "locs.usdc")
    result = CliRunner().invoke(app, ["check", str(tmp_path / "locs.usdc")])
    assert result.exit_code == 1, result.output
    assert "checked as up to 5.1 mm thick, others as lines of 0.1 mm" in result.output
    result = CliRunner().invoke(app, ["check", str(tmp_path / "locs.usdc"), "--own-radius", "0.5"])
    assert result.exit_code == 0, result.output


def test_locks_nearer_than_their_thickness_are_found():
    crossing = up() + np.linspace(-0.01, 0.01, 41)[:, None] * [0, 0, 1] + [3e-5, 0, 0]
    findings = check_groom(groom_of([up(), crossing, up(x=0.03)]))
    found = findings.summary()["hair"]
    assert found["places"] >= 1 and found["locks"] == 2
    assert found["depth"] == pytest.approx(1e-4 - 3e-5, abs=1e-6)
    assert {found["worst"][0]["lock"], found["worst"][0]["other"]} == {0, 1}
    assert len(check_groom(groom_of([up(), up(x=0.03)]))) == 0
    loop = np.linspace(0, 4 * np.pi, 200)[:, None]
    own = up()[0] + np.concatenate([0.004 * (np.cos(loop) - 1), 2e-6 * loop, 0.004 * np.sin(loop)], axis=1)
    assert check_groom(groom_of([own])).summary()["hair"]["places"] > 0  # a lock that intersects itself


def test_meshes_other_than_the_scalp_are_bodies():
    box = ball(0.01, 8)
    box = Mesh("box", box.points + [0.0, RADIUS + 0.03, 0.0], box.triangles)
    found = check_groom(groom_of([up()]), [box]).summary()
    assert found["scalp"]["places"] == 0 and found["body"]["depth"] == pytest.approx(0.01, rel=0.05)


@pytest.mark.parametrize("kind", ["scalp", "hair", "both"])
def test_repair_removes_every_intersection_with_bounded_displacements(kind):
    straight = up(x=-0.01, z=-0.04)
    crossed = [straight, straight + np.linspace(-0.01, 0.01, 41)[:, None] * [0, 0, 1] + [3e-5, 0, 0]]
    lines = {"scalp": [dipping()], "hair": crossed, "both": [*crossed, dipping()]}[kind]
    made = groom_of([*lines, up(x=-0.03)])
    before = check_groom(made)
    assert len(before) > 0
    repair = fix_groom(made)
    assert len(repair.left) == 0
    assert len(check_groom(repair.groom)) == 0  # a second check agrees
    np.testing.assert_array_equal(repair.groom.locks.roots, made.locks.roots)
    assert repair.moved.max() < (6e-4 if kind == "hair" else 3.5e-3)
    assert not repair.moved[made.locks.offsets[-2] :].any()  # a lock without intersections stays
    np.testing.assert_allclose(repair.groom.locks.lengths(), made.locks.lengths(), rtol=0.05)


@pytest.mark.parametrize("margin", [0.0, 0.2])
def test_locks_that_start_into_the_scalp_keep_their_lengths_and_are_reported(margin):
    text = "ringlet = 2\n[guides]\nfile = 'g.usda'\n[locks]\ncount = 30\npoints = 20\n[collide]\nmargin = {}\n"
    guides = Curves.from_list([[x, 0.0, 0.0] + 0.03 * np.linspace(0, 1, 9)[:, None] * [0, 1, 0] for x in (-0.02, 0.02)])
    inside_out = sheet()
    inside_out.triangles = inside_out.triangles[:, ::-1].copy()
    made = make_groom(parse_recipe(text.format(margin)), inside_out, drawn_guides=guides)
    edges = np.linalg.norm(np.diff(made.locks.points.reshape(30, 20, 3), axis=1), axis=2)
    assert edges.min() > 0.5 * 0.03 / 19
    np.testing.assert_allclose(made.locks.lengths(), 0.03, rtol=0.1)
    assert any("30 of 30 locks" in line and "reverse the orientation of sheet" in line for line in made.conflicts)
    outward = make_groom(parse_recipe(text.format(margin)), sheet(), drawn_guides=guides)
    assert not any("start into" in line for line in outward.conflicts)


@pytest.mark.parametrize("setting", ["width", "margin"])
def test_locks_guided_around_the_head_change_continuously(setting):
    recipe = (
        "ringlet = 2\n[scalp]\nregion = 'scalp'\n[guides]\ncount = 20\nlength = 6\nlift = 0.15\ngravity_bend = 0.6\n"
        "[locks]\npoints = 160\n[curl]\nwidth = {width}\npitch = 1\n[collide]\nmargin = {margin}\n"
    )

    def at(value):
        text = recipe.format(**{"width": 0.6, "margin": 0.2, setting: repr(float(value))})
        return make_groom(parse_recipe(text), ball(RADIUS, 32)).locks.points

    def worst_move(step):  # [m] for a step in [cm]
        return max(np.linalg.norm(at(v + step) - at(v), axis=1).max() for v in np.linspace(0.1, 0.9, 8))

    coarse, fine = worst_move(1e-3), worst_move(1e-5)
    assert coarse < 1e-4 and fine < 1e-6  # at most ten times the step: no jump at any step size


def test_intersections_beyond_repair_are_reported():
    one = up()
    repair = fix_groom(groom_of([one, one.copy(), one.copy()]), allowed=Allowed(thickness=0.02))
    assert len(repair.left) > 0 and repair.summary()["rounds"] > 1
    assert sum(of["places"] for of in repair.left.summary().values()) == len(repair.left)


def test_the_command_checks_repairs_and_draws(tmp_path):
    folder = write_example(tmp_path)
    recipe = folder / "small.recipe.toml"
    lying = (
        recipe.read_text()
        .replace("length = 5", "length = 9\nlift = 0\ngravity_bend = 3")
        .replace("points = 40", "points = 99")
    )
    recipe.write_text(lying + "[collide]\nmargin = 0\n")
    ringlet.write_groom(ringlet.build_groom(recipe), tmp_path / "groom.usdc")
    sunk = ringlet.read_groom(tmp_path / "groom.usdc")
    roots = sunk.locks.roots.copy()
    sunk.locks.points = sunk.locks.points - [0.0, 0.001, 0.0]
    sunk.locks.points[sunk.locks.offsets[:-1]] = roots
    ringlet.write_groom(sunk, tmp_path / "sunk.usdc")

    def run(*args):
        done = CliRunner().invoke(app, ["check", *map(str, args), "--json"])
        return done.exit_code, json.loads(done.stdout) if done.exit_code < 2 else done.stderr

    code, found = run(tmp_path / "sunk.usdc", "--picture", tmp_path / "check.png")
    assert code == 1 and sum(of["places"] for of in found["found"].values()) > 0
    assert (tmp_path / "check.png").read_bytes()[:4] == b"\x89PNG"
    code, found = run(tmp_path / "sunk.usdc", "--fix", "-o", tmp_path / "fixed.usdc", "--root-depth", 2)
    assert code == 0 and found["repair"]["locks_moved"] > 0
    assert run(tmp_path / "fixed.usdc", "--root-depth", 2)[0] == 0
    assert run(tmp_path / "sunk.usdc", "--fix")[0] == 2
    with pytest.raises(UserError, match=r"check: thickness is -1 m; must be at least 0"):
        ringlet.check_groom(tmp_path / "groom.usdc", thickness=-1.0)


def test_the_command_says_how_thick_locks_are_with_their_hairs(tmp_path):
    folder = write_example(tmp_path)
    recipe = folder / "small.recipe.toml"
    wide = "[hairs]\nlock_radius = { value = 0.2, ramp = [[0, 1], [1, 0.5]] }"
    recipe.write_text(recipe.read_text().replace("[hairs]", wide))
    assert ringlet.check_groom(recipe)["lock_thickness"] == pytest.approx(0.004)
    said = CliRunner().invoke(app, ["check", str(recipe)]).stdout
    assert "locks are 4 mm thick: --thickness 4 counts" in said
    assert "thick:" not in CliRunner().invoke(app, ["check", str(recipe), "--thickness", "4"]).stdout
