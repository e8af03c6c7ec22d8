"""Ends of braids and twists: loose, tied with a band, strung with beads, or sealed by a flame."""

from itertools import pairwise

import numpy as np
import pytest
from ringlet.data.groom import SECTION, STRAND_PROFILE, STRAND_RADIUS, TIED
from styles import BRAID, groom, strands_of
from wear import sim

from ringlet import build_groom, io, read_groom, write_groom, write_hairs

TWIST = "[[shape]]\nop = 'twist'\nwidth = 1\n"
CORNROW = "[[shape]]\nop = 'cornrow'\nwidth = 0.9\n"


def ended(end, shape=BRAID, sections="strands = 3"):
    return groom(sections, shape + end, f"points = {360 if shape is CORNROW else 200}")


def held(made):
    """Points of the strands of each section where they are held, and their radii there, shape (strands, k, …)."""
    locks = made.locks
    tied = locks.point[TIED].reshape(len(locks), -1) > 0.5
    radius = np.repeat(locks.curve[STRAND_RADIUS][:, None], tied.shape[1], axis=1)
    if STRAND_PROFILE in locks.curve:
        knots = np.linspace(0.0, 1.0, locks.curve[STRAND_PROFILE].shape[1])
        u = np.linspace(0.0, 1.0, tied.shape[1])
        radius = radius * np.array([np.interp(u, knots, profile) for profile in locks.curve[STRAND_PROFILE]])
    points = locks.points.reshape(len(locks), -1, 3)
    for section in np.unique(locks.curve[SECTION]):
        rows = locks.curve[SECTION] == section
        at = tied[rows][0]
        yield points[rows][:, at], radius[rows][:, at]


def axis_of(mesh):
    """Middle, unit axis and least distance from the axis of a mesh of revolution with 48 points around."""
    middle = mesh.points.mean(axis=0)
    rings = mesh.points.reshape(48, -1, 3).mean(axis=0)
    axis = np.linalg.svd(mesh.points.reshape(48, -1, 3)[:, 0] - rings[0])[2][2]
    off = mesh.points - middle
    away = np.linalg.norm(off - (off @ axis)[:, None] * axis, axis=1)
    return middle, axis, away.min(), np.abs(off @ axis).max()


def is_closed_and_faces_outwards(mesh):
    edges = np.sort(np.concatenate([mesh.triangles[:, [i, (i + 1) % 3]] for i in range(3)]), axis=1)
    a, b, c = (mesh.points[mesh.triangles[:, k]] - mesh.points.mean(axis=0) for k in range(3))
    return (np.unique(edges, axis=0, return_counts=True)[1] == 2).all() and np.sum(a * np.cross(b, c)) > 0.0


@pytest.mark.parametrize(("shape", "strands"), [(BRAID, 3), (TWIST, 2), (CORNROW, 3)])
def test_a_band_is_around_the_strands(shape, strands):
    sections = f"strands = {strands}" + ("\npattern = 'rows'\nsize = 4" if shape is CORNROW else "")
    made = ended("band = 0.15\ncolors = ['#aa2233']", shape, sections)
    sections = np.unique(made.locks.curve[SECTION])
    assert len(made.accessories) == len(sections) > 2
    for accessory, (points, radius) in zip(made.accessories, held(made), strict=True):
        mesh = accessory.mesh
        middle, axis, inner, half = axis_of(mesh)
        off = points - middle
        away = np.linalg.norm(off - (off @ axis)[..., None] * axis, axis=2)
        assert is_closed_and_faces_outwards(mesh) and half < 0.004
        assert (away + radius).max() == pytest.approx(inner, rel=0.05)
        assert (made.locks.point[TIED][accessory.vertices] > 0.0).all()
        assert mesh.color == pytest.approx((0.402, 0.016, 0.033), abs=2e-3)


