"""The whole pipeline on the example, from a recipe to moving curls and a picture of them."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from ringlet import api
from ringlet.api.run import Run
from ringlet.data.share import share

if TYPE_CHECKING:
    from ringlet.shot import Shot

__all__ = ["run_demo"]

FIRST_FRAME = 1  # of the clip; before it the ribbon is put into the hair
STILL_FRAME = 22  # in the middle of the quick turn
STILL_SECONDS = 110.0  # a slow machine gets a noisier picture, not a longer wait
MOVING = 1 / 6  # share of the hairs that move in hair.usdc, which keeps it small; the still has all of them

# The share of each stage in the total time, as measured; only the overall bar depends on it.
SHARES = {"groom": 1, "loft": 2, "simulate": 21, "hairs": 1, "still": 48, "sheet": 27}


def run_demo(folder: Path | str, *, progress: api.Progress | None = None) -> Run:
    """Grooms, simulates and pictures the example; writes everything, and the report, to ``folder``."""
    folder = Path(folder)
    example = share("examples/child")
    groom_file, cache_file, hair_file = folder / "groom.usdc", folder / "cache.usdc", folder / "hair.usdc"
    rest_file, still_file, sheet_file = folder / "ribbon.rest.usdc", folder / "still.png", folder / "sheet.png"
    with Run("demo", folder) as run:
        with run.stage("groom", groom_file, "groom guides over the head"):
            groom = api.build_groom(example / "ribbon.recipe.toml", progress=_overall("groom", progress))
            api.write_groom(groom, groom_file)
            run.count(guides=len(groom.guides), locks=len(groom.locks))
        shot = balanced(api.read_shot(example / "ribbon.shot.toml"), rest_file)
        with run.stage("loft", rest_file, "the shape that guides remember, with which they hang as groomed"):
            api.write_loft(api.loft(shot, groom, progress=_overall("loft", progress)), shot, rest_file)
        with run.stage("simulate", cache_file, "the guides and a ribbon in motion"), _aside(folder) as checkpoints:
            inner = _overall("simulate", progress)
            record = api.write_simulation(shot, groom, groom_file, cache_file, checkpoints=checkpoints, progress=inner)
            run.count(frames=len(record.frames))
            run.simulated(record)
        with run.stage("hairs", hair_file, f"hairs in motion, {MOVING:.0%} of all, each wider"):
            inner, clip = _overall("hairs", progress), (FIRST_FRAME, shot.frames[1])
            api.write_hairs(
                groom_file, hair_file, cache=cache_file, frames=clip, fraction=MOVING, wider=True, progress=inner
            )
        with (
            run.stage("still", still_file, f"frame {STILL_FRAME} with all hairs, path-traced"),
            _aside(folder) as aside,
        ):
            all_hairs = aside / "hair.usdc"
            counts = api.write_hairs(groom_file, all_hairs, cache=cache_file, frames=(STILL_FRAME, STILL_FRAME))
            api.write_still(
                all_hairs,
                still_file,
                frame=STILL_FRAME,
                seconds=STILL_SECONDS,
                progress=_overall("still", progress),
            )
            run.count(hairs=counts["hairs"], points=counts["points"])
            run.pictured(
                still_file, f"Frame {STILL_FRAME}: the head in the middle of a quick turn, a ribbon in the hair."
            )
        with run.stage("sheet", sheet_file, "the clip at a glance"):
            api.write_sheet(
                hair_file, sheet_file, title="A nod, a quick turn and a hop", progress=_overall("sheet", progress)
            )
            run.pictured(sheet_file, "The clip: a nod, a quick turn and a hop.")
    return run


def balanced(shot: Shot, rest_file: Path) -> Shot:
    """The shot with a rest shape in equilibrium, so that its hair hangs as groomed; ``rest_file`` keeps it."""
    return shot.model_copy(update={"rest": shot.rest.model_copy(update={"mode": "equilibrium", "file": rest_file})})


@contextmanager
def _aside(folder: Path) -> Iterator[Path]:
    """A temporary folder beside the files."""
    with tempfile.TemporaryDirectory(dir=folder) as aside:
        yield Path(aside)


def _overall(stage: str, progress: api.Progress | None) -> api.Progress | None:
    """Reports the progress of a stage and, in per cent, of the whole demo."""
    if progress is None:
        return None
    names = list(SHARES)
    before = sum(SHARES[name] for name in names[: names.index(stage)])

    def report(name: str, done: int, total: int) -> None:
        progress("demo", round(before + SHARES[stage] * done / max(total, 1)), 100)
        progress(name, done, total)

    progress("demo", before, 100)
    return report
