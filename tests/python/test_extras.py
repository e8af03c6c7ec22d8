"""Ringlet without the packages of its extras: it grooms and simulates, and what needs one says which."""

from __future__ import annotations

import json
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from ringlet.data.extras import EXTRAS
from small_example import write_example

# Every package that an extra brings, some with those on which they depend.
ABSENT = [*EXTRAS, "drjit", "starlette", "pyoidn", "alembic3d", "imageio_ffmpeg", "distributed", "PyOpenColorIO"]
SHOT = "small.shot.toml"
PROGRAM = """
import json, sys
sys.modules.update(dict.fromkeys(json.loads(sys.argv[1])))  # an import of these fails
from typer.testing import CliRunner
from ringlet.cli.app import app
results = [CliRunner().invoke(app, line.split()) for line in sys.stdin.read().splitlines()]
print(json.dumps([[one.exit_code, one.stderr] for one in results]))
"""


def run_without_extras(folder: Path, lines: list[str]) -> list[tuple[int, str]]:
    """Exit code and error stream of command lines in a process in which no extra is installed."""
    command = [sys.executable, "-c", PROGRAM, json.dumps(ABSENT)]
    done = subprocess.run(command, input="\n".join(lines), capture_output=True, text=True, cwd=folder)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    """The small example with groom, cache and hairs, all of them made without an extra."""
    folder = tmp_path_factory.mktemp("small")
    write_example(folder)
    lines = [
        "groom small.recipe.toml -o groom.usdc",
        f"sim {SHOT} --groom groom.usdc -o cache.usdc --report report",
        "hair groom.usdc --cache cache.usdc -o hair.usdc",
        "convert hair.usdc hair.hair",
        "check groom.usdc",
        f"motion {SHOT}",
        f"wedge {SHOT} --set solver.newton=1 -o wedge --here --no-picture",
        f"farm {SHOT} --camera /groom/body/camera -o shot.json",
        "doctor",
    ]
    for line, (code, errors) in zip(lines, run_without_extras(folder, lines), strict=True):
        assert code == 0, f"{line}: {errors}"
    return folder


def test_what_needs_an_extra_names_it_in_a_line(folder):
    refused = {
        "render hair.usdc -o a.png": "pictures",
        "render hair.usdc --sheet -o a.png": "pictures",
        "movie hair.usdc -o frames": "pictures",
        "turntable hair.usdc -o turned": "pictures",
        "demo -o demo": "pictures",
        f"wedge {SHOT} --set solver.newton=1 -o drawn --here": "pictures",
        "check groom.usdc --picture a.png": "pictures",
        f"motion {SHOT} --plot a.png": "pictures",
        "view small.recipe.toml": "review",
        "convert hair.usdc a.abc": "alembic",
        f"wedge {SHOT} --set solver.newton=1 -o spread --no-picture": "farm",
    }
    for (line, extra), (code, errors) in zip(refused.items(), run_without_extras(folder, [*refused]), strict=True):
        said = [one for one in errors.splitlines() if one.startswith("error: ")]
        assert code == 2 and len(said) == 1, f"{line}: {errors}"
        assert f"pip install 'ringlet[{extra}]'" in said[0]
    assert not (folder / "demo").exists() and not (folder / "drawn").exists()  # refused before the work


def test_each_package_is_among_those_of_its_extra():
    project = tomllib.loads(Path(__file__).parents[2].joinpath("pyproject.toml").read_text())["project"]
    for package, extra in EXTRAS.items():
        assert any(one.startswith(package) for one in project["optional-dependencies"][extra])
        assert not any(one.startswith(package) for one in project["dependencies"])
