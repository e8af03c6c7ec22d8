"""Every number on the command line has bounds, and what exceeds them is refused before any work."""

from __future__ import annotations

import inspect
import os
import subprocess
import sys
from importlib import import_module
from typing import Any, get_args

import numpy as np
import pytest
from commands import refused, run
from ringlet.cli.app import COMMANDS

import ringlet


def numbers(command: str) -> dict[str, Any]:
    """Options of a command that are numbers, by their name on the command line."""
    function, found = getattr(import_module(f"ringlet.cli.{command}"), command), {}
    for parameter in inspect.signature(function, eval_str=True).parameters.values():
        kind, *option = get_args(parameter.annotation) or (Any,)
        if option and {int, float} & {
            kind,
            *get_args(kind),
            *(part for one in get_args(kind) for part in get_args(one)),
        }:
            found[f"--{parameter.name.replace('_', '-')}"] = option[0]
    return found


OPTIONS = {(command, name): option for command in COMMANDS for name, option in numbers(command).items()}


@pytest.mark.parametrize("command", COMMANDS)
def test_every_number_of_a_command_has_finite_bounds(command, tmp_path):
    none = [tmp_path / "none"] * (2 if command == "bench" else command not in ("demo", "doctor", "schema", "validate"))
    for name, option in numbers(command).items():
        assert option.min is not None and option.max is not None and option.max < 1e300
        for value in (f"{2 * option.max + 1:.0f}", "9" * 400, "nan", "many"):
            message = refused(run(command, *none, name, value), f"error: {name}: is ", "; must be ")
            assert "Input" not in message and "should" not in message


def test_numbers_are_found():
    assert {("sim", "--threads"), ("wedge", "--workers"), ("render", "--samples"), ("edit", "--freeze")} <= set(OPTIONS)


def test_counts_of_the_library_have_the_same_bounds(tmp_path):
    with pytest.raises(ringlet.UserError, match="threads is 100000; must be from 1 to 1024"):
        ringlet.use_threads(100_000)
    with pytest.raises(ringlet.UserError, match="workers is 100000; must be from 1 to 256"):
        ringlet.wedge(tmp_path / "a.shot.toml", {}, tmp_path / "out", workers=100_000)


def test_the_environment_cannot_ask_for_more_threads_than_that():
    asked = {**os.environ, "OMP_NUM_THREADS": "100000"}
    command = [sys.executable, "-c", "from ringlet import _core; print(_core.thread_count())"]
    assert subprocess.run(command, env=asked, capture_output=True, text=True, check=True).stdout == "1024\n"


def test_memory_that_runs_out_is_reported_in_one_line(copy, monkeypatch):
    def fill(*_: object, **__: object) -> None:
        np.empty(2**60, np.uint8)

    monkeypatch.setattr(ringlet, "build_groom", fill)
    message = refused(
        run("groom", copy / "small.recipe.toml", "-o", copy / "out.usdc"), "memory ran out", "fewer locks"
    )
    assert "mistake" not in message


def test_warnings_of_libraries_are_not_printed(copy):
    program = "import warnings; from ringlet.cli.app import app; import ringlet.cli.schema as s; "
    program += "import ringlet; ringlet.schema = lambda: warnings.warn('of a library') or {}; app(['schema'])"
    plain = {name: value for name, value in os.environ.items() if name != "RINGLET_DEBUG"}
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, env=plain)
    assert result.stderr == ""
