"""Shots whose frames take long are announced with the cause before the first step, and long frames while they last."""

from __future__ import annotations

import io
import time

import numpy as np
import pytest
from commands import edit, run
from rich.console import Console
from ringlet.cli import progress
from ringlet.data.curves import Curves
from ringlet.data.groom import Groom
from ringlet.data.mesh import Clip, Mesh
from ringlet.shot import Collider, parse_shot
from ringlet.sim import Obstacle, heavy_work
from ringlet.sim.work import rotations

SHOT = 'ringlet = 2\ngroom = "a.usdc"\nframes = [1, 4]\n'
TRIANGLE = np.array([[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0]])


def turned(degrees: float) -> np.ndarray:
    """The triangle turned about the vertical."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return TRIANGLE @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])


def sentences(text: str = "", apart: float = 5e-3, length: float = 0.05, poses=(TRIANGLE,), bodies=()) -> list[str]:
    """Warnings of a shot of 100 straight locks in a square grid on a head of one triangle."""
    x, z = apart * np.indices((10, 10)).reshape(2, -1)
    up = np.linspace(0.0, length, 20)
    locks = Curves.from_list([np.stack([a + 0 * up, up, b + 0 * up], axis=1) for a, b in zip(x, z, strict=True)])
    groom = Groom(locks, locks, Mesh("head", TRIANGLE, np.array([[0, 1, 2]], np.int32)))
    clip = Clip(np.arange(1.0, len(poses) + 1), np.array(poses), 24.0)
    obstacles = [Obstacle(Mesh("a /a/chair", TRIANGLE + 1.0, groom.scalp.triangles), of, Collider()) for of in bodies]
    return list(heavy_work(parse_shot(SHOT + text), groom, clip, obstacles, (1, 4)))


def test_ordinary_shots_have_no_warning():
    walking = [TRIANGLE + [0.05 * k, 0, 0] for k in range(4)]
    assert sentences() == sentences("[contact]") == sentences("[contact]\nradius = 2.5e-3") == []
    assert sentences(poses=walking) == sentences(poses=[turned(20 * k) for k in range(4)]) == []


def test_a_distance_of_contact_beyond_that_of_the_locks_is_announced_with_the_radius_to_set():
    (said,) = sentences("[contact]\nradius = 0.1")
    assert said.startswith("contact.radius is 0.1 m: each point of a lock has about 1")
    assert said.endswith("Other locks are 5 mm away: set it to about 0.003") or "about 0.002" in said
    assert sentences("[contact]\nradius = 0.1\non = false") == []


@pytest.mark.parametrize(
    ("poses", "words"),
    [
        ([turned(0), turned(180), turned(180)], "frame 2: the head turns by 180° in one frame"),
        ([turned(0), turned(3), turned(93)], "frame 3: the head turns by 90° in one frame"),
        ([TRIANGLE, TRIANGLE, TRIANGLE + [2.0, 0, 0]], "frame 3: the head moves by 2 m in one frame"),
    ],
)
def test_a_motion_that_hair_cannot_follow_is_announced_with_its_frame(poses, words):
    (said,) = sentences(poses=poses)
    assert said.startswith(words) and "see whether its animation" in said
    clip = Clip(np.arange(1.0, len(poses) + 1), np.array(poses) + 1.0, 24.0)
    (said,) = sentences("[contact]", bodies=[clip])
    assert said.startswith(words.replace("the head", "chair"))


def test_locks_that_are_too_short_to_see_are_announced():
    (said,) = sentences(length=1e-10)
    assert said.startswith("100 of 100 locks are shorter than 1 µm, lock 0 is 1e-10 m long") and "unit" in said


def test_rotations_are_those_of_the_points():
    generator = np.random.default_rng(1)
    points = generator.normal(size=(4, 30, 3))
    angles = np.array([0.0, 30.0, 90.0, 179.0])
    c, s = np.cos(np.radians(angles)), np.sin(np.radians(angles))
    turns = np.stack([np.array([[a, 0, b], [0, 1, 0], [-b, 0, a]]) for a, b in zip(c, s, strict=True)])
    np.testing.assert_allclose(rotations(points, points @ turns + [1.0, 2.0, 3.0]), angles, atol=1e-5)
    flat = points * [1.0, 1.0, 0.0]  # of a plane, whose mirror image is a rotation too
    np.testing.assert_allclose(rotations(flat, flat @ turns), angles, atol=1e-5)


def test_the_command_line_prints_warnings_before_the_first_frame_and_in_the_report(copy, monkeypatch):
    monkeypatch.setattr("ringlet.sim.work.MOST_NEIGHBOURS", 0)
    shot = edit(copy / "small.shot.toml", "preroll = 0", "preroll = 0\n[contact]\nradius = 0.06")
    result = run("sim", shot, "-o", copy / "cache.usdc", "--frames", "1:1", "--report", copy / "report")
    assert result.exit_code == 0, result.output
    lines = result.stderr.splitlines()
    (at,) = [k for k, line in enumerate(lines) if line.startswith("warning: contact.radius is 0.06 m")]
    assert any(line.startswith("sim: 1/1") for line in lines[at + 1 :])
    assert "contact.radius is 0.06 m" not in result.stdout
    assert "contact.radius is 0.06 m" in (copy / "report" / "report.html").read_text()


def test_a_long_step_is_reported_while_it_lasts(monkeypatch, capsys):
    monkeypatch.setattr(progress, "LONG_STEP", 0.2)
    with progress.in_lines() as report:
        report("sim", 0, 2)
        time.sleep(0.5)
        report("sim", 1, 2)
        report("sim", 2, 2)
        time.sleep(0.4)
    lines = capsys.readouterr().err.splitlines()
    assert lines[0] == "sim: 0/2, 0 s on the next so far" and lines[-1].startswith("sim: 2/2")
    assert all(line.startswith("sim: 0/2, ") for line in lines[:-1])


def test_a_long_step_is_reported_on_a_terminal(monkeypatch):
    shown = io.StringIO()
    monkeypatch.setattr(progress, "LONG_STEP", 0.0)
    monkeypatch.setattr(progress, "Console", lambda stderr: Console(file=shown, force_terminal=True, width=160))
    with progress.on_terminal() as report:
        report("sim", 1, 2)
    assert "0 s on this one so far" in shown.getvalue()
