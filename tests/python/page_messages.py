"""Writes what the review server says to a page that opens the small example: ``python page_messages.py FOLDER``.

Tests of the page without a browser read them: ``small.recipe.bin`` and ``small.shot.bin`` hold the messages in their
order, each after its length as a little-endian ``u4``.
"""

from __future__ import annotations

import struct
import sys
import tempfile
from pathlib import Path

from pages import page, serving
from ringlet.viewer.wire import split
from small_example import write_example


def messages(folder: Path, file: str) -> list[bytes]:
    """All messages until the groom is measured, and until a shot has said which frames there are."""
    awaited = {"measured", "timeline"} if file.endswith(".shot.toml") else {"measured"}
    received: list[bytes] = []
    with serving(folder, file) as client, page(client) as opened:
        while awaited:
            received.append(opened.socket.receive_bytes())
            awaited.discard(split(received[-1])[0]["kind"])
    return received


def main(output: Path) -> None:
    output.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        write_example(Path(folder))
        for name in ("small.recipe", "small.shot"):
            said = messages(Path(folder), f"{name}.toml")
            (output / f"{name}.bin").write_bytes(b"".join(struct.pack("<I", len(one)) + one for one in said))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
