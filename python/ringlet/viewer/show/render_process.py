"""A process that path-traces pictures of what a session shows. It ends at once when it is cancelled."""

from __future__ import annotations

import io
import multiprocessing
import signal
import threading
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Any

from ringlet.data.camera import Camera
from ringlet.data.picture import PictureSettings
from ringlet.picture import Pose
from ringlet.viewer.worker import failure


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


class RenderProcess:
    """A process that has loaded the path tracer and waits for one task.

    The process is spawned, since a forked one would share the threads and locks of the server.
    """

    def __init__(self) -> None:
        context = multiprocessing.get_context("spawn")
        self._connection, there = context.Pipe()
        self._process = context.Process(target=_serve, args=(there,), daemon=True, name="ringlet-render")
        self._process.start()
        there.close()
        self._ended = False

    def run(self, task: RenderTask, seen: Callable[[RenderStep], None]) -> None:
        """Runs the task on a thread; calls ``seen`` there with each step until the task ends or is cancelled."""
        threading.Thread(target=self._run, args=(task, seen), daemon=True, name="render").start()

    def cancel(self) -> None:
        """Ends the process."""
        self._ended = True
        self._process.terminate()

    def _run(self, task: RenderTask, seen: Callable[[RenderStep], None]) -> None:
        try:
            self._connection.send(task)
            while (step := self._connection.recv()) is not None:
                if self._ended:
                    return
                seen(step)
        except (EOFError, OSError):
            if not self._ended:
                seen(RenderStep(error="render: its process ended; a smaller picture needs less memory"))
        finally:
            self._process.join()
            self._connection.close()


def _serve(connection: Connection) -> None:
    """Takes one task in the process, and sends its steps; None ends them."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the server ends its process
    from ringlet import picture
    from ringlet.picture.engine import mitsuba

    mitsuba()
    try:
        task: RenderTask = connection.recv()
    except EOFError:
        return
    try:
        for image, samples in picture.growing(task.pose, task.camera, task.settings):
            connection.send(RenderStep(_png(image), samples))
    except Exception as error:
        connection.send(RenderStep(error=failure("a picture could not be drawn", error)))
    connection.send(None)


def _png(image: Any) -> bytes:
    file = io.BytesIO()
    image.save(file, "PNG", compress_level=1)
    return file.getvalue()
