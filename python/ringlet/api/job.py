"""Long work that is watched, and may be cancelled, from elsewhere."""

from __future__ import annotations


class Cancelled(Exception):
    """Work ended since its ``Job`` was cancelled; checkpoints and files that were there stay."""


class Job:
    """How far long work is; pass it as ``progress``. From another thread or a notebook it is read, and cancelled.

    Example::

        job = ringlet.Job()
        work = threading.Thread(target=ringlet.build_groom, args=("curls.recipe.toml",), kwargs={"progress": job})
        work.start()
        print(job)
        job.cancel()

    stage: what is done now, such as ``curl`` or ``sim``; empty before it begins
    done:  steps of the stage that are done, of ``total``
    """

    def __init__(self) -> None:
        self.stage, self.done, self.total = "", 0, 0
        self._cancelled = False

    @property
    def fraction(self) -> float:
        """The part of the stage that is done, from 0 to 1."""
        return self.done / self.total if self.total else 0.0

    def cancel(self) -> None:
        """Ends the work at its next step, which raises ``Cancelled`` there."""
        self._cancelled = True

    def __call__(self, stage: str, done: int, total: int) -> None:
        """Takes a step of the work; raises ``Cancelled`` after ``cancel``."""
        self.stage, self.done, self.total = stage, done, total
        if self._cancelled:
            raise Cancelled(f"cancelled in {stage}, after {done} of {total}")

    def __repr__(self) -> str:
        return f"Job({self.stage or 'not begun'}: {self.done} of {self.total})"

    def _repr_html_(self) -> str:
        return f'{self.stage} <progress value="{self.done}" max="{max(self.total, 1)}"></progress>'
