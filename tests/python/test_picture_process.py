"""The process that path-traces a picture in place."""

import pickle
import subprocess
import sys

from ringlet.picture.process import COMMAND

HEAVY = {"fastapi", "pxr", "scipy.linalg", "scipy.ndimage", "scipy.optimize", "scipy.spatial", "ringlet.viewer"}


def test_it_imports_little_before_its_first_picture():
    program = f"import sys, ringlet.picture.process; print({HEAVY!r} & set(sys.modules))"
    assert subprocess.run([sys.executable, "-c", program], capture_output=True, text=True).stdout == "set()\n"


def test_it_ends_with_its_input():
    done = subprocess.run(COMMAND, input=b"", capture_output=True, timeout=60)
    assert (done.returncode, done.stdout, done.stderr) == (0, b"", b"")


def test_what_is_no_task_is_reported_as_an_error():
    steps = subprocess.run(COMMAND, input=pickle.dumps("no task"), capture_output=True, timeout=60).stdout
    assert "ValueError" in pickle.loads(steps).error
