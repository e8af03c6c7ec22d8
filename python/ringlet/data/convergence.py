"""What a shot keeps of its motion at several settings of its solver."""

from __future__ import annotations

from dataclasses import dataclass

ENOUGH = 0.95  # of the converged motion


@dataclass
class Trial:
    """The same frames at one setting.

    newton, linear_tolerance: the setting (see ``shot/solver.py``)
    motion: of each frame [m] (see ``lock_motion`` in ``sim/convergence.py``)
    tips:   how far the tips are from where they began, relative to the roots, by frame [m]; median over locks
    off:    mean distance of all points from the converged run [m]
    kept:   part of the converged motion
    stretch: the most that an edge was stretched
    cpu_ms: processor time of a frame, median
    """

    newton: int
    linear_tolerance: float
    motion: list[float]
    tips: list[float]
    stretch: float
    cpu_ms: float
    off: float = 0.0
    kept: float = 1.0

    @property
    def name(self) -> str:
        """Its setting in words."""
        return f"{self.newton} to {self.linear_tolerance:g}"


@dataclass
class Convergence:
    """What trials from one state kept of its converged motion.

    frames:    first and last frame that were compared; the state is that of the first
    shipped:   the trial of the shot's own setting
    trials:    those of all settings, by iterations
    converged: the run that they are compared with
    """

    frames: tuple[int, int]
    shipped: Trial
    trials: list[Trial]
    converged: Trial
    enough: float = ENOUGH

    @property
    def advised(self) -> Trial | None:
        """The quickest trial that keeps enough; None where none does."""
        enough = [trial for trial in self.trials if trial.kept >= self.enough]
        return min(enough, key=lambda trial: trial.cpu_ms, default=None)
