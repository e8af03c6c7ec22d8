"""A process that path-traces pictures of what a session shows. It ends at once when it is cancelled."""

from __future__ import annotations

import pickle
import subprocess
import threading
from collections.abc import Callable, Iterable

from ringlet.data.camera import Camera
from ringlet.data.errors import UserError
from ringlet.data.picture import PictureSettings
from ringlet.picture import Pose
from ringlet.picture.process import COMMAND, RenderStep


class RenderProcess:
    """A process that loads the path tracer and waits for one picture to take.

    It is started anew, since a forked one would share the threads and locks of the server.
    """

    def __init__(self) -> None:
        self._process = subprocess.Popen(COMMAND, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self._ended = False

    def run(
        self, poses: Iterable[Pose], camera: Camera, settings: PictureSettings, seen: Callable[[RenderStep], None]
    ) -> None:
        """Takes a picture, and calls ``seen`` with each step of it until it ends or is cancelled.

        poses: those of ``growing``, which are made on a thread
        """
        threading.Thread(target=self._feed, args=(poses, camera, settings, seen), daemon=True, name="pose").start()
        threading.Thread(target=self._run, args=(seen,), daemon=True, name="render").start()

    def cancel(self) -> None:
        """Ends the process."""
        self._ended = True
        self._process.kill()

    def _feed(
        self, poses: Iterable[Pose], camera: Camera, settings: PictureSettings, seen: Callable[[RenderStep], None]
    ) -> None:
        assert self._process.stdin is not None
        try:
            with self._process.stdin as there:
                pickle.dump((camera, settings), there)
                for pose in poses:
                    pickle.dump(pose, there)
                    there.flush()
        except OSError:
            return  # it has ended, which its steps tell
        except UserError as error:
            if not self._ended:
                seen(RenderStep(error=str(error)))
            self.cancel()

    def _run(self, seen: Callable[[RenderStep], None]) -> None:
        assert self._process.stdout is not None
        try:
            with self._process.stdout as steps:
                while (step := pickle.load(steps)) is not None:
                    if self._ended:
                        return
                    seen(step)
        except (EOFError, OSError, pickle.UnpicklingError):
            if not self._ended:
                seen(RenderStep(error="render: its process ended; a smaller picture needs less memory"))
        finally:
            self._process.wait()
