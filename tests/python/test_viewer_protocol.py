"""Messages in Python and TypeScript are the same."""

from __future__ import annotations

import sys
from pathlib import Path

TOOLS = Path(__file__).parents[2] / "tools"


def test_the_typescript_is_generated_from_the_python_definition(monkeypatch, capsys):
    monkeypatch.syspath_prepend(TOOLS)
    import make_protocol

    monkeypatch.setattr(sys, "argv", ["make_protocol.py", "--check"])
    assert make_protocol.main() == 0, capsys.readouterr().out
