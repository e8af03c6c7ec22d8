"""Messages in Python and TypeScript are the same."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]


def test_the_typescript_is_generated_from_the_python_definition():
    done = subprocess.run([sys.executable, ROOT / "tools/make_protocol.py", "--check"], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
