"""The script that checks the import tables of docs/architecture.md, which `tools/lint.sh` runs, reports a violation."""

from __future__ import annotations

import importlib.util
import re
import sys
import tomllib
from importlib.metadata import packages_distributions
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def problems():
    spec = importlib.util.spec_from_file_location("check_architecture", ROOT / "tools/check_architecture.py")
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.problems


@pytest.mark.parametrize(
    ("file", "text", "complaint"),
    [
        ("src/ringlet/energy/bend.h", '#include "ringlet/contact/pairs.h"', "energy may not use contact"),
        ("src/ringlet/dynamics/newton.h", '  #  include "ringlet/energy/bend.h"', "dynamics may not use energy"),
        ("src/ringlet/scene/step.cpp", "#include <iostream>", "no printing"),
        ("src/ringlet/hats/hat.h", "", "'hats' is not a folder"),
        ("python/ringlet/io/usd.py", "from ringlet.picture import still", "io may not use picture"),
        ("python/ringlet/io/usd.py", "from ringlet import _core", "io may not use _core"),
        ("python/ringlet/io/usd.py", "def f():\n    import ringlet.groom.curl", "io may not use groom"),
        ("python/ringlet/cli/groom.py", "from ringlet.groom import make_groom", "cli may not use groom"),
        ("python/ringlet/data/groom.py", "from ringlet.groom.curl import curl", "data may not use groom"),
        ("python/ringlet/sim/run.py", "from ringlet.rest import loft", "sim may not use rest"),
        ("python/ringlet/shot/shot.py", "from ringlet.sim.motion import Motion", "shot may not use sim"),
        ("python/ringlet/hats/hat.py", "", "'hats' is not a folder"),
        ("python/ringlet/viewer/files/document.py", "from ringlet.viewer.show import maps", "files may not use show"),
        (
            "python/ringlet/__init__.pyi",
            "from .sim.motion import Motion\nfrom .picture import still",
            "API may not use picture",
        ),
        ("bench/groom.py", "import ringlet._core", "bench may use the public API only"),
    ],
)
def test_a_forbidden_import_is_reported(problems, tmp_path, file, text, complaint):
    folders = [f"python/ringlet/{name}" for name in ("groom", "picture", "rest", "sim", "viewer/show")]
    for place in ("src/ringlet", "bench", "examples", *folders):
        (tmp_path / place).mkdir(parents=True)
    for module in (
        "__init__",
        "groom/__init__",
        "groom/curl",
        "picture/__init__",
        "rest/__init__",
        "sim/motion",
        "viewer/show/maps",
    ):
        (tmp_path / f"python/ringlet/{module}.py").touch()
    (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
    (tmp_path / file).write_text(text)

    found = problems(tmp_path)

    assert len(found) == 1
    assert found[0].startswith(file)
    assert complaint in found[0]


def test_allowed_imports_are_not_reported(problems, tmp_path):
    for file, text in {
        "src/ringlet/energy/bend.h": '#include "ringlet/geometry/curves.h"\n#include "ringlet/energy/common.h"',
        "python/ringlet/data/curves.py": "from ringlet.data.errors import UserError",
        "python/ringlet/data/errors.py": "",
        "python/ringlet/groom/stack.py": "from ringlet.data.curves import Curves",
        "python/ringlet/io/usd.py": "from ringlet.data.curves import Curves",
        "python/ringlet/__init__.py": "from ringlet.data.curves import Curves",
        "examples/try.py": "import ringlet",
    }.items():
        (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / file).write_text(text)
    assert problems(tmp_path) == []


def test_what_a_test_is_skipped_without_is_a_module_of_a_declared_dependency():
    """A test that asks for a module which no dependency brings is skipped for ever."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    every = [project["dependencies"], *project["optional-dependencies"].values()]
    declared = {re.split(r"[^\w.-]", one)[0].lower() for some in every for one in some}
    texts = [path.read_text() for path in (ROOT / "tests").rglob("*.py")]
    asked = {name for text in texts for name in re.findall(r'(?:importorskip|find_spec)\("(\w+)', text)}
    brought = packages_distributions()
    unknown = {n for n in asked if declared.isdisjoint(d.lower() for d in brought.get(n, [n.replace("_", "-")]))}
    assert len(asked) > 5 and unknown <= sys.stdlib_module_names  # distributions leave out some of these
