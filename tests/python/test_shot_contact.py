"""Contact in shots: colliders from USD, statistics, and initial penetration and overlap."""

import json

import numpy as np
import pytest
from commands import edit, refused, run
from floor_scene import CONTACT, POINTS, SHOT, ball, floor, groom, still
from pxr import Usd, UsdGeom, Vt
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.groom import Groom
from ringlet.data.mesh import Clip
from ringlet.deform.orientation import winding_numbers
from ringlet.shot import Collider, parse_shot
from ringlet.sim import Obstacle, simulate
from ringlet.sim.penetration import penetration_depths
from small_example import FRAMES, write_example

import ringlet
from ringlet import _core


def simulated(text=SHOT + CONTACT, made=None, obstacles=()):
    made = made or groom()
    return simulate(parse_shot(text), made, still(made.scalp), obstacles=obstacles)


def test_locks_fall_onto_the_scalp_without_intersections():
    through = simulated(SHOT, obstacles=[Obstacle(floor(), still(floor()))])
    cache = simulated(obstacles=[Obstacle(floor(), still(floor()))])
    free = np.tile(np.arange(POINTS) >= 3, 3)
    assert through.points[-1, free, 1].min() < -0.005
    assert cache.points[:, free, 1].min() > 0
    assert cache.points[-1, free, 1].max() < 0.01  # they fall


def test_a_thicker_collider_keeps_locks_farther_away():
    heights = []
    for thickness in (5e-4, 3e-3):
        obstacle = Obstacle(floor(), still(floor()), Collider(thickness=thickness))
        cache = simulated(SHOT.replace("12]", "40]") + CONTACT, obstacles=[obstacle])
        heights.append(cache.points[-1].reshape(3, POINTS, 3)[:, 10:, 1].mean())
    assert heights[1] > heights[0] + 1e-3


def test_an_animated_collider_pushes_locks_and_a_static_one_does_not():
    hand = ball(0.012, (0.015, 0.014, 0.015), "hand")  # next to lock 11
    frames = np.arange(1.0, 13.0)
    sweep = Clip(frames, np.array([hand.points + [0, 0, -0.005 * (f - 1)] for f in frames]), 24.0)
    tips = {}
    for animated in (True, False):
        cache = simulated(
            SHOT + "[forces]\ngravity = [0, 0, 0]\n" + CONTACT,
            made=groom(apart=-0.03),
            obstacles=[Obstacle(hand, sweep, Collider(animated=animated))],
        )
        tips[animated] = cache.points[:, :POINTS].astype(float)
    assert (tips[True] - tips[True][0])[:, :, 2].min() < -0.02
    assert np.abs(tips[False] - tips[False][0]).max() < 1e-6


def test_every_frame_has_contact_statistics():
    cache = simulated(obstacles=[Obstacle(floor(), still(floor()))])
    contacts = [frame["contact"] for frame in cache.statistics[1:]]
    assert max(frame["contacts"] for frame in contacts) > 0
    for frame in contacts:
        assert frame["candidates"] >= frame["contacts"]
        assert frame["lag"] == 0.0 and frame["excused"] == 0
        assert frame["contacts"] == 0 or 0 < frame["closest"] < 1.5e-3
        assert all(frame[f"{phase}_ms"] >= 0 for phase in ("pairs", "assemble", "solve", "search", "filter"))


def test_a_ball_that_presses_a_lock_to_the_floor_is_reported_with_the_lock(tmp_path):
    """In the statistics, and in the cache as a primvar of each lock; without it there is neither."""
    press, frames = ball(0.012, (0.015, 0.04, 0.0), "press"), np.arange(1.0, 13.0)  # above lock 11
    sink = Clip(frames, np.array([press.points + [0, -0.004 * (f - 1), 0] for f in frames]), 24.0)
    made, obstacles = groom(apart=0.03), [Obstacle(floor(), still(floor())), Obstacle(press, sink)]
    cache = simulated(made=made, obstacles=obstacles)
    lagging = [frame["contact"].get("lagging", []) for frame in cache.statistics[1:]]
    assert lagging[0] == []
    (found,) = lagging[-1]
    assert found["what"] == "press" and found["locks"] == [11]
    assert found["distance"] == cache.statistics[-1]["contact"]["lag"] > 5e-3

    ringlet.write_groom(made, tmp_path / "groom.usdc")
    ringlet.write_cache(cache, tmp_path / "groom.usdc", tmp_path / "cache.usdc")
    stage = Usd.Stage.Open(str(tmp_path / "cache.usdc"))
    lag = UsdGeom.PrimvarsAPI(stage.GetPrimAtPath("/groom/locks")).GetPrimvar("ringlet:lag")
    assert lag.GetInterpolation() == "uniform"
    assert list(lag.Get(12.0)) == [np.float32(found["distance"]), 0.0, 0.0]
    assert list(lag.Get(2.0)) == [0.0, 0.0, 0.0]


