"""The whole pipeline on the example, from a recipe to moving curls and a picture of them."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from ringlet.api.grooms import build_groom, write_groom
from ringlet.api.hairs import write_hairs
from ringlet.api.pictures import write_sheet, write_still
from ringlet.api.progress import Progress
from ringlet.api.run import Run
from ringlet.api.shots import loft, read_shot, write_loft, write_simulation
from ringlet.data.extras import need
from ringlet.data.share import share
from ringlet.shot import Shot

STILL_FRAME = 39  # just before the top of the hop: ringlets float, and none stands up yet
STILL_SECONDS = 30.0  # a slow machine gets a noisier picture, not a longer wait
TILES = 8  # of the sheet
MOVING = 1 / 12  # share of the hairs that move in hair.usdc, which keeps it small; the still has all of them

# Seconds of each stage, as measured on two cores; only the overall bar depends on them.
SECONDS = {"groom": 0.5, "loft": 2.0, "simulate": 63.0, "still": 60.0, "hairs": 5.0, "sheet": 27.0}
PATHS = 29.0  # seconds of the still that trace paths, and are limited
TRUSTED = 1.0  # seconds of work that say how fast this machine is


def run_demo(
    folder: Path | str, *, progress: Progress | None = None, show: Callable[[Path], None] | None = None
) -> Run:
    """Grooms, simulates and pictures the example; writes everything, and the report, to ``folder``.

    show: called with the still as soon as it is there
    """
    need("mitsuba")
    folder = Path(folder)
    example = share("examples/child")
    groom_file, cache_file, hair_file = folder / "groom.usdc", folder / "cache.usdc", folder / "hair.usdc"
    rest_file, still_file, sheet_file = folder / "ringlets.rest.usdc", folder / "still.png", folder / "sheet.png"
    overall = Overall(progress)
    with Run("demo", folder) as run:
        with run.stage("groom", groom_file, "groom guides over the head"):
            groom = build_groom(example / "ringlets.recipe.toml", progress=overall.of("groom"))
            write_groom(groom, groom_file)
            run.count(guides=len(groom.guides), locks=len(groom.locks))
        shot = with_rest_shape(read_shot(example / "ringlets.shot.toml"), rest_file)
        with run.stage("loft", rest_file, "the shape that guides remember, with which they hang as groomed"):
            write_loft(loft(shot, groom, progress=overall.of("loft")), shot, rest_file)
        with run.stage("simulate", cache_file, "the guides in motion"), _aside(folder) as checkpoints:
            inner = overall.of("simulate")
            record = write_simulation(shot, groom, groom_file, cache_file, checkpoints=checkpoints, progress=inner)
            run.count(frames=len(record.frames))
            run.simulated(record)
        with (
            run.stage("still", still_file, f"frame {STILL_FRAME} with all hairs, path-traced"),
            _aside(folder) as aside,
        ):
            all_hairs = aside / "hair.usdc"
            counts = write_hairs(groom_file, all_hairs, cache=cache_file, frames=(STILL_FRAME, STILL_FRAME))
            write_still(
                all_hairs,
                still_file,
                frame=STILL_FRAME,
                seconds=STILL_SECONDS,
                progress=overall.of("still"),
            )
            run.count(hairs=counts["hairs"], points=counts["points"])
            run.pictured(still_file, f"Frame {STILL_FRAME}: just before the top of the hop, where the ringlets float.")
        if show:
            show(still_file)
        with run.stage("hairs", hair_file, f"hairs in motion, {MOVING:.0%} of all, each wider"):
            inner = overall.of("hairs")
            write_hairs(groom_file, hair_file, cache=cache_file, fraction=MOVING, wider=True, progress=inner)
        with run.stage("sheet", sheet_file, "the clip at a glance"):
            title, inner = "A nod, a quick turn and a hop", overall.of("sheet")
            write_sheet(hair_file, sheet_file, count=TILES, title=title, progress=inner)
            run.pictured(sheet_file, "The clip: a nod, a quick turn and a hop.")
    return run


def with_rest_shape(shot: Shot, rest_file: Path) -> Shot:
    """The shot with its rest shape in ``rest_file``: the folder of the example may not be writable."""
    return shot.model_copy(update={"rest": shot.rest.model_copy(update={"file": rest_file})})


@contextmanager
def _aside(folder: Path) -> Iterator[Path]:
    """A temporary folder beside the files."""
    with tempfile.TemporaryDirectory(dir=folder) as aside:
        yield Path(aside)


class Overall:
    """The progress of the whole demo in per cent of its time: so far, and as it is expected on a machine of this speed.

    The still is limited in time, so a slow machine traces no longer, but fewer paths.
    """

    def __init__(self, progress: Progress | None, clock: Callable[[], float] = time.monotonic) -> None:
        self._progress, self._clock = progress, clock
        self._left = dict(SECONDS)
        self._began = clock()
        self._limited = 0.0  # seconds that the still has taken

    def of(self, stage: str) -> Progress | None:
        """What the stage that begins reports to; those before it are done."""
        if self._progress is None:
            return None
        progress, start = self._progress, self._clock()
        for earlier in list(SECONDS)[: list(SECONDS).index(stage)]:
            self._left[earlier] = 0.0

        def report(name: str, done: int, total: int) -> None:
            if total > 1:
                self._left[stage] = SECONDS[stage] * (1.0 - done / total)
            if stage == "still":
                self._limited = self._clock() - start
            progress("demo", self.percent(), 100)
            progress(name, done, total)

        progress("demo", self.percent(), 100)
        return report

    def percent(self) -> int:
        """Per cent of the expected time that are over; 100 only at the end."""
        taken = self._clock() - self._began
        known = sum(SECONDS[name] - left for name, left in self._left.items() if name != "still")
        slowness = (taken - self._limited + TRUSTED) / (known + TRUSTED)
        beyond = max(slowness * PATHS - STILL_SECONDS, 0.0) / SECONDS["still"]  # what the limit cuts off
        left = sum((slowness - (beyond if name == "still" else 0.0)) * left for name, left in self._left.items())
        return 100 if left == 0.0 else min(99, int(100.0 * taken / (taken + left)))