def test_beads_are_on_the_strands_with_these_in_their_holes():
    made = ended("end = 'bead'\nbead = 1\nbead_length = 0.7\nbeads = 3\ntail = 1\ncolors = ['#ff0000', '#00ff00']")
    assert len(made.accessories) == 3 * len(np.unique(made.locks.curve[SECTION]))
    assert len({accessory.mesh.color for accessory in made.accessories}) == 2
    for k, (points, radius) in enumerate(held(made)):
        beads = [axis_of(accessory.mesh) for accessory in made.accessories[3 * k : 3 * k + 3]]
        middles = np.array([middle for middle, *_ in beads])
        assert [np.linalg.norm(b - a) for a, b in pairwise(middles)] == pytest.approx([0.007, 0.007], rel=1e-3)
        _, axis, inner, half = beads[1]
        assert inner == pytest.approx(0.0025, rel=1e-6) and half == pytest.approx(0.0035, rel=1e-3)
        off = points - middles[1]
        away = np.linalg.norm(off - (off @ axis)[..., None] * axis, axis=2)
        assert np.abs(off @ axis).max() == pytest.approx(0.0105, rel=0.15)
        assert (away + radius).max() < 1.1 * inner
    assert all(is_closed_and_faces_outwards(accessory.mesh) for accessory in made.accessories)


def test_burnt_strands_close_to_a_tip_without_a_tail_and_are_one_there():
    tied, burnt = ended("tail = 2"), ended("end = 'burnt'\ntail = 2\ntie = 0.6")
    assert not burnt.accessories
    for before, after in zip(strands_of(tied.locks), strands_of(burnt.locks), strict=True):
        spread = [np.linalg.norm(one[:, -1] - one[:, -1].mean(axis=0), axis=1).max() for one in (before, after)]
        assert spread[0] > 0.002 and spread[1] < 0.0008
    assert (burnt.locks.point[TIED].reshape(len(burnt.locks), -1)[:, -5:] == 1.0).all()
    for points, radius in held(burnt):
        least = min(np.linalg.norm(points[a] - points[b], axis=1).min() for a, b in ((0, 1), (1, 2), (0, 2)))
        assert least > 1.2 * radius[:, -1].max()  # thinner as they come together


def test_a_loose_end_is_held_by_nothing():
    assert not ended("end = 'loose'").locks.point.get(TIED, np.zeros(1)).any()


def test_beads_follow_their_braid_in_a_shot(copy):
    recipe = copy / "small.recipe.toml"
    braid = "[locks.sections]\nsize = 12\nstrands = 3\n[[shape]]\nop = 'braid'\nend = 'bead'\nwidth = 0.8\ntail = 0.5\n"
    text = recipe.read_text().replace("count = 8\npoints = 40", "points = 120").replace("length = 5", "length = 8")
    recipe.write_text(text[: text.index("[curl]")] + braid + text[text.index("[hairs]") :])
    write_groom(build_groom(recipe), copy / "groom.usdc")
    result = sim(copy)
    assert result.exit_code == 0, result.output
    write_hairs(copy / "groom.usdc", copy / "hair.usdc", cache=copy / "cache.usdc")
    assert io.problems(copy / "hair.usdc") == []
    made, cache = read_groom(copy / "groom.usdc"), io.read_cache(copy / "cache.usdc")
    bodies = {body.prim.split("/")[-1]: body.clip for body in io.read_stage(copy / "hair.usdc")[0]}
    assert len(made.accessories) > 1
    for accessory in made.accessories:
        clip = bodies[accessory.mesh.name.split("/")[-1]]
        for points, frame in zip(cache.points, cache.frames, strict=True):
            middle = [at.mean(axis=0) for at in (clip.at(frame), points[accessory.vertices])]
            rest = [at.mean(axis=0) for at in (accessory.mesh.points, made.locks.points[accessory.vertices])]
            away = np.linalg.norm(middle[0] - middle[1]), np.linalg.norm(rest[0] - rest[1])
            assert away[0] == pytest.approx(away[1], abs=2e-5)
        assert np.abs(clip.at(cache.frames[-1]) - accessory.mesh.points).max() > 1e-3  # it moved
