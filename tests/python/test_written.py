"""The verdict is on the curves that a simulation writes, also on those that a core carries."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from ringlet.api.caches import scalp_clip
from ringlet.api.shots import start_motion
from ringlet.data.binding import root_places
from ringlet.data.braids import Braids
from ringlet.data.curves import Curves
from ringlet.data.groom import SECTION, STRAND_RADIUS
from ringlet.data.mesh import Clip, Mesh
from ringlet.report import judge
from ringlet.shot import ShotCloth
from ringlet.sim import Garment, Motion, Obstacle, checkpoint, cores, simulate
from ringlet.sim.garment import SimulatedGarment
from ringlet.sim.inextensible import along_paths
from ringlet.sim.written import Written

import ringlet

CASE = Path(__file__).parents[1] / "cases" / "core_braid_stretch"
RANDOM = np.random.default_rng(53)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Braids that move as their core on a head that turns by 17° a frame."""
    return Path(shutil.copytree(CASE, tmp_path_factory.mktemp("written") / "case"))


@pytest.fixture(scope="module")
def groom(folder: Path) -> ringlet.Groom:
    return ringlet.build_groom(folder / "r.recipe.toml")


def strain(curves: Curves, points: np.ndarray) -> np.ndarray:
    """Relative change of the length of each edge, shape (n,); 0 at the last point of a curve."""
    groomed, now = curves.edge_lengths(), curves.with_points(np.asarray(points, np.float64)).edge_lengths()
    return np.divide(now - groomed, groomed, out=np.zeros(len(now)), where=groomed > 0.0)


def test_strands_keep_the_lengths_of_their_edges_where_their_core_whips(folder: Path, groom: ringlet.Groom) -> None:
    cache = ringlet.simulate(folder / "s.shot.toml", groom)
    clip = scalp_clip(groom)
    for frame, points, statistics in zip(cache.frames, cache.points, cache.statistics, strict=True):
        assert np.abs(strain(groom.locks, points)).max() < 1e-4  # the rounding of files
        assert statistics["max_stretch"] < 1e-6
        places = root_places(groom.locks, clip.at(frame), groom.scalp.triangles)
        np.testing.assert_allclose(points[groom.locks.offsets[:-1]], places, atol=1e-6)


