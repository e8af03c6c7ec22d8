"""``ringlet serve``: Ringlet as a process next to another program."""

from __future__ import annotations

import os
import sys

import ringlet
from ringlet.cli.options import Threads


def serve(threads: Threads = None) -> None:
    """Serves requests of another program, such as Blender, over standard input and output.

    The messages are in docs/host.md. It ends with its input.

    Example: ringlet serve --threads 2
    """
    with os.fdopen(os.dup(sys.stdout.fileno()), "wb") as answers:
        os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # what libraries print is no answer
        ringlet.serve(sys.stdin.buffer, answers)
