"""Live hair: it hangs as groomed, goes on from where it is, and comes back whatever is done to the head."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from ringlet.api.live import clothes_of
from ringlet.data.rigid import rotation_vector
from ringlet.live.rods import HELD, VERTICES
from small_example import RECIPE, write_example

import ringlet
from ringlet import Curves, Groom, Live, Material, Solver, Strands, Touch, UserError, _core
from ringlet.live import bodies, default_contact

Array = NDArray[np.float64]


@pytest.fixture(scope="module")
def groom(tmp_path_factory: pytest.TempPathFactory) -> Groom:
    folder = write_example(tmp_path_factory.mktemp("live"))
    return ringlet.build_groom(folder / "small.recipe.toml")


def widened(groom: Groom) -> Groom:
    """The groom with curls twice as wide."""
    assert groom.scalp_file is not None
    recipe = groom.scalp_file.parent / "wide.recipe.toml"
    recipe.write_text(RECIPE.replace("width = 1.0", "width = 2.0"))
    return ringlet.build_groom(recipe)


def turned(degrees: float, shift: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Array:
    """A turn of the head about the vertical, and a shift [m]."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    head = np.eye(4)
    head[:3, :3], head[:3, 3] = [[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]], shift
    return head


def swung(live: Live, steps: int = 6) -> Live:
    """After some steps of a head that turns."""
    for k in range(1, steps + 1):
        live.head = turned(8.0 * k)
        assert live.step() == ""
    return live


def test_hair_begins_as_groomed_and_hangs_still(groom: Groom) -> None:
    live = Live(groom)
    assert live.positions == pytest.approx(np.asarray(groom.locks.points, np.float64), abs=1e-9)
    for _ in range(240):
        live.step()
    assert live.positions == pytest.approx(np.asarray(groom.locks.points, np.float64), abs=1e-4)


def test_rods_carry_their_locks_rigidly(groom: Groom) -> None:
    live, head = Live(groom), turned(40.0, (0.1, 0.2, -0.3))
    live.head = head
    live.reset()
    expected = np.asarray(groom.locks.points, np.float64) @ head[:3, :3].T + head[:3, 3]
    assert live.positions == pytest.approx(expected, abs=1e-9)
    assert live.motions == pytest.approx(np.broadcast_to(head[:3], live.motions.shape), abs=1e-9)


def test_points_follow_the_motions_of_the_vertices_about_them(groom: Groom) -> None:
    """As the page carries them."""
    live = swung(Live(groom))
    assert live.rods.shape == (len(groom.locks), VERTICES, 3)
    vertex, weight = live.places
    motions, points = live.motions.reshape(-1, 3, 4), np.c_[groom.locks.points, np.ones(len(groom.locks.points))]
    before, behind = (np.einsum("nij,nj->ni", motions[at], points) for at in (vertex, vertex + 1))
    assert live.positions == pytest.approx((1.0 - weight)[:, None] * before + weight[:, None] * behind, abs=1e-12)


def test_hair_lags_and_comes_back(groom: Groom) -> None:
    live = swung(Live(groom))
    still = np.asarray(groom.locks.points) @ live.head[:3, :3].T
    assert np.abs(live.positions - still).max() > 5e-4
    for _ in range(48):
        live.step()
    assert np.abs(live.positions - still).max() < 1e-3


def test_another_material_acts_from_the_next_step(groom: Groom) -> None:
    live, other = swung(Live(groom)), swung(Live(groom))
    before = live.positions
    live.material = Material(bend_scale=10.0)
    assert live.positions == pytest.approx(before, abs=0.0)
    live.step()
    other.step()
    assert np.abs(live.positions - other.positions).max() > 1e-4


@pytest.mark.parametrize("bend_scale", [0.1, 1.0, 10.0])
def test_hair_hangs_as_groomed_however_stiff_it_is(groom: Groom, bend_scale: float) -> None:
    live = Live(groom)
    live.material = Material(bend_scale=bend_scale)
    for _ in range(120):
        live.step()
    assert live.positions == pytest.approx(np.asarray(groom.locks.points, np.float64), abs=1e-4)


def test_gravity_and_wind_act(groom: Groom) -> None:
    for change in ({"gravity": (0.0, 9.81, 0.0)}, {"wind": (5.0, 0.0, 0.0)}):
        live = Live(groom)
        for name, value in change.items():
            setattr(live, name, value)
        for _ in range(24):
            live.step()
        moved = (live.positions - groom.locks.points)[groom.locks.offsets[1:] - 1].mean(axis=0)
        assert moved @ (0.0, 1.0, 0.0) > 1e-4 or moved @ (1.0, 0.0, 0.0) > 1e-4