def test_initial_penetration_is_reported_and_recovers():
    tip = groom().locks.points[POINTS - 1]  # tip of lock 11
    sphere = ball(0.004, tip + [0, 0, 0.001])
    shot = SHOT.replace("12]", "30]") + "[forces]\ngravity = [0, 0, 0]\n" + CONTACT
    cache = simulated(shot, obstacles=[Obstacle(sphere, still(sphere))])
    (found,) = cache.start["inside"]
    assert found["mesh"] == "ball" and found["locks"] == 1
    assert found["vertices"] == 2  # vertices are 2 mm apart; the strand leaves the sphere after 3.9 mm
    assert found["worst"][0]["lock"] == 11 and found["worst"][0]["vertex"] == POINTS - 1
    assert 0.0025 < found["depth"] <= 0.003
    penetrating = [frame["contact"]["excused"] for frame in cache.statistics[1:]]
    assert penetrating[0] == 2 and penetrating[-1] == 0
    assert not penetration_depths(cache.points[-1], sphere.triangles, sphere.points).any()


@pytest.mark.parametrize("separation_speed", [2e-3, 0.0])
def test_initial_overlaps_of_locks_are_reported(separation_speed):
    touching = CONTACT + f"separation_speed = {separation_speed}\n"
    cache = simulated(SHOT + "[forces]\ngravity = [0, 0, 0]\n" + touching, made=groom(apart=5e-4))
    found = cache.start["overlapping"]
    assert found["locks"] == 3 and found["places"] >= 2 * (POINTS - 4)
    assert np.isclose(found["depth"], 1.5e-3, atol=1e-5)
    marks = np.array(cache.start["marks"])  # all overlaps, relative to the worst
    assert marks.shape == (found["places"], 4) and marks[:, 3].max() == 1.0
    assert np.abs(marks[:, None, :3] - groom(apart=5e-4).locks.points).max(axis=2).min(axis=1).max() < 1e-4
    assert {found["worst"][0]["lock"], found["worst"][0]["other"]} in ({11, 12}, {12, 13})


def test_initial_overlaps_of_locks_separate():
    """From 0.5 mm; the activation distance grows by 2 mm a second, 1 mm in this shot.

    Parallel strands have no distinct contact points, so that the separation of a pair depends on rounding
    (docs/contact.md): the test takes the median of five initial distances.
    """
    text = SHOT + "[forces]\ngravity = [0, 0, 0]\n" + CONTACT
    apart = []
    for start in (4.8e-4, 4.9e-4, 5e-4, 5.1e-4, 5.2e-4):
        tips = simulated(text, made=groom(apart=start)).points[-1].reshape(3, POINTS, 3)[:, -1]
        apart.append(np.linalg.norm(np.diff(tips, axis=0), axis=1).mean())
    assert np.median(apart) > 6e-4


def test_penetration_depth_needs_a_closed_mesh():
    mesh = ball(0.01)
    points = np.array([[0.0, 0.004, 0], [0, 0.02, 0], [0, -0.0095, 0]])
    depth = penetration_depths(points, mesh.triangles, mesh.points)
    assert 0.005 < depth[0] < 0.0061 and depth[1] == 0 and 0 < depth[2] < 6e-4
    sheet = floor()
    assert not penetration_depths(points - [0, 0.005, 0], sheet.triangles, sheet.points).any()
    numbers = winding_numbers(points, mesh.points[mesh.triangles])
    assert np.allclose(numbers, [1, 0, 1], atol=1e-9)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[contact]\nfricton = 1\n", ["contact.fricton", "'friction'?"]),
        ("[contact]\nradius = 0\n", ["contact.radius", "0", "more than 0"]),
        ("[contact]\n[[collider]]\nthicknes = 1\n", ["collider[0].thicknes", "'thickness'?"]),
        ("[contact]\n[[collider]]\nfriction = -1\n", ["collider[0].friction", "-1", "at least 0"]),
        ("[[collider]]\nfriction = 1\n", ["collider", "[contact]"]),
    ],
)
def test_invalid_contact_settings_are_refused_in_one_line(text, words):
    with pytest.raises(UserError) as caught:
        parse_shot(SHOT + text)
    assert "\n" not in str(caught.value)
    for word in words:
        assert word in str(caught.value)


