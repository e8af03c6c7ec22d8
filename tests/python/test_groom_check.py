"""Checking and repairing a groom: what goes through the skin or through other hair is counted, and moved."""

import json

import numpy as np
import pytest
from ringlet.cli.app import app
from ringlet.data.groom import Groom
from shapes import ball
from small_example import write_example
from typer.testing import CliRunner

import ringlet
from ringlet import Curves, Mesh, UserError, _core
from ringlet.groom import Allowed, check_groom, fix_groom, make_groom, parse_recipe

RADIUS = 0.09


def groom_of(lines, mesh=None):
    """A groom on the ball with these locks."""
    mesh = mesh or ball(RADIUS, 32)
    locks = Curves.from_list([np.asarray(line, float) for line in lines])
    triangle, barycentric, _ = _core.bind_roots(mesh.points, mesh.triangles, np.ascontiguousarray(locks.roots))
    locks.curve |= {"root_triangle": triangle, "root_barycentric": barycentric}
    return Groom(guides=locks, locks=locks, scalp=mesh, region="scalp")


def up(count=41, height=0.05, x=0.0, z=0.0):
    root = np.array([x, np.sqrt(RADIUS**2 - x * x - z * z), z])
    return root + np.linspace(0, height, count)[:, None] * [0, 1, 0]


def dipping(depth=0.002):
    """A lock that leaves the top of the ball and dips under its side."""
    angle = np.linspace(0, 0.9, 60)
    radius = RADIUS + 0.004 * np.sin(np.pi * angle / 0.45)
    radius[30:] = RADIUS - depth * np.sin(np.pi * (angle[30:] - angle[30]) / (0.9 - angle[30]))
    return np.stack([radius * np.sin(angle), radius * np.cos(angle), 0 * angle], axis=1)


def test_inside_is_inside_also_where_the_mesh_has_a_sharp_edge():
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = np.array([t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))], np.int32)
    places = np.random.default_rng(1).uniform(-0.5, 1.5, (4000, 3))
    height, foot, _, _ = _core.Solid(corners, triangles).above(places)
    truly = ((places > 0) & (places < 1)).all(axis=1)
    np.testing.assert_array_equal(height < 0, truly)
    np.testing.assert_allclose(np.abs(height), np.linalg.norm(places - foot, axis=1), atol=1e-12)
    open_box = _core.Solid(corners, np.ascontiguousarray(triangles[2:]))  # without a side
    beyond = places[:, 0] < -0.05
    assert not (open_box.above(places[beyond])[0] < 0).any()


def test_a_lock_that_dips_under_the_skin_is_found_with_its_depth_and_place():
    told = check_groom(groom_of([up(x=0.03), dipping()])).told()
    assert told["scalp"]["locks"] == 1 and told["body"]["places"] == 0
    assert told["scalp"]["depth"] == pytest.approx(0.002, abs=2e-4)
    worst = told["scalp"]["worst"][0]
    assert worst["lock"] == 1 and 40 <= worst["point"] <= 50
    assert np.linalg.norm(worst["place"]) == pytest.approx(RADIUS - worst["depth"], abs=2e-4)


def test_an_edge_that_goes_through_between_its_points_is_found():
    chord = np.array([[0, RADIUS, 0], [0, RADIUS + 0.01, 0], [0.0505, 0.0805, 0], [0.09, 0.03, 0], [0.1, 0.02, 0]])
    height = _core.Solid(ball(RADIUS, 32).points, ball(RADIUS, 32).triangles).above(chord[1:])[0]
    assert (height > 0).all()  # every point is outside
    assert check_groom(groom_of([chord])).told()["scalp"]["places"] > 0


def test_roots_may_be_in_the_skin_as_deep_as_is_allowed():
    sunk = up(401) - np.array([0, 4e-4, 0])
    assert len(check_groom(groom_of([sunk]))) == 0
    told = check_groom(groom_of([sunk]), allowed=Allowed(root_depth=1e-4)).told()
    assert told["scalp"]["depth"] == pytest.approx(2e-4, abs=1e-4)  # beside the root, which is not looked at


def test_locks_nearer_than_their_thickness_are_found_and_their_own_neighbours_are_not():
    crossing = up() + np.linspace(-0.01, 0.01, 41)[:, None] * [0, 0, 1] + [3e-5, 0, 0]
    findings = check_groom(groom_of([up(), crossing, up(x=0.03)]))
    told = findings.told()["hair"]
    assert told["places"] >= 1 and told["locks"] == 2
    assert told["depth"] == pytest.approx(1e-4 - 3e-5, abs=1e-6)
    assert {told["worst"][0]["lock"], told["worst"][0]["other"]} == {0, 1}
    assert len(check_groom(groom_of([up(), up(x=0.03)]))) == 0
    loop = np.linspace(0, 4 * np.pi, 200)[:, None]
    own = up()[0] + np.concatenate([0.004 * (np.cos(loop) - 1), 2e-6 * loop, 0.004 * np.sin(loop)], axis=1)
    assert check_groom(groom_of([own])).told()["hair"]["places"] > 0  # a lock that goes through itself


