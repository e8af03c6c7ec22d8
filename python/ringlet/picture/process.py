"""A process of its own for a picture as it grows: it loads the path tracer, takes one task, and sends its steps.

It imports what a picture needs and no more, so that the first step comes soon.
"""

from __future__ import annotations

import io
import os
import pickle
import signal
import sys
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from ringlet.data.camera import Camera
from ringlet.data.errors import UserError, failure
from ringlet.data.picture import PictureSettings
from ringlet.picture.engine import mitsuba
from ringlet.picture.motion import Pose
from ringlet.picture.still import growing

COMMAND = [sys.executable, "-P", "-c", "from ringlet.picture.process import serve; serve()"]


@dataclass(frozen=True)
class RenderTask:
    """A picture to take: what is seen, from where, and how."""

    pose: Pose
    camera: Camera
    settings: PictureSettings


@dataclass(frozen=True)
class RenderStep:
    """A picture as it grows. png: the file; samples: per pixel so far; error: a message in place of a picture."""

    png: bytes = b""
    samples: int = 0
    error: str = ""


def serve() -> None:
    """Reads a pickled ``RenderTask`` from the input, and writes pickled steps to the output; None ends them."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # who started the process ends it
    with os.fdopen(os.dup(sys.stdout.fileno()), "wb") as steps:
        os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # what libraries print is no step

        def send(step: RenderStep | None) -> None:
            pickle.dump(step, steps)
            steps.flush()

        with suppress(UserError):  # without it the task is answered so
            mitsuba()
        try:
            task: RenderTask = pickle.load(sys.stdin.buffer)
        except EOFError:
            return
        try:
            for image, samples in growing(task.pose, task.camera, task.settings):
                send(RenderStep(_png(image), samples))
        except Exception as error:
            send(RenderStep(error=failure("a picture could not be drawn", error)))
        send(None)


def _png(image: Any) -> bytes:
    file = io.BytesIO()
    image.save(file, "PNG", compress_level=1)
    return file.getvalue()
