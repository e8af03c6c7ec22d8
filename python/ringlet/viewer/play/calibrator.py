"""Finds the contact of live hair in a process of its own, once the groom has rested."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable

from ringlet.live.calibration import Calibration

REST = 3.0  # time without a change after which it begins [s]
KEPT = 32  # results, of the grooms and materials seen last
NICE = 10  # lower priority of the process
COMMAND = [
    sys.executable,
    "-P",
    "-c",
    "import sys; from ringlet.live.calibration import serve; serve(int(sys.argv[1]))",
]


class Calibrator:
    """Contacts by groom and material. All methods run on the thread that steps the hair, and none waits."""

    def __init__(self) -> None:
        self._made: Callable[[], Calibration] | None = None
        self._due, self._key = 0.0, ""
        self._process: subprocess.Popen[str] | None = None
        self._kept: dict[str, float] = {}

    def change(self, made: Callable[[], Calibration]) -> None:
        """Groom or material is another one, whose calibration a function makes: what is being found is given up."""
        self.stop()
        self._made, self._due = made, time.monotonic() + REST

    def poll(self) -> float | None:
        """The contact of the last change, once, when it is found [N/m²]."""
        if self._made is not None and time.monotonic() >= self._due:
            calibration, self._made = self._made(), None
            self._key = calibration.key
            if self._key in self._kept:
                return self._kept[self._key]
            self._process = _begin(calibration)
        if self._process is None or self._process.poll() is None:
            return None
        found, process, self._process = self._process.communicate()[0], self._process, None
        if process.returncode:  # the default holds
            return None
        self._kept[self._key] = float(found)
        if len(self._kept) > KEPT:
            del self._kept[next(iter(self._kept))]
        return self._kept[self._key]

    def stop(self) -> None:
        """Ends what is being found."""
        self._made = None
        if self._process is not None:
            self._process.kill()
            self._process.communicate()
            self._process = None


def _begin(calibration: Calibration) -> subprocess.Popen[str]:
    """A process at low priority, on one thread, that finds a contact."""
    with tempfile.TemporaryFile() as task:
        pickle.dump(calibration, task)
        task.seek(0)
        environment = {**os.environ, "OMP_NUM_THREADS": "1"}
        process = subprocess.Popen(
            [*COMMAND, str(os.getpid())], stdin=task, stdout=subprocess.PIPE, text=True, env=environment
        )
    if hasattr(os, "setpriority"):
        os.setpriority(os.PRIO_PROCESS, process.pid, os.getpriority(os.PRIO_PROCESS, process.pid) + NICE)
    return process