def test_a_verdict_names_frames_and_locks_of_carried_strands(
    folder: Path, groom: ringlet.Groom, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With strands that are carried as the frames of their core are, without the lengths of their edges."""
    monkeypatch.setattr(cores, "along_paths", lambda paths, offsets, lengths: paths)
    monkeypatch.setattr(checkpoint, "VERTICES", 1)  # a state after every step
    checkpoints = folder / "checkpoints"
    cache = ringlet.simulate(folder / "s.shot.toml", groom, checkpoints=checkpoints)
    for points, statistics in zip(cache.points, cache.statistics, strict=True):
        measured = np.abs(strain(groom.locks, points))
        assert statistics["max_stretch"] == pytest.approx(measured.max(), abs=1e-4)
        if statistics["max_stretch"] > 0.01:
            row = int(np.searchsorted(groom.locks.offsets, measured.argmax(), side="right") - 1)
            assert statistics["worst_lock"] == groom.locks.ids[row]
    assert cache.statistics[-1]["max_stretch"] > 0.2
    stretched = next(finding for finding in judge(cache.statistics).findings if "stretched" in finding.what)
    assert 5 in stretched.frames and cache.statistics[-1]["worst_lock"] in stretched.locks
    resumed = ringlet.simulate(folder / "s.shot.toml", groom, checkpoints=checkpoints, resume=True)
    written = ("max_stretch", "worst_lock", "folds", "folded_locks")
    assert [[one.get(name) for name in written] for one in resumed.statistics] == [
        [one.get(name) for name in written] for one in cache.statistics
    ]


def test_heads_that_turn_at_random_keep_edges_and_roots(folder: Path, groom: ringlet.Groom) -> None:
    shot = ringlet.read_shot(folder / "s.shot.toml").model_copy(update={"contact": None})
    points, frames = [groom.scalp.points], np.arange(8.0)
    for _ in frames[1:]:
        axis = RANDOM.normal(size=3)
        axis *= RANDOM.uniform(0.0, 0.6) / np.linalg.norm(axis)
        points.append(points[-1] @ rotation(axis).T + RANDOM.normal(scale=0.02, size=3))
    clip = Clip(frames, np.array(points), 24.0)
    motion = Motion(shot, groom, clip, None, (), (), 0)
    for k in range(len(frames)):
        motion.reach(k)
        at = motion.points(k)
        assert np.abs(strain(groom.locks, at)).max() < 1e-9
        places = root_places(groom.locks, clip.at(k), groom.scalp.triangles)
        np.testing.assert_allclose(at[groom.locks.offsets[:-1]], places, atol=1e-9)


def rotation(axis: np.ndarray) -> np.ndarray:
    """The rotation about an axis by its length [rad] (Rodrigues)."""
    angle = float(np.linalg.norm(axis))
    x, y, z = axis / angle
    k = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * k + (1.0 - np.cos(angle)) * k @ k


def test_curves_keep_their_edges_on_paths_of_any_length() -> None:
    counts = np.array([3, 40, 2, 17])
    offsets = np.concatenate([[0], np.cumsum(counts)]).astype(np.int32)
    for size in (0.3, 1.0, 3.0, 30.0):
        paths = np.cumsum(RANDOM.normal(size=(offsets[-1], 3)) + [size, 0.0, 0.0], axis=0)
        lengths = RANDOM.uniform(0.5, 2.0, offsets[-1])
        lengths[offsets[1:] - 1] = 0.0
        made = Curves(along_paths(paths, offsets, lengths), offsets, np.arange(len(counts)))
        np.testing.assert_allclose(made.edge_lengths(), lengths, rtol=1e-9)
        np.testing.assert_allclose(made.roots, paths[offsets[:-1]], atol=1e-12)
    own = Curves(paths, offsets, np.arange(len(counts)))
    np.testing.assert_allclose(along_paths(paths, offsets, own.edge_lengths()), paths, atol=1e-9)
    line = np.outer(np.arange(5.0), [0.0, 1.0, 0.0])
    half = along_paths(line, np.array([0, 5], np.int32), np.array([0.5, 0.5, 0.5, 0.5, 0.0]))
    np.testing.assert_allclose(half, 0.5 * line, atol=1e-12)


def braid(turn: float, reversed_edges: int = 0) -> Curves:
    """Three strands side by side, 4 mm apart, whose middle turns by an angle [rad] half-way; one may run back there."""
    angle = np.where(np.arange(59) < 30, 0.0, turn)
    steps = 1e-3 * np.stack([np.cos(angle), np.sin(angle), np.zeros(59)], axis=1)
    line = np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)])
    strands = [line + [0.0, 0.0, 4e-3 * k] for k in (-1, 0, 1)]
    strands[0][10 + np.arange(reversed_edges), 0] = strands[0][10, 0] - 1e-3 * np.arange(reversed_edges)
    curves = Curves.from_list(strands)
    return replace(curves, curve={SECTION: np.zeros(3, np.int32), STRAND_RADIUS: np.full(3, 2e-3, np.float32)})


def test_a_braid_folds_where_it_or_a_strand_of_it_turns_back_over_its_own_width() -> None:
    for turn, folds in ((0.0, False), (1.5, False), (2.0, False), (2.3, True), (3.1, True)):
        curves = braid(turn)
        folded = Braids.of(curves).folded(curves.points).reshape(3, -1)
        assert folded.any() == folds
        if folds:
            assert folded[:, 30].all() and not folded[:, :20].any()
    for edges, folds in ((2, False), (7, True)):
        curves = braid(0.0, edges)
        folded = Braids.of(curves).folded(curves.points).reshape(3, -1)
        assert folded[0].any() == folds and not folded[1:].any()
    loose = replace(braid(3.1), curve={})  # locks without a radius of their own are no braids
    assert not Braids.of(loose).folded(loose.points).any()


def test_strands_inside_a_body_are_named_with_the_body(groom: ringlet.Groom) -> None:
    made = cores.Cores.of(groom)
    judged = Written(made, None, np.zeros(len(made.groom.locks.points), bool))
    middle = groom.locks[4][40]
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * 3e-3 + middle
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = np.array([[s[0], s[k], s[k + 1]] for s in sides for k in (1, 2)], np.int32)
    box = Obstacle(Mesh("box", corners, triangles), Clip(np.array([0.0]), corners[None], 24.0))
    (found,) = judged.statistics(groom.locks.points, [box], 0.0)["inside"]
    assert found["what"] == "box" and int(groom.locks.ids[4]) in found["locks"]
    assert found["depth"] == pytest.approx(3e-3, abs=1e-9)
    far = Obstacle(Mesh("box", corners + 1.0, triangles), Clip(np.array([0.0]), corners[None] + 1.0, 24.0))
    assert "inside" not in judged.statistics(groom.locks.points, [far], 0.0)


def test_strands_beyond_a_cloth_are_named_with_it(folder: Path, groom: ringlet.Groom) -> None:
    """Of a sheet across a braid half-way; not of one beside it, nor of one that ends beside it."""
    made = cores.Cores.of(groom)
    judged = Written(made, None, np.zeros(len(made.groom.locks.points), bool))
    strands = groom.locks.points.reshape(len(groom.locks), -1, 3)[3:6]
    middle = strands.mean(axis=0)
    along = middle[31] - middle[29]
    across = np.cross(along, [1.0, 0.0, 0.0])
    sides = [side / np.linalg.norm(side) for side in (across, np.cross(along, across))]
    square = np.array([[x, y] for x in (-1, 1) for y in (-1, 1)]) * 0.02
    for shift, beyond in ((0.0, True), (0.06, False)):
        corners = middle[30] + square @ sides + shift * sides[0]
        mesh = Mesh("scarf", corners, np.array([[0, 1, 3], [0, 3, 2]], np.int32))
        clip = Clip(np.array([0.0]), corners[None], 24.0)
        settings = ShotCloth(name="scarf", file=Path("scarf.usda"))
        scarf = Garment(mesh, clip, settings)
        worn = SimulatedGarment(scarf, (), 0.0)
        found = judged.statistics(groom.locks.points, [], 0.0, [worn]).get("inside", [])
        assert bool(found) == beyond
        if beyond:
            assert found[0]["what"] == "scarf" and found[0]["locks"] == groom.locks.ids[3:6].tolist()
            assert found[0]["depth"] == pytest.approx(np.linalg.norm(middle[-1] - middle[30]), rel=0.2)
            assert found[0]["points"] == pytest.approx(3 * 29, abs=9)
            shot = ringlet.read_shot(folder / "s.shot.toml")
            started = simulate(shot, groom, scalp_clip(groom), garments=[scarf], frames=(1, 1))
            assert [one["what"] for one in started.statistics[0]["inside"]] == ["scarf"]


def test_strands_in_those_of_another_braid_are_named_unless_the_groom_has_them_there(groom: ringlet.Groom) -> None:
    def entangled(curves: Curves, points: np.ndarray) -> list[dict]:
        made = cores.Cores.of(replace(groom, locks=curves))
        judged = Written(made, None, np.zeros(len(made.groom.locks.points), bool))
        return judged.statistics(points, [], 0.0).get("inside", [])

    locks = groom.locks
    strands = np.array(locks.points, np.float64).reshape(len(locks), -1, 3)
    radius = float(locks.curve[STRAND_RADIUS][0])
    assert not entangled(locks, strands.reshape(-1, 3))
    for away, depth in ((0.3, 0.7), (1.1, 0.0)):  # in radii: a strand of the second braid, beside one of the first
        moved = strands.copy()
        beside = np.cross(np.gradient(strands[0], axis=0), [1.0, 0.0, 0.0])
        moved[3] = strands[0] + away * radius * beside / np.linalg.norm(beside, axis=1, keepdims=True)
        moved[4:6] += 10.0 + np.arange(2.0)[:, None, None]
        found = [one for one in entangled(locks, moved.reshape(-1, 3)) if one["what"] == "other braids"]
        assert bool(found) == (depth > 0.0)
        if found:
            assert found[0]["depth"] == pytest.approx(depth * radius, rel=0.05)
            assert found[0]["locks"] == locks.ids[[0, 3]].tolist()
            assert not entangled(locks.with_points(moved.reshape(-1, 3)), moved.reshape(-1, 3))


def test_strands_miss_as_much_of_their_motion_as_their_cores(folder: Path, groom: ringlet.Groom) -> None:
    shot = ringlet.read_shot(folder / "s.shot.toml")

    def moved(newton: int) -> np.ndarray:
        solver = shot.solver.model_copy(update={"newton": newton, "linear_tolerance": 0.02})
        motion = start_motion(shot.model_copy(update={"solver": solver}), groom)
        played = [(motion.strands.positions.copy(), motion.points(1))]
        for k in range(1, 5):
            motion.reach(k)
            played.append((motion.strands.positions.copy(), motion.points(1 + k)))
        offsets = motion.locks.offsets, groom.locks.offsets
        return np.array(
            [sum(ringlet.lock_motion(np.array(p), o)) for p, o in zip(zip(*played, strict=True), offsets, strict=True)]
        )

    converged = moved(60)
    for newton in (1, 2, 3):
        core, strand = moved(newton) / converged
        assert strand == pytest.approx(core, abs=0.02) and (newton > 1 or strand < 0.8)
