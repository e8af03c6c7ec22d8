"""Fixtures of several test files."""

import json
from pathlib import Path

import pytest
from commands import run
from small_example import write_example
from wear import SCARF, write_wear


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A project with a small recipe and a shot of it."""
    return write_example(tmp_path / "project")


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    """A fresh copy of the small example."""
    return write_example(tmp_path)


@pytest.fixture(scope="session")
def pipeline(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The small example with its groom, cache and hairs, and the JSON that the commands print."""
    folder = write_example(tmp_path_factory.mktemp("pipeline"))
    groom, cache = folder / "groom.usdc", folder / "cache.usdc"
    for result in (
        run("groom", folder / "small.recipe.toml", "-o", groom, "--json"),
        run("sim", folder / "small.shot.toml", "--groom", groom, "-o", cache, "--json"),
        run("hair", groom, "--cache", cache, "-o", folder / "hair.usdc", "--json"),
    ):
        assert result.exit_code == 0, result.output
        output = json.loads(result.stdout)
        (folder / f"{Path(output['path']).stem}.json").write_text(result.stdout)
    return folder


@pytest.fixture(scope="module")
def cloth_example(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The small example with its groom and a sheet over its head."""
    folder = write_example(tmp_path_factory.mktemp("cloth"))
    write_wear(folder)
    shot = folder / "small.shot.toml"
    shot.write_text(shot.read_text() + SCARF)
    assert run("groom", folder / "small.recipe.toml", "-o", folder / "groom.usdc").exit_code == 0
    return folder
