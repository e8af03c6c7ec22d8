"""Garments of the example: files equal the output of their scripts, without intersections, and their shots run."""

import sys
from pathlib import Path

import numpy as np
import pytest
from ringlet.sim.penetration import edge_triangle_intersections, mesh_edges

import ringlet
from ringlet import io

CHILD = Path(__file__).parents[2] / "examples" / "child"
GARMENTS = ("scarf", "hat", "tie", "ribbon")


def self_intersections(points, triangles):
    """Intersections of edges and triangles of a mesh that share no vertex."""
    edges = mesh_edges(triangles)
    pairs = edge_triangle_intersections(points[edges], points[triangles])
    return pairs[~(edges[pairs[:, 0], :, None] == triangles[pairs[:, 1], None, :]).any(axis=(1, 2))]


@pytest.mark.parametrize("name", GARMENTS)
def test_a_garment_is_a_valid_cloth_mesh(name):
    mesh = io.read_body(CHILD / f"{name}.usdc").mesh
    assert not len(self_intersections(mesh.points, mesh.triangles))
    sides = mesh.points[mesh.triangles] - mesh.points[np.roll(mesh.triangles, 1, axis=1)]
    areas = 0.5 * np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    assert areas.min() > 0.1 * np.median(areas)
    assert (CHILD / f"{name}.usdc").stat().st_size < 100e3
    assert io.problems(CHILD / f"{name}.usdc") == []


@pytest.mark.parametrize("name", GARMENTS)
def test_a_garment_equals_the_output_of_its_script(name, tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(str(CHILD))
    monkeypatch.setattr(sys, "argv", [f"make_{name}.py", "-o", str(tmp_path / "made.usdc")])
    __import__(f"make_{name}").main()
    made, kept = (io.read_body(path).mesh for path in (tmp_path / "made.usdc", CHILD / f"{name}.usdc"))
    assert (made.triangles == kept.triangles).all()
    assert np.abs(made.points - kept.points).max() < 1e-6


@pytest.mark.parametrize("name", GARMENTS)
def test_a_garment_shot_runs_without_new_intersections(name):
    shot = ringlet.read_shot(CHILD / f"{name}.shot.toml").model_copy(update={"preroll": 0})
    groom = ringlet.build_groom(shot.groom)
    first = shot.frames[0]
    cache = ringlet.simulate(shot, groom, frames=(first, first + 1))
    assert cache.start["inside"] == []
    (cloth,) = cache.cloths
    triangles = io.read_body(cloth.file).mesh.triangles
    initial = sum(found["places"] for found in cache.start["piercing"] if found["what"] == "locks")
    locks = groom.locks
    segments = np.delete(np.arange(len(locks.points) - 1), locks.offsets[1:-1] - 1)[:, None] + [0, 1]
    for k, statistics in enumerate(cache.statistics):
        points = cloth.points[k].astype(float)
        assert not len(self_intersections(points, triangles))
        through = edge_triangle_intersections(cache.points[k].astype(float)[segments], points[triangles])
        assert len(through) <= initial  # initial intersections persist
        if k == 0:
            continue  # without a step
        assert statistics["contact"]["lag"] == 0.0 and statistics["nan"] == 0
        # A cloth that is scaled below its mesh starts with that stretch.
        initial_stretch = 1.0 / shot.cloth[0].scale(cache.frames[k]) - 1.0
        assert statistics["cloth"][cloth.name]["max_stretch"] < initial_stretch + 0.3
