"""The command line: help, exit codes, errors in one line, JSON."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from commands import refused, run
from ringlet.cli.app import COMMANDS
from ringlet.cli.progress import shown_progress

import ringlet


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help_with_an_example(command):
    result = run(command, "--help")
    assert result.exit_code == 0
    assert f"ringlet {command}" in result.stdout
    assert "Example" in result.stdout


def test_without_arguments_the_commands_are_listed():
    result = run()
    assert result.exit_code == 0
    assert all(command in result.stdout for command in COMMANDS)


def test_version_has_three_numbers():
    assert run("--version").stdout == f"ringlet {ringlet.__version__}\n"
    assert ringlet.__version__.count(".") == 2


def test_help_imports_no_heavy_library():
    program = "import sys, ringlet.cli; print({'pxr', 'mitsuba', 'matplotlib', 'scipy'} & set(sys.modules))"
    assert subprocess.run([sys.executable, "-c", program], capture_output=True, text=True).stdout == "set()\n"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["simm"], ["simm", "sim"]),
        (["groom", "x.toml", "--outptu", "y"], ["--outptu", "--output"]),
        (["groom"], ["RECIPE"]),
        (["groom", "x.toml", "--threads", "0"], ["--threads"]),
        (["sim", "x.toml", "--frames", "9:1"], ["--frames 9:1", "FIRST:LAST"]),
        (["sim", "x.toml", "--frames", "one"], ["--frames one", "FIRST:LAST"]),
        (["hair", "x.usdc", "--fraction", "2"], ["--fraction"]),
        (["schema", "recipes"], ["recipes", "recipe"]),
        (["bench", "strand"], ["strand", "'strands'"]),
        (["bench", "groom", "--locks"], ["--locks", "VALUE"]),
        (["bench", "groom", "--lokcs", "3"], ["lokcs", "'locks'"]),
        (["validate", "cantilver"], ["cantilver", "'cantilever'"]),
    ],
)
def test_a_usage_error_is_one_line(arguments, words):
    refused(run(*arguments), *words)


def test_an_internal_error_is_one_line_with_the_path_of_its_traceback(monkeypatch):
    def broken(*_, **__):
        raise ZeroDivisionError("no such luck")

    monkeypatch.setattr(ringlet, "schema", broken)
    monkeypatch.delenv("RINGLET_DEBUG", raising=False)
    result = run("schema")
    assert result.exit_code == 3
    message = result.stderr.strip()
    assert len(message.splitlines()) == 1
    assert "no such luck" in message
    file = Path(message.split("traceback is in ")[1].split(",")[0])
    assert "ZeroDivisionError" in file.read_text()
    file.unlink()


def test_debug_shows_the_traceback_of_an_internal_error(monkeypatch):
    def broken(*_, **__):
        raise ZeroDivisionError

    monkeypatch.setattr(ringlet, "schema", broken)
    monkeypatch.delenv("RINGLET_DEBUG", raising=False)
    result = run("--debug", "schema")
    assert result.exit_code == 3
    assert "Traceback" in result.stderr


def test_schemas_are_json_and_describe_every_setting():
    both = json.loads(run("schema").stdout)
    assert set(both) == {"recipe", "shot"}
    recipe = json.loads(run("schema", "recipe").stdout)
    assert recipe == both["recipe"]
    assert all(about.get("description") for about in recipe["properties"].values())


SLOW = """
import signal, sys, time
signal.signal(signal.SIGINT, signal.default_int_handler)  # also when tests run in the background
import ringlet
from ringlet.cli import main

def slow(*_, **__):
    print("ready", flush=True)
    time.sleep(60)

ringlet.run_bench = slow
sys.argv = ["ringlet", "bench", "groom"]
main()
"""


def test_an_interrupt_exits_with_130_and_one_line():
    with subprocess.Popen(
        [sys.executable, "-c", SLOW], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=30)
    assert process.returncode == 130
    assert errors == "error: interrupted\n"


def test_without_a_terminal_progress_is_a_line_per_stage(capsys):
    with shown_progress() as progress:
        for done in range(1, 101):
            progress("groom", done, 100)
        progress("simulate", 1, 1)
    lines = capsys.readouterr().err.splitlines()
    assert [line.split(":")[0] for line in lines] == ["groom", "simulate"]
    assert "100/100" in lines[0]
