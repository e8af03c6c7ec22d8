"""A process that path-traces pictures of what a session shows. It ends at once when it is cancelled."""

from __future__ import annotations

import pickle
import subprocess
import threading
from collections.abc import Callable

from ringlet.picture.process import COMMAND, RenderStep, RenderTask


class RenderProcess:
    """A process that loads the path tracer and waits for one task.

    It is started anew, since a forked one would share the threads and locks of the server.
    """

    def __init__(self) -> None:
        self._process = subprocess.Popen(COMMAND, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self._ended = False

    def run(self, task: RenderTask, seen: Callable[[RenderStep], None]) -> None:
        """Runs the task on a thread; calls ``seen`` there with each step until the task ends or is cancelled."""
        threading.Thread(target=self._run, args=(task, seen), daemon=True, name="render").start()

    def cancel(self) -> None:
        """Ends the process."""
        self._ended = True
        self._process.kill()

    def _run(self, task: RenderTask, seen: Callable[[RenderStep], None]) -> None:
        assert self._process.stdin is not None and self._process.stdout is not None
        try:
            with self._process.stdin as there:
                pickle.dump(task, there)
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