def test_hair_goes_on_from_where_it_is_to_another_groom(groom: Groom) -> None:
    live, other, wider = swung(Live(groom)), swung(Live(groom)), widened(groom)
    before = live.rods
    live.groom = wider
    assert live.rods[:, HELD:] == pytest.approx(before[:, HELD:], abs=1e-9)
    live.step()
    other.step()
    assert np.abs(live.rods - other.rods).max() < 0.01  # curls twice as wide pull at their rods
    for _ in range(120):
        live.step()
    assert live.positions == pytest.approx(np.asarray(wider.locks.points) @ live.head[:3, :3].T, abs=2e-3)


def test_locks_that_are_new_begin_as_groomed(groom: Groom) -> None:
    live, few = swung(Live(groom)), replace(groom, locks=groom.locks.take(np.array([0, 2, 5])))
    kept = live.positions.reshape(len(groom.locks), -1, 3)[[0, 2, 5]]
    live.groom = few
    assert live.positions.reshape(3, -1, 3) == pytest.approx(kept, abs=1e-9)
    live.groom = groom
    assert live.positions.reshape(len(groom.locks), -1, 3)[[0, 2, 5]] == pytest.approx(kept, abs=1e-9)
    other = swung(Live(groom))
    live.step()
    other.step()
    assert live.rods[[0, 2, 5]] == pytest.approx(other.rods[[0, 2, 5]], abs=1e-3)  # they have their twist and velocity
    grown = np.asarray(groom.locks.points).reshape(len(groom.locks), -1, 3)[1] @ live.head[:3, :3].T
    assert live.positions.reshape(len(groom.locks), -1, 3)[1] == pytest.approx(grown, abs=1e-9)


@pytest.mark.parametrize("thrown", [turned(0.0, (5.0, 0.0, 2.0)), turned(170.0)])
def test_a_head_that_is_thrown_carries_its_hair_along(groom: Groom, thrown: Array) -> None:
    live = swung(Live(groom))
    live.head = thrown
    note = live.step()
    assert "thrown" in note and "\n" not in note
    for _ in range(24):
        assert live.step() == ""
    still = np.asarray(groom.locks.points) @ thrown[:3, :3].T + thrown[:3, 3]
    assert np.abs(live.positions - still).max() < 2e-3


@pytest.mark.parametrize("head", [np.full((4, 4), np.nan), 2.0 * np.eye(4), np.diag([1.0, 1.0, -1.0, 1.0]), np.eye(3)])
def test_what_is_no_motion_of_a_head_is_refused(groom: Groom, head: Array) -> None:
    live = swung(Live(groom))
    before = live.head
    with pytest.raises(UserError, match=r"^live: head .* stays where it is$"):
        live.head = head
    assert (live.head == before).all()
    live.step()
    assert np.isfinite(live.positions).all()


def test_the_grid_keeps_momentum_and_what_moves_with_the_head() -> None:
    random = np.random.default_rng(1)
    places, masses = random.uniform(-0.1, 0.1, (200, 3)), random.uniform(1.0, 2.0, 200)
    grid = _core.VelocityGrid(np.full(3, -0.2), np.full(3, 0.2), 0.05)
    velocities, still, free = random.standard_normal((200, 3)), np.eye(4), np.zeros(200, np.uint8)
    before = masses @ velocities
    spread = np.linalg.norm(velocities - velocities.mean(axis=0))
    grid.share(places, masses, free, still, still, 0.04, 0.7, 1.0, velocities)
    assert masses @ velocities == pytest.approx(before)
    assert np.linalg.norm(velocities - velocities.mean(axis=0)) < 0.5 * spread

    head = turned(10.0, (0.02, 0.0, 0.01))
    end = places @ head[:3, :3].T + head[:3, 3]
    velocities = (end - places) / 0.04
    expected = velocities.copy()
    grid.share(end, masses, free, still, head, 0.04, 0.7, 0.9, velocities)
    assert velocities == pytest.approx(expected, abs=1e-12)