def test_a_degenerate_collider_is_refused_with_the_frame():
    mesh = floor()
    clip = Clip(np.array([1.0, 4.0]), np.array([mesh.points, mesh.points * [1, 1, 0]]), 24.0)
    with pytest.raises(UserError, match=r"floor: at frame 4 triangle 0 has no area .*\(2 of 2\)"):
        simulated(obstacles=[Obstacle(mesh, clip)])


def test_a_collider_with_a_varying_point_count_is_refused():
    clip = Clip(np.array([1.0]), np.zeros((1, 5, 3)), 24.0)
    with pytest.raises(UserError, match="floor: has 5 points at frame 1, 4 in its rest pose"):
        simulated(obstacles=[Obstacle(floor(), clip)])


@pytest.fixture(scope="module")
def example(tmp_path_factory):
    """The small example in contact, with its groom."""
    folder = write_example(tmp_path_factory.mktemp("contact"))
    shot = folder / "small.shot.toml"
    shot.write_text(shot.read_text() + CONTACT)
    assert run("groom", folder / "small.recipe.toml", "-o", folder / "groom.usdc").exit_code == 0
    return folder


def sim(folder, *more):
    return run("sim", folder / "small.shot.toml", "--groom", folder / "groom.usdc", "-o", folder / "cache.usdc", *more)


def test_the_head_is_a_collider_by_default_and_the_report_includes_contact(example):
    result = sim(example, "--json", "--report", example / "report")
    assert result.exit_code == 0, result.output
    output = json.loads(result.stdout)
    assert output["frames"] == FRAMES and set(output["start"]) == {"inside", "piercing", "overlapping"}
    assert ringlet.read_cache(example / "cache.usdc").start == {**output["start"], "marks": []}
    statistics = json.loads((example / "report/report.json").read_text())["statistics"]
    assert all(frame["contact"]["candidates"] > 0 for frame in statistics[1:])
    html = (example / "report/report.html").read_text()
    for text in ("How it started", "Pairs that were kept from meeting", "Held back", "single hairs do not"):
        assert text in html


def with_box(example, tmp_path, change):
    """The shot of the example with a further collider, a tetrahedron that ``change`` modifies."""
    stage = Usd.Stage.CreateNew(str(tmp_path / "props.usda"))
    stage.SetStartTimeCode(1)
    stage.SetEndTimeCode(FRAMES)
    mesh = UsdGeom.Mesh.Define(stage, "/props/box")
    mesh.CreateSubdivisionSchemeAttr("none")
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], np.float32) + [0, 30, 0]
    mesh.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(points.astype(np.float32)))
    mesh.CreateFaceVertexCountsAttr([3, 3, 3, 3])
    mesh.CreateFaceVertexIndicesAttr([0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3])
    change(mesh)
    stage.Save()
    shot = tmp_path / "props.shot.toml"
    shot.write_text((example / "small.shot.toml").read_text() + f'[[collider]]\nfile = "{tmp_path}/props.usda"\n')
    return shot


def test_a_collider_is_read_from_another_file(example, tmp_path):
    locks = ringlet.read_groom(example / "groom.usdc").locks
    tip = 100 * locks.points[locks.offsets[1] - 1]
    around = np.float32(tip + [[-2, -2, -2], [6, -2, -2], [-2, 6, -2], [-2, -2, 6]])
    shot = with_box(example, tmp_path, lambda mesh: mesh.GetPointsAttr().Set(Vt.Vec3fArray.FromNumpy(around)))
    result = run("sim", shot, "--groom", example / "groom.usdc", "-o", tmp_path / "cache.usdc", "--json")
    (found,) = json.loads(result.stdout)["start"]["inside"]
    assert found["mesh"] == "props.usda /props/box" and locks.ids[0] in [worst["lock"] for worst in found["worst"]]


