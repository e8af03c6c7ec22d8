"""Hostile files are read or refused in one line within bounded time and memory."""

from __future__ import annotations

import sys
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from ringlet.data.toml import to_toml
from ringlet.io import read_curves, read_mesh
from ringlet.io.hair import HEADER

import ringlet

FUZZ = Path(__file__).parents[1] / "fuzz"
sys.path.append(str(FUZZ))
from targets import TARGETS, try_out  # noqa: E402


def settings_of(*schemas: dict) -> list[str]:
    """Names of all settings."""
    tables = [table for schema in schemas for table in (schema, *schema.get("$defs", {}).values())]
    return sorted({name for table in tables for name in table.get("properties", {})})


SETTINGS = settings_of(*ringlet.schema().values())
CORPUS = [pytest.param(file, id=f"{file.parent.name}/{file.name}") for file in sorted((FUZZ / "corpus").glob("*/*"))]


@pytest.mark.parametrize("file", CORPUS)
def test_corpus_files_are_read_or_refused_in_one_line(file, tmp_path):
    try_out(TARGETS[file.parent.name], file.read_bytes(), tmp_path)


def test_every_target_has_a_seed_corpus():
    assert {file.parent.name for file in (FUZZ / "corpus").glob("*/*")} == set(TARGETS)


# Generated input

quick = settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
counts = st.one_of(st.integers(0, 6), st.sampled_from([2**16, 2**31 - 1, 2**31, 2**32 - 1]))
values = st.recursive(
    st.one_of(
        st.booleans(),
        st.integers(),
        st.floats(),
        st.text(st.characters(exclude_categories=["Cs"]), max_size=8),
        st.sampled_from(["5 mm", "lofted", "x.usdc"]),
    ),
    lambda deeper: st.one_of(
        st.lists(deeper, max_size=3), st.dictionaries(st.sampled_from(SETTINGS), deeper, max_size=3)
    ),
    max_leaves=8,
)


@quick
@given(hairs=counts, points=counts, arrays=st.integers(0, 31), segments=counts, body=st.binary(max_size=200))
def test_a_hair_file_of_any_counts_is_refused_or_has_its_counts(tmp_path, hairs, points, arrays, segments, body):
    file = tmp_path / "a.hair"
    file.write_bytes(HEADER.pack(b"HAIR", hairs, points, arrays, segments, 0.1, 0.0, 1.0, 1.0, 1.0, b"") + body)
    tracemalloc.start()
    try:
        curves = read_curves(file)
    except ringlet.UserError as error:
        assert "\n" not in str(error) and "a.hair" in str(error)
    else:
        assert len(curves) == hairs and len(curves.points) == points and np.isfinite(curves.points).all()
    finally:
        _, most = tracemalloc.get_traced_memory()
        tracemalloc.stop()
    assert most < 1_000_000  # whatever counts the header states


@quick
@given(
    points=st.integers(0, 6),
    faces=st.lists(st.lists(st.one_of(st.integers(-8, 8), st.integers()), max_size=6), max_size=6),
    lines=st.lists(st.lists(st.one_of(st.integers(-8, 8), st.integers()), max_size=6), max_size=4),
)
def test_an_obj_of_any_indices_is_refused_or_uses_existing_points(tmp_path, points, faces, lines):
    file = tmp_path / "a.obj"
    text = [f"v {k} {k * k} 0" for k in range(points)]
    text += ["f " + " ".join(map(str, face)) for face in faces] + ["l " + " ".join(map(str, line)) for line in lines]
    file.write_text("\n".join(text))
    for read in (read_mesh, read_curves):
        try:
            made = read(file)
        except ringlet.UserError as error:
            assert "\n" not in str(error) and "a.obj" in str(error)
        else:
            assert len(made.points) and np.isfinite(made.points).all()
            if read is read_mesh:
                assert made.triangles.min() >= 0 and made.triangles.max() < points


@quick
@given(data=st.binary(max_size=500))
@pytest.mark.parametrize("target", ["usd_curves", "usd_mesh"])
def test_usd_of_any_counts_and_offsets_is_refused_or_read(tmp_path, target, data):
    try_out(TARGETS[target], data, tmp_path)


@quick
@given(tables=st.dictionaries(st.sampled_from(SETTINGS), values, max_size=5))
@pytest.mark.parametrize("target", ["recipe", "shot"])
def test_tables_of_any_values_are_refused_in_one_line_or_accepted(tmp_path, target, tables):
    try_out(TARGETS[target], to_toml({"ringlet": 2, **tables}).encode("utf-8", "replace"), tmp_path)
