"""The motion of a shot's locks in words, before a frame is simulated and after."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ringlet import io
from ringlet.api import shots
from ringlet.api.progress import Progress
from ringlet.data.errors import UserError
from ringlet.data.groom import Groom
from ringlet.data.motion import MotionWords
from ringlet.report.motion import columns, plain, rows, write_plot
from ringlet.shot.shot import Shot
from ringlet.sim.motion_words import words_of_shot


def motion_words(
    shot: Shot | Path | str,
    groom: Groom | Path | str | None = None,
    *,
    cache: Path | str | None = None,
    allow_stale: bool = False,
    progress: Progress | None = None,
) -> MotionWords:
    """Bounce, settle, sag and swing of the locks of a shot, from its material, without a simulation.

    groom: in place of the one that the shot names
    cache: a simulation of the shot, to find there what came out
    allow_stale: use a lofted shape although it was made from another groom, material or forces
    """
    shot = shot if not isinstance(shot, str | Path) else shots.read_shot(shot)
    groom = shots.as_simulated(groom or shot.groom, progress)
    contents = shots.contents_of(shot, groom, allow_stale)
    if cache is None:
        return words_of_shot(shot, groom, contents["clip"], contents["rest"])
    with io.open_cache(cache) as file:
        if file.ids.tolist() != groom.locks.ids.tolist() or file.size != len(groom.locks.points):
            raise UserError(
                f"{cache}: its locks are not those of the groom; simulate the shot again, or name its groom"
            )
        frames = (file.points(frame) for frame in file.frames)
        return words_of_shot(shot, groom, contents["clip"], contents["rest"], frames)


def motion_table(motion: MotionWords) -> tuple[list[str], list[list[str]]]:
    """Columns and rows of ``motion_words``: 10 %, median and 90 % of the locks of each group."""
    return columns(motion), rows(motion)


def motion_json(motion: MotionWords) -> dict[str, Any]:
    """The table as plain values, with 10 %, median and 90 % of each word; null where no lock has it."""
    return {"words": plain(motion), "notes": motion.notes}


def plot_motion(motion: MotionWords, path: Path | str, title: str = "motion") -> None:
    """Draws the distribution of each word over the locks of each group, as PNG, SVG or PDF."""
    write_plot(motion, Path(path), title)
