"""Ringlet grooms tightly curled hair and simulates it."""

import os
from importlib.metadata import version

import lazy_loader

# Threads of the core wait for one another actively for so many turns, some microseconds, then sleep. OpenMP reads this
# when the core is loaded, so it stands before all imports of ours: docs/decisions/waiting_threads.md.
if "OMP_WAIT_POLICY" not in os.environ:
    os.environ.setdefault("GOMP_SPINCOUNT", "5000")

__version__ = version("ringlet")
# A name is loaded with its module when it is first asked for, so modules import at their top what they use.
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
__all__ += ["__version__"]
