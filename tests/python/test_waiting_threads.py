"""Threads that wait for one another sleep after some microseconds, so that other programs get the processor."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

# Reports what the environment holds when the core, and with it OpenMP, is loaded.
PROGRAM = """
import os, sys
class Watch:
    def find_spec(self, name, path=None, target=None):
        if name == "ringlet._core":
            loaded = "libgomp" in open("/proc/self/maps").read()
            print(os.environ.get("GOMP_SPINCOUNT"), os.environ.get("OMP_WAIT_POLICY"), loaded)
sys.meta_path.insert(0, Watch())
import ringlet
ringlet.use_threads(1)
print("libgomp" in open("/proc/self/maps").read())
"""


@pytest.mark.skipif(sys.platform != "linux", reason="reads the maps of the process")
@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ({}, "5000 None False"),
        ({"GOMP_SPINCOUNT": "7"}, "7 None False"),
        ({"OMP_WAIT_POLICY": "active"}, "None active False"),
    ],
)
def test_the_wait_of_threads_is_set_before_the_core_is_loaded(given, expected):
    kept = {name: value for name, value in os.environ.items() if name not in ("GOMP_SPINCOUNT", "OMP_WAIT_POLICY")}
    done = subprocess.run([sys.executable, "-c", PROGRAM], env=kept | given, capture_output=True, text=True, check=True)
    assert done.stdout.split("\n")[:2] == [expected, "True"]
