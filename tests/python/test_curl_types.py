"""The types have the shrinkage and the curvature that docs/curl_types.md says."""

import json
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest

DOCS = Path(__file__).parents[2] / "docs"
sys.path.insert(0, str(DOCS))

import curl_types  # noqa: E402

RECORDED = json.loads((DOCS / "curl_types.json").read_text())
PUBLISHED = tomllib.loads((DOCS / "curl_types.toml").read_text())


@pytest.mark.parametrize("kind", ["2B", "3A", "4B", "4C"])
def test_the_recorded_statistics_are_those_of_the_presets(kind):
    now = curl_types.statistics(curl_types.lock_alone(kind))
    for name, values in RECORDED[kind]["preset"].items():
        assert now[name] == pytest.approx(values, rel=0.02, abs=2e-3)


@pytest.mark.parametrize("which", ["preset", "recipe"])
def test_types_shrink_the_more_the_tighter_they_are_and_as_much_as_is_published(which):
    medians = [RECORDED[kind][which]["shrinkage"][1] for kind in RECORDED]
    assert medians == sorted(medians)
    for kind, (low, high) in PUBLISHED["shrinkage"]["range"].items():
        assert low <= RECORDED[kind][which]["shrinkage"][1] <= high


def test_curvatures_lie_within_those_of_people():
    people, over = PUBLISHED["curvature"]["people"], PUBLISHED["curvature"]["over"]
    kinds = list(RECORDED)
    for name, (first, last) in over.items():
        for kind in kinds[kinds.index(first) : kinds.index(last) + 1]:
            middle = RECORDED[kind]["preset"]["curvature"][1]
            assert people[name][0] <= middle <= people[name][-1], (name, kind)


@pytest.mark.parametrize("kind", ["2A", "2B", "2C"])
def test_hairs_of_wavy_recipes_are_as_curved_as_those_of_people(kind):
    now = curl_types.statistics(
        curl_types.hanging(curl_types.read_recipe(curl_types.TYPES / f"{kind}.recipe.toml"), 12)
    )
    low, *_, high = PUBLISHED["curvature"]["people"]["wavy"]
    assert low <= now["curvature"][1] <= high
    assert now["curvature"] == pytest.approx(RECORDED[kind]["recipe"]["curvature"], rel=0.02, abs=2e-3)


def test_the_measures_are_those_of_a_helix():
    radius, pitch = 5e-3, 6e-3
    turn = np.linspace(0.0, 20.0 * np.pi, 4000)
    helix = np.stack([radius * np.cos(turn), pitch / (2 * np.pi) * turn, radius * np.sin(turn)], axis=1)
    hair = curl_types.Curves.from_list([helix])
    assert curl_types.shrinkage(hair)[0] == pytest.approx(1 - pitch / np.hypot(pitch, 2 * np.pi * radius), abs=1e-3)
    expected = 1e-3 * radius / (radius**2 + (pitch / (2 * np.pi)) ** 2)
    assert curl_types.curvature(hair)[0] == pytest.approx(expected, rel=0.01)