def test_others_beside_the_scalp_are_bodies():
    box = ball(0.01, 8)
    box = Mesh("box", box.points + [0.0, RADIUS + 0.03, 0.0], box.triangles)
    told = check_groom(groom_of([up()]), [box]).told()
    assert told["scalp"]["places"] == 0 and told["body"]["depth"] == pytest.approx(0.01, rel=0.05)


@pytest.mark.parametrize("kind", ["scalp", "hair", "both"])
def test_the_repair_leaves_nothing_and_moves_no_more_than_it_must(kind):
    straight = up(x=-0.01, z=-0.04)
    crossed = [straight, straight + np.linspace(-0.01, 0.01, 41)[:, None] * [0, 0, 1] + [3e-5, 0, 0]]
    lines = {"scalp": [dipping()], "hair": crossed, "both": [*crossed, dipping()]}[kind]
    made = groom_of([*lines, up(x=-0.03)])
    before = check_groom(made)
    assert len(before) > 0
    repair = fix_groom(made)
    assert len(repair.left) == 0
    assert len(check_groom(repair.groom)) == 0  # as an independent look finds
    np.testing.assert_array_equal(repair.groom.locks.roots, made.locks.roots)
    assert repair.moved.max() < (6e-4 if kind == "hair" else 3.5e-3)
    assert not repair.moved[made.locks.offsets[-2] :].any()  # a lock that was in nothing stays
    np.testing.assert_allclose(repair.groom.locks.lengths(), made.locks.lengths(), rtol=0.05)


@pytest.mark.parametrize("dragged", ["width", "margin"])
def test_locks_that_are_led_around_the_head_do_not_pop_while_a_value_is_dragged(dragged):
    recipe = (
        "ringlet = 1\n[scalp]\nregion = 'scalp'\n[guides]\ncount = 20\nlength = 6\nlift = 0.15\ndroop = 0.6\n"
        "[locks]\npoints = 160\n[curl]\nwidth = {width}\npitch = 1\n[clean]\nmargin = {margin}\n"
    )

    def at(value):
        text = recipe.format(**{"width": 0.6, "margin": 0.2, dragged: repr(float(value))})
        return make_groom(parse_recipe(text), ball(RADIUS, 32)).locks.points

    def worst_move(step):  # [m] for a step in centimetres
        return max(np.linalg.norm(at(v + step) - at(v), axis=1).max() for v in np.linspace(0.1, 0.9, 8))

    coarse, fine = worst_move(1e-3), worst_move(1e-5)
    assert coarse < 1e-4 and fine < 1e-6  # at most ten times as far as the value: no jump, however small the step


def test_what_cannot_be_repaired_is_told():
    one = up()
    repair = fix_groom(groom_of([one, one.copy(), one.copy()]), allowed=Allowed(thickness=0.02))
    assert len(repair.left) > 0 and repair.told()["rounds"] > 1
    assert sum(of["places"] for of in repair.left.told().values()) == len(repair.left)


def test_the_command_checks_repairs_and_pictures(tmp_path):
    folder = write_example(tmp_path)
    recipe = folder / "small.recipe.toml"
    lying = (
        recipe.read_text()
        .replace("length = 5", "length = 9\nlift = 0\ndroop = 3")
        .replace("points = 40", "points = 99")
    )
    recipe.write_text(lying + "[clean]\nmargin = 0\n")
    ringlet.write_groom(ringlet.build_groom(recipe), tmp_path / "groom.usdc")
    sunk = ringlet.read_groom(tmp_path / "groom.usdc")
    sunk.locks.points = sunk.locks.points - [0.0, 0.001, 0.0]
    ringlet.write_groom(sunk, tmp_path / "sunk.usdc")

    def run(*args):
        done = CliRunner().invoke(app, ["check", *map(str, args), "--json"])
        return done.exit_code, json.loads(done.stdout) if done.exit_code < 2 else done.stderr

    code, told = run(tmp_path / "sunk.usdc", "--picture", tmp_path / "check.png")
    assert code == 1 and sum(of["places"] for of in told["found"].values()) > 0
    assert (tmp_path / "check.png").read_bytes()[:4] == b"\x89PNG"
    code, told = run(tmp_path / "sunk.usdc", "--fix", "-o", tmp_path / "fixed.usdc", "--root-depth", 2)
    assert code == 0 and told["repair"]["locks_moved"] > 0
    assert run(tmp_path / "fixed.usdc", "--root-depth", 2)[0] == 0
    assert run(tmp_path / "sunk.usdc", "--fix")[0] == 2
    with pytest.raises(UserError, match=r"check: thickness is -1 m; must be at least 0"):
        ringlet.check_groom(tmp_path / "groom.usdc", thickness=-1.0)
