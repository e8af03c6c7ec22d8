"""Fixtures of several test files."""

from pathlib import Path

import pytest
from small_example import write_example


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A project with a small recipe and a shot of it."""
    return write_example(tmp_path / "project")
