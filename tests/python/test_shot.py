"""Shots: settings, and locks on a moving scalp."""

import numpy as np
import pytest
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.groom import Groom
from ringlet.data.mesh import Clip, Mesh
from ringlet.shot import parse_shot
from ringlet.sim import simulate

from ringlet import _core

SHOT = 'ringlet = 2\ngroom = "groom.usdc"\nframes = [1, 6]\npreroll = 0\n'


def scalp():
    """A square patch of 10 cm in the plane y = 0, facing up."""
    points = np.array([[0, 0, 0], [0.1, 0, 0], [0.1, 0, 0.1], [0, 0, 0.1]])
    return Mesh("patch", points, np.array([[0, 2, 1], [0, 3, 2]], np.int32))


def groom():
    """Three coils on the patch."""
    turn = 2 * np.pi * np.arange(40) / 12
    coil = np.c_[0.003 * np.cos(turn) - 0.003, 0.004 * turn / (2 * np.pi), 0.003 * np.sin(turn)]
    roots = np.array([[0.03, 0, 0.05], [0.05, 0, 0.02], [0.08, 0, 0.07]])
    locks = Curves.from_list([coil + root for root in roots], ids=[11, 12, 13])
    mesh = scalp()
    triangle, barycentric, _ = _core.bind_roots(mesh.points, mesh.triangles, locks.roots)
    locks.curve |= {"root_triangle": triangle, "root_barycentric": barycentric}
    return Groom(locks, locks, mesh)


def moving(motion, frames=6):
    """A clip of the patch: ``motion(frame, points)``."""
    numbers = np.arange(1.0, frames + 1)
    return Clip(numbers, np.array([motion(frame, scalp().points) for frame in numbers]), 24.0)


def turned(frame, points):
    """Points rotated by 10° a frame about y and raised by 1 cm a frame."""
    angle = np.radians(10) * (frame - 1)
    about = np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])
    return points @ about.T + [0, 0.01 * (frame - 1), 0]


def test_prescribed_vertices_follow_the_scalp_in_position_and_orientation():
    made = groom()
    cache = simulate(parse_shot(SHOT), made, moving(turned))
    prescribed = (made.locks.offsets[:-1, None] + np.arange(3)).ravel()
    for frame, points in zip(cache.frames, cache.points, strict=True):
        assert np.abs(points[prescribed] - turned(frame, made.locks.points)[prescribed]).max() < 1e-7


def test_a_static_groom_without_forces_stays_as_groomed():
    made = groom()
    shot = parse_shot(SHOT + "[forces]\ngravity = [0, 0, 0]\n")
    cache = simulate(shot, made, moving(lambda frame, points: points))
    assert np.abs(cache.points - made.locks.points).max() < 1e-7


def test_a_shot_starts_on_the_head_of_its_first_frame():
    made = groom()
    shot = parse_shot(SHOT + "[forces]\ngravity = [0, 0, 0]\n")
    cache = simulate(shot, made, moving(turned), frames=(4, 4))
    assert np.abs(cache.points[0] - turned(4, made.locks.points)).max() < 1e-7


def test_preroll_settles_the_hair_before_the_first_frame():
    made, clip = groom(), moving(lambda frame, points: points)
    fresh = simulate(parse_shot(SHOT), made, clip)
    settled = simulate(parse_shot(SHOT.replace("preroll = 0", "preroll = 200")), made, clip)
    drifts = [np.abs(cache.points[-1] - cache.points[0]).max() for cache in (fresh, settled)]
    assert drifts[1] < 0.01 * drifts[0]


def test_substeps_divide_a_frame_and_its_motion():
    made = groom()
    streamed = []
    shot = parse_shot(SHOT + "[solver]\nsubsteps = 3\n")
    cache = simulate(
        shot, made, moving(turned), on_frame=lambda frame, points, _: streamed.append((frame, points.copy()))
    )
    assert [frame for frame, _ in streamed] == list(cache.frames) == [1, 2, 3, 4, 5, 6]
    assert all((points == kept).all() for (_, points), kept in zip(streamed, cache.points, strict=True))
    coarse = simulate(parse_shot(SHOT), made, moving(turned))
    assert 0 < np.abs(cache.points[-1] - coarse.points[-1]).max() < 0.02


