"""A process of its own for a picture as it grows: it loads the path tracer, takes one picture, and sends its steps.

It imports what a picture needs and no more, so that the first step comes soon.
"""

from __future__ import annotations

import io
import os
import pickle
import signal
import sys
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from ringlet.data.errors import UserError, failure
from ringlet.picture.engine import mitsuba
from ringlet.picture.motion import Pose
from ringlet.picture.still import growing

COMMAND = [sys.executable, "-P", "-c", "from ringlet.picture.process import serve; serve()"]


@dataclass(frozen=True)
class RenderStep:
    """A picture as it grows. png: the file; samples: per pixel so far; error: a message in place of a picture."""

    png: bytes = b""
    samples: int = 0
    error: str = ""


def serve() -> None:
    """Takes a picture of what the input says, and writes pickled steps to the output; None ends them.

    The input is pickled: the camera with the settings, then the poses of ``growing``.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # who started the process ends it
    with os.fdopen(os.dup(sys.stdout.fileno()), "wb") as steps:
        os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # what libraries print is no step

        def send(step: RenderStep | None) -> None:
            pickle.dump(step, steps)
            steps.flush()

        with suppress(UserError):  # without it the task is answered so
            mitsuba()
        try:
            camera, settings = pickle.load(sys.stdin.buffer)
            for image, samples in growing(_poses(), camera, settings):
                send(RenderStep(_png(image), samples))
        except EOFError:
            return
        except Exception as error:
            send(RenderStep(error=failure("a picture could not be drawn", error)))
        send(None)


def _poses() -> Iterator[Pose]:
    while True:
        yield pickle.load(sys.stdin.buffer)


def _png(image: Any) -> bytes:
    file = io.BytesIO()
    image.save(file, "PNG", compress_level=1)
    return file.getvalue()
