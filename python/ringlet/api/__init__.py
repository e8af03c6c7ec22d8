"""The public functions: what the command line does, for programs.

They follow the data: recipe → groom → cache → hairs → pictures. Heavy libraries are imported where they are used, so
that ``import ringlet`` is quick. ``progress``, wherever it is taken, is called as ``progress(stage, done, total)``.

Each module lists its public names in ``__all__``; they are public in ``ringlet`` too.
"""

from __future__ import annotations

from ringlet.api import (
    adoption,
    convergence,
    conversion,
    demo,
    doctor,
    grooms,
    hairs,
    movies,
    pictures,
    program,
    run,
    shots,
    upgrades,
)
from ringlet.api.adoption import *
from ringlet.api.convergence import *
from ringlet.api.conversion import *
from ringlet.api.demo import *
from ringlet.api.doctor import *
from ringlet.api.grooms import *
from ringlet.api.grooms import groom_inputs as groom_inputs
from ringlet.api.hairs import *
from ringlet.api.movies import *
from ringlet.api.pictures import *
from ringlet.api.program import *
from ringlet.api.progress import OnFrame as OnFrame
from ringlet.api.progress import Progress as Progress
from ringlet.api.run import *
from ringlet.api.shots import *
from ringlet.api.shots import can_resume as can_resume
from ringlet.api.shots import cloths_and_colliders as cloths_and_colliders
from ringlet.api.shots import run_inputs as run_inputs
from ringlet.api.shots import scalp_clip as scalp_clip
from ringlet.api.shots import start_motion as start_motion
from ringlet.api.upgrades import *

__all__: list[str] = []
__all__ += adoption.__all__
__all__ += convergence.__all__
__all__ += conversion.__all__
__all__ += demo.__all__
__all__ += doctor.__all__
__all__ += grooms.__all__
__all__ += hairs.__all__
__all__ += movies.__all__
__all__ += pictures.__all__
__all__ += program.__all__
__all__ += run.__all__
__all__ += shots.__all__
__all__ += upgrades.__all__