def test_distances_of_a_grid_are_those_to_the_mesh(groom: Groom) -> None:
    scalp = groom.scalp
    solid = _core.Solid(np.ascontiguousarray(scalp.points, np.float64), scalp.triangles)
    grid = _core.DistanceGrid(solid, np.full(3, -0.15), np.full(3, 0.15), 0.005, 0.03)
    places = np.random.default_rng(2).uniform(-0.14, 0.14, (500, 3))
    distances, gradients = grid.at(places)
    expected = solid.above(places)[0]
    near = np.abs(expected) < 0.03
    assert distances[near] == pytest.approx(expected[near], abs=1e-3)
    assert distances == pytest.approx(expected, abs=4e-3)
    h = 1e-6
    for k in range(3):
        step = h * np.eye(3)[k]
        slope = (grid.at(places + step)[0] - grid.at(places - step)[0]) / (2.0 * h)
        within = near & (np.linalg.norm(gradients, axis=1) > 0.9)
        assert slope[within] == pytest.approx(gradients[within, k], abs=0.12)
    assert np.isinf(grid.at(np.array([[1.0, 0.0, 0.0]]))[0][0])


def test_a_head_that_is_dragged_keeps_its_hair_outside(groom: Groom) -> None:
    """At 1.5 m/s, to and fro at once: at most 0.5 % of points are inside, and none is stuck a second later."""
    live, scalp = Live(groom), groom.scalp
    solid = _core.Solid(np.ascontiguousarray(scalp.points, np.float64), scalp.triangles)
    head, inside, at = np.eye(4), [], 0.0
    for k in range(48):
        at += live.dt * (1.5 if k // 8 % 2 == 0 else -1.5)
        head[0, 3] = at
        live.head = head
        assert live.step() == ""
        inside.append(np.mean(solid.above(live.positions - head[:3, 3])[0] < -1e-3))
    assert max(inside) <= 0.005
    for _ in range(24):
        live.step()
    assert live.positions - head[:3, 3] == pytest.approx(np.asarray(groom.locks.points, np.float64), abs=2e-3)


def test_clothes_go_with_the_trunk_and_push_hair(groom: Groom) -> None:
    """A ball below the hair that the trunk lifts into it, while the head is still."""
    tips = Live(groom).rods[:, -1]
    ball = replace(groom.scalp, points=0.5 * groom.scalp.points + tips[tips[:, 1].argmin()] - (0.0, 0.15, 0.0))
    live = Live(groom, clothes=[ball])
    solid = _core.Solid(np.ascontiguousarray(ball.points, np.float64), ball.triangles)

    def deepest() -> float:
        return float(solid.above(live.rods[:, 3:].reshape(-1, 3) - live.trunk[:3, 3])[0].min())  # type: ignore[index]

    for height in np.linspace(0.0, 0.13, 21):
        live.trunk = turned(0.0, (0.0, float(height), 0.0))
        live.step()
        assert deepest() > 0.0
    assert np.abs(live.positions - groom.locks.points).max() > 5e-3
    live.trunk = None
    for _ in range(72):
        live.step()
    assert live.positions == pytest.approx(np.asarray(groom.locks.points, np.float64), abs=1e-3)


def test_friction_holds_hair_on_what_presses_on_it(groom: Groom, monkeypatch: pytest.MonkeyPatch) -> None:
    """A ball is lifted into the hair, and shifted to a side: without friction the lock slips off to the other."""
    tips = Live(groom).rods[:, -1]
    lowest = tips[:, 1].argmin()
    ball = replace(groom.scalp, points=0.5 * groom.scalp.points + tips[lowest] - (0.0, 0.07, 0.0))

    def slips(friction: float) -> float:
        monkeypatch.setattr(bodies, "FRICTION", friction)
        live = Live(groom, clothes=[ball])
        for height in np.linspace(0.0, 0.05, 21):
            live.trunk = turned(0.0, (0.0, float(height), 0.0))
            live.step()
        before = live.rods[lowest, -1]
        for side in np.linspace(0.0, 0.02, 13)[1:]:
            live.trunk = turned(0.0, (0.0, 0.05, float(side)))
            live.step()
        return float(np.linalg.norm(live.rods[lowest, -1] - before))

    without = slips(0.0)
    assert without > 8e-3
    assert slips(0.3) < 0.5 * without


def test_what_is_below_the_neck_goes_with_the_trunk_of_the_clip(tmp_path: Path) -> None:
    child = Path(__file__).parents[2] / "examples" / "child"
    recipe = tmp_path / "child.recipe.toml"
    recipe.write_text(RECIPE.replace('"head.usda"', f'"{child / "head.usdc"}"\nmesh = "/child/skin"'))
    groom = ringlet.build_groom(recipe)
    assert [mesh.name.split("/")[-1] for mesh in clothes_of(groom)] == ["shirt"]
    heads, trunks = (motion(groom, (1, 26)) for motion in (ringlet.head_motion, ringlet.trunk_motion))
    angle_of_head, angle_of_trunk = (
        np.degrees(np.linalg.norm(rotation_vector(of[-1, :3, :3]))) for of in (heads, trunks)
    )
    assert angle_of_head > 35.0
    assert 3.0 < angle_of_trunk < 12.0


def test_rods_that_are_blown_at_the_head_stay_outside(groom: Groom) -> None:
    solid = _core.Solid(np.ascontiguousarray(groom.scalp.points, np.float64), groom.scalp.triangles)

    def deepest(live: Live) -> float:
        live.wind = (20.0, 0.0, 0.0)
        found = []
        for _ in range(24):
            live.step()
            found.append(solid.above(live.rods[:, 3:].reshape(-1, 3))[0].min())
        return float(min(found))

    soft = Material(bend_scale=0.1)
    assert deepest(Live(groom, soft, contact=0.0, bodies=())) < -0.05
    assert deepest(Live(groom, soft, contact=0.0)) > 0.0


def test_a_spring_from_a_vertex_is_in_balance_with_its_strand() -> None:
    points = np.array([(0.01 * k, 0.002 * (k % 2), 0.0) for k in range(8)])
    strand = Strands(Curves(points, np.array([0, 8], np.int32), np.zeros(1, np.int64)), Material())
    targets, stiffness = points.copy(), np.zeros(8)
    targets[-1] += (0.0, 0.0, 0.01)
    stiffness[-1] = 1e-4
    for _ in range(200):
        strand.step(points, 0.1, solver=Solver(newton=20, tolerance=1e-12), springs=(targets, stiffness))
    gradient = strand.energy(strand.positions)[1]
    pull = stiffness[:, None] * (targets - strand.positions)
    assert np.abs(pull).max() > 1e-8
    assert gradient == pytest.approx(pull, abs=1e-4 * np.abs(pull).max())


def pulled(live: Live, by: tuple[float, float, float], steps: int = 12) -> Array:
    """The tips of locks after a hand has pulled the first one by its tip to a place from there, (count, 3)."""
    tip = live.rods[0, -1]
    for share in np.linspace(0.0, 1.0, steps):
        live.touch = Touch("pull", tuple(tip + share * np.array(by)))
        assert live.step() == ""
    return live.rods[:, -1]


def is_back(live: Live, seconds: float = 1.0) -> bool:
    """Whether hair that is let go is within 2 mm of its groom, on a head at rest, after some seconds."""
    live.touch = None
    for _ in range(round(seconds / live.dt)):
        assert live.step() == ""
    return bool(np.abs(live.positions - live.groom.locks.points).max() < 2e-3)


def test_a_hand_pulls_the_nearest_lock_and_it_returns(groom: Groom) -> None:
    live = Live(groom)
    before, by = live.rods[:, -1], (0.01, -0.01, 0.015)
    moved = np.linalg.norm(pulled(live, by) - before, axis=1)
    assert live.rods[0, -1] - before[0] == pytest.approx(by, abs=1e-3)
    assert moved[0] > 2.0 * moved[1:].max()
    live.touch = None
    live.step()
    assert np.linalg.norm(live.rods[0, -1] - before[0]) < 0.8 * moved[0]
    assert is_back(live)


def test_neighbours_follow_a_lock_that_is_pulled(groom: Groom) -> None:
    near = replace(groom, locks=groom.locks.take(np.array([0, 0, 4])))
    near.locks.ids[:] = 0, 1, 2
    near.locks.points[near.locks.offsets[1] : near.locks.offsets[2]] += (0.004, 0.0, 0.0)
    live = Live(near)
    before = live.rods[:, -1]
    moved = np.linalg.norm(pulled(live, (0.02, 0.0, 0.0), 3) - before, axis=1)
    assert moved[1] > 5.0 * moved[2]
    assert moved[1] > 5e-4


def test_a_lock_is_pulled_as_far_as_its_wire_reaches(groom: Groom) -> None:
    live = Live(groom)
    pulled(live, (0.0, 0.0, 3.0), 24)
    rod, length = live.rods[0], groom.locks.lengths()[0]
    assert 0.8 * length < np.linalg.norm(rod[-1] - rod[0]) < length
    assert is_back(live)


def test_a_coil_that_is_drawn_out_gets_narrower_and_keeps_its_wire(groom: Groom) -> None:
    live = Live(groom)
    rod = live.rods[0]
    chord = rod[-1] - rod[0]
    pulled(live, tuple(0.3 * chord), 24)

    def axis() -> float:
        return float(np.linalg.norm(np.diff(live.rods[0], axis=0), axis=1).sum())

    longer = axis() / np.linalg.norm(np.diff(rod, axis=0), axis=1).sum()
    first = slice(0, groom.locks.offsets[1])
    wire = np.linalg.norm(np.diff(live.positions[first], axis=0), axis=1).sum() / groom.locks.lengths()[0]
    assert longer > 1.2
    assert wire == pytest.approx(1.0, abs=0.05)


def test_a_comb_takes_hair_along(groom: Groom) -> None:
    live = Live(groom)
    before = live.rods
    way, middle = np.array((0.0, 0.0, 0.02)), before[0, 5]
    for share in np.linspace(-1.0, 1.0, 8):
        live.touch = Touch("comb", tuple(middle + share * way), radius=0.05)
        assert live.step() == ""
    moved = (live.rods - before)[:, 5] @ way / np.linalg.norm(way)
    assert moved[0] > 5e-3
    assert moved[0] == moved.max()
    assert is_back(live)


def test_a_palm_presses_hair_down_and_stays_outside_the_head(groom: Groom) -> None:
    live, scalp = Live(groom), groom.scalp
    solid = _core.Solid(np.ascontiguousarray(scalp.points, np.float64), scalp.triangles)
    at, radius = live.rods[0, -1], 0.03
    for _ in range(12):
        live.touch = Touch("pat", tuple(at), radius)
        assert live.step() == ""
    free = live.rods[:, 3:].reshape(-1, 3)
    assert np.linalg.norm(free - at, axis=1).min() > radius - 1e-3
    assert solid.above(free)[0].min() > -1e-3
    assert is_back(live)
    for _ in range(12):  # on the scalp, where there is no place for a palm
        live.touch = Touch("pat", tuple(live.rods[0, 0]), radius)
        assert live.step() == ""
    assert solid.above(live.rods[:, 3:].reshape(-1, 3))[0].min() > -1e-3
    assert is_back(live)


@pytest.mark.parametrize("does", ["pull", "comb", "pat"])
def test_a_hand_that_is_thrown_lets_go(groom: Groom, does: Any) -> None:
    live = Live(groom)
    tip = live.rods[0, -1]
    live.touch = Touch(does, tuple(tip))
    assert live.step() == ""
    live.touch = Touch(does, (5.0, 0.0, 2.0))
    note = live.step()
    assert "the hand was thrown" in note and note.endswith("it let go") and "\n" not in note
    live.touch = Touch(does, tuple(tip))  # it has not been taken away
    for _ in range(24):
        assert live.step() == ""
    assert np.abs(live.positions - groom.locks.points).max() < 2e-3


@pytest.mark.parametrize(
    "values", [{"at": (0.0, np.nan, 0.0)}, {"at": (0.0, 0.0)}, {"radius": np.inf}, {"radius": 0.0}]
)
def test_what_is_no_place_of_a_hand_is_refused(values: dict[str, Any]) -> None:
    with pytest.raises(UserError, match=r"^live: .*hand is .*; must be"):
        Touch("pull", **{"at": (0.0, 0.0, 0.0), **values})


def test_a_hand_lets_go_of_a_lock_that_is_no_longer_there(groom: Groom) -> None:
    live = Live(groom)
    pulled(live, (0.01, 0.0, 0.0))
    live.groom = replace(groom, locks=groom.locks.take(np.arange(1, len(groom.locks))))
    assert live.step() == ""
    assert np.isfinite(live.positions).all()


def test_locks_that_are_lost_begin_again(groom: Groom) -> None:
    live = swung(Live(groom))
    live._strands.positions[VERTICES : 2 * VERTICES] = np.nan
    assert live.step() == "1 of 8 locks were lost and begin again as groomed"
    assert np.isfinite(live.positions).all()
    assert live.step() == ""


def test_the_default_contact_is_that_of_the_style(groom: Groom) -> None:
    locks = groom.locks

    def style(**attributes: NDArray[np.generic]) -> str:
        return default_contact(replace(groom, locks=replace(locks, curve={**locks.curve, **attributes})))[1]

    radius, alone = np.full(len(locks), 1e-3), np.arange(len(locks))
    assert style() == "curls"
    assert style(strand_radius=radius) == style(strand_radius=radius, section=alone) == "locs"
    assert style(strand_radius=radius, section=alone // 2) == "braids and twists"