def lose_points(mesh):
    mesh.GetPointsAttr().Set(Vt.Vec3fArray([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]), 1)
    mesh.GetPointsAttr().Set(Vt.Vec3fArray([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1)]), 2)


def lose_a_number(mesh):
    mesh.GetPointsAttr().Set(Vt.Vec3fArray([(0, 0, float("nan")), (1, 0, 0), (0, 1, 0), (0, 0, 1)]))


def lose_area(mesh):
    mesh.GetPointsAttr().Set(Vt.Vec3fArray([(0, 0, 0), (1, 0, 0), (2, 0, 0), (0, 0, 1)]))


@pytest.mark.parametrize(
    ("change", "more", "words"),
    [
        (lambda mesh: None, 'mesh = "/props/bos"\n', ["/props/bos", "did you mean /props/box?"]),
        (lambda mesh: None, 'mesh = "props"\n', ["props"]),
        (lambda mesh: mesh.GetPrim().SetTypeName("Xform"), 'mesh = "/props"\n', ["no Mesh", "/props"]),
        (lose_points, "", ["/props/box", "5 points at frame 2"]),
        (lose_a_number, "", ["/props/box", "nan"]),
        (lose_area, "", ["/props/box", "triangle 0", "area"]),
    ],
)
def test_an_unusable_collider_is_refused_in_one_line(example, tmp_path, change, more, words):
    shot = with_box(example, tmp_path, change)
    shot.write_text(shot.read_text() + more)
    refused(run("sim", shot, "--groom", example / "groom.usdc", "-o", tmp_path / "cache.usdc"), *words)
    assert not (tmp_path / "cache.usdc").exists()


def test_a_smaller_linear_tolerance_takes_more_iterations():
    iterations = []
    for tolerance in (0.5, 1e-3):
        shot = parse_shot(SHOT + f"[solver]\nlinear_tolerance = {tolerance}\n" + CONTACT)
        statistics = simulate(shot, groom(apart=1e-3), still(floor())).statistics
        iterations.append(sum(frame["contact"]["linear_iterations"] for frame in statistics[1:]))
    assert iterations[1] > 2 * iterations[0]


def test_visible_surfaces_that_hair_does_not_touch_are_named_by_the_command(folder):
    stage = Usd.Stage.Open(str(folder / "head.usda"))
    UsdGeom.Sphere.Define(stage, "/ball/bead").CreateRadiusAttr(1.0)
    stage.Save()
    edit(folder / "small.shot.toml", "preroll = 0", "preroll = 0\n[contact]")
    sentence = "head.usda /ball/bead: is a Sphere, which hair does not touch; convert it to a Mesh"
    result = run("sim", folder / "small.shot.toml", "-o", folder / "cache.usdc")
    assert result.exit_code == 0 and sentence in result.stdout
    result = run("sim", folder / "small.shot.toml", "-o", folder / "cache.usdc", "--json")
    (note,) = json.loads(result.stdout)["notes"]
    assert note.endswith(sentence)


@pytest.mark.parametrize("incline", [0.8, 0.0, -0.3])  # −0.3: into the floor
@pytest.mark.parametrize("length", [2e-4, 1e-3, 3e-3])
def test_locks_shorter_than_their_contacts_are_not_stretched(length, incline):
    along = np.linspace(0, length, 10)[:, None] * [np.cos(incline), np.sin(incline), 0]
    locks = Curves.from_list([along + [0, 0, 3e-4 * k] for k in range(4)])
    mesh = floor()
    triangle, barycentric, _ = _core.bind_roots(mesh.points, mesh.triangles, locks.roots)
    locks.curve |= {"root_triangle": triangle, "root_barycentric": barycentric}
    cache = simulated(made=Groom(locks, locks, mesh), obstacles=[Obstacle(mesh, still(mesh))])
    edges = np.linalg.norm(np.diff(cache.points.reshape(-1, 4, 10, 3), axis=2), axis=3)
    assert edges.sum(axis=2).max() < 1.01 * length
    assert edges.max() < 1.1 * length / 9
