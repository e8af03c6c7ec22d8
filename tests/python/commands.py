"""Command lines in the process of the tests, and their refusals."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import typer.testing
from ringlet.cli.app import app
from typer.main import get_command
from typer.testing import CliRunner

typer.testing._get_command = cache(get_command)  # made anew for each line, it takes longer than most commands
COMMAND: Any = typer.testing._get_command(app)


def run(*arguments: object):
    """Runs a command line; returns its output and exit code."""
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def refused(result, *words: str) -> str:
    """Asserts that the input was refused in one line without a traceback; returns the line."""
    assert result.exit_code == 2, result.output
    assert result.stdout == ""
    lines = result.stderr.strip().splitlines()
    message = lines[-1]
    assert message.startswith("error: ")
    assert sum(line.startswith("error: ") for line in lines) == 1
    assert "Traceback" not in result.output
    for word in words:
        assert word in message, message
    return message


def edit(file: Path, old: str, new: str) -> Path:
    """Replaces text in a file; returns its path."""
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new, 1))
    return file


def made(folder: Path) -> Path:
    """Writes the groom of the small example; returns its path."""
    assert run("groom", folder / "small.recipe.toml", "-o", folder / "groom.usdc").exit_code == 0
    return folder / "groom.usdc"