def test_statistics_describe_every_frame_of_the_solver():
    start, *frames = simulate(parse_shot(SHOT), groom(), moving(turned)).statistics
    assert start == {"frame": 1.0, "max_stretch": 0.0, "worst_lock": 11}  # without a step; judged as it is written
    for statistics in frames:
        assert 1 <= statistics["newton"] <= statistics["newton_max"] <= 5
        assert statistics["nan"] == 0 and statistics["max_stretch"] < 0.05
        assert statistics["worst_lock"] in (11, 12, 13)
        assert set(statistics["energy"]) == {"stretch", "bend", "twist", "gravity", "kinetic"}


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (("frames = [1, 6]", "frames = [6, 1]"), ["frames", "[6, 1]", "before"]),
        (("frames = [1, 6]", "frames = [1, 100001]"), ["frames", "at most 100,000 frames"]),
        (("frames = [1, 6]", "frames = [100000000, 100000001]"), ["frames", "must be at most 10000000"]),
        (("frames = [1, 6]", "framse = [1, 6]"), ["framse", "'frames'"]),
        (("preroll = 0", "preroll = -1"), ["preroll", "-1", "at least 0"]),
        (("preroll = 0", "[strands]\ntwist_ratio = 1.4"), ["strands.twist_ratio", "1.4", "at most 1"]),
        (("preroll = 0", "[solver]\nnewton = 0"), ["solver.newton", "0", "at least 1"]),
        (("preroll = 0", "[solver]\nlinear_tolerance = 0"), ["solver.linear_tolerance", "0", "more than 0"]),
        (("preroll = 0", "[solver]\ncontinuation = 'memory'"), ["solver.continuation", "memory", "material_frame"]),
        (
            ("preroll = 0", "[solver]\nsafeguards = []"),
            ["solver.safeguards", "material_frame", "history"],
        ),
        (("preroll = 0", "[forces]\ngravity = [0, nan, 0]"), ["forces.gravity", "nan"]),
        (("ringlet = 2", ""), ["first line", "ringlet = 2"]),
        (("ringlet = 2", "ringlet = "), ["TOML"]),
    ],
)
def test_an_invalid_shot_is_refused_in_one_line(change, words):
    with pytest.raises(UserError) as caught:
        parse_shot(SHOT.replace(*change))
    assert "\n" not in str(caught.value)
    for word in words:
        assert word in str(caught.value)


def flattened(frame, points):
    return points * [1, 1, 0] if frame == 3 else points


@pytest.mark.parametrize(
    ("spoil", "clip", "words"),
    [
        (lambda g: g.locks.curve.clear(), moving(turned), ["not bound", "recipe"]),
        (lambda g: None, Clip(np.array([1.0]), np.zeros((1, 5, 3)), 24.0), ["5 points", "4", "again"]),
        (lambda g: None, moving(flattened), ["frame 3", "triangle", "lock"]),
        (lambda g: g.locks.points.__setitem__((50, 1), np.nan), moving(turned), ["curve 12", "finite"]),
    ],
)
def test_an_invalid_groom_or_clip_is_refused_in_one_line(spoil, clip, words):
    made = groom()
    spoil(made)
    with pytest.raises(UserError) as caught:
        simulate(parse_shot(SHOT), made, clip)
    assert "\n" not in str(caught.value)
    for word in words:
        assert word in str(caught.value)


def test_more_prescribed_vertices_than_a_lock_has_are_refused():
    with pytest.raises(UserError, match="held is 40"):
        simulate(parse_shot(SHOT.replace("preroll = 0", "held = 40")), groom(), moving(turned))


@pytest.mark.parametrize(("first", "preroll"), [(1, 0), (1, 6), (5, 6)])
def test_a_head_in_steady_flight_does_not_move_its_hair(first, preroll):
    """A shot starts in the motion of its clip, also in the middle of it: only accelerations move hair."""
    made = groom()
    clip = Clip(
        np.arange(1.0, 13.0), np.array([made.scalp.points + [0.08 * k, 0.03 * k, 0.0] for k in range(12)]), 24.0
    )
    text = SHOT.replace("frames = [1, 6]", f"frames = [{first}, {first + 5}]").replace(
        "preroll = 0", f"preroll = {preroll}"
    )
    shot = parse_shot(text + "[strands]\ndrag = 0.0\n[forces]\ngravity = [0, 0, 0]\n")
    points = simulate(shot, made, clip).points.astype(float)
    relative = points - points[:, :1]
    assert np.abs(relative - relative[0]).max() < 1e-6
    assert np.linalg.norm(points[-1, 0] - points[0, 0]) > 0.4


@pytest.mark.parametrize("substeps", [1, 3])
def test_a_shot_without_preroll_starts_with_the_groom(substeps):
    made = groom()
    shot = parse_shot(SHOT + f"[solver]\nsubsteps = {substeps}\n")
    cache = simulate(shot, made, moving(turned))
    assert np.abs(cache.points[0] - turned(1, made.locks.points)).max() < 1e-7
    assert np.abs(cache.points[1] - turned(2, made.locks.points)).max() > 1e-5
