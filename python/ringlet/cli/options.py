"""Options that several commands share."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, Literal

import typer

import ringlet


def _use_threads(count: int | None) -> int | None:
    if count is not None:
        ringlet.use_threads(count)
    return count


Threads = Annotated[
    int | None,
    typer.Option(
        "--threads",
        min=1,
        max=ringlet.limits.THREADS,
        callback=_use_threads,
        help="Threads to use; all processors by default.",
        show_default=False,
    ),
]
UNITS = {"mm": 0.001, "cm": 0.01, "dm": 0.1, "m": 1.0, "in": 0.0254, "ft": 0.3048}
Unit = Literal["mm", "cm", "dm", "m", "in", "ft"]
Axis = Literal["Y", "Z"]
FromUnit = Annotated[
    Unit | None,
    typer.Option("--from-unit", help="Unit of a source that stores none; cm for Alembic, else m.", show_default=False),
]
FromUp = Annotated[
    Axis | None, typer.Option("--from-up", help="Up-axis of a source that stores none; Y.", show_default=False)
]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON value instead of text.")]
Report = Annotated[
    Path | None,
    typer.Option(
        "--report", metavar="FOLDER", help="Write report.json and report.html to this folder.", show_default=False
    ),
]
Variant = Annotated[
    str | None,
    typer.Option("--variant", metavar="NAME", help="A variant of the groom file.", show_default=False),
]
ShotFile = Annotated[Path, typer.Argument(metavar="SHOT", help="The shot, a TOML file.")]
GroomOfShot = Annotated[
    Path | None,
    typer.Option("--groom", metavar="GROOM", help="A groom to use in place of the shot's.", show_default=False),
]
AllowStale = Annotated[
    bool,
    typer.Option(
        "--allow-stale",
        help="Use rest shapes although the groom or the settings that they were made from have changed.",
    ),
]
Fraction = Annotated[
    float,
    typer.Option("--fraction", min=0.001, max=1.0, help="Fraction of the hairs to make, for a quick look."),
]
Wider = Annotated[
    bool, typer.Option("--wider", help="With --fraction: wider curves, which cover as much as all of them.")
]


def points_option(help: str) -> Any:
    """The option ``--points`` of a number of points of each curve, none by default."""
    return typer.Option("--points", metavar="N", min=2, max=ringlet.limits.POINTS, help=help, show_default=False)


def locks_option(help: str) -> Any:
    """The option ``--locks`` of a number of locks, none by default."""
    return typer.Option("--locks", metavar="N", min=1, max=1_000_000, help=help, show_default=False)


def frame_option(help: str) -> Any:
    """The option ``--frame`` of one frame, none by default."""
    most = ringlet.limits.FRAME
    return typer.Option("--frame", metavar="F", min=-most, max=most, help=help, show_default=False)


def lock_option(name: str, help: str) -> Any:
    """An option of ids of locks, none by default."""
    most = ringlet.limits.ID
    return typer.Option(name, metavar="LOCK", min=-most, max=most, help=help, show_default=False)


def ending_in(*suffixes: str) -> Callable[[Path | None], Path | None]:
    """Refuses a file that cannot be written, or whose name ends otherwise, before the work for it is done."""

    def checked(path: Path | None) -> Path | None:
        if path is None:
            return None
        if path.suffix not in suffixes:
            allowed = f"{', '.join(suffixes[:-1])} or {suffixes[-1]}"
            raise ringlet.UserError(f"{path}: ends in '{path.suffix}'; must end in {allowed}")
        ringlet.check_place(path)
        return path

    return checked


usd_file, picture_file = ending_in(".usdc", ".usd", ".usda"), ending_in(".png", ".jpg", ".jpeg")
still_file = ending_in(".png", ".jpg", ".jpeg", ".exr")


def usd_output(metavar: str) -> Any:
    """The option ``--output`` of a USD file."""
    return typer.Option("--output", "-o", callback=usd_file, metavar=metavar, help="The USD file to write.")


def parse_frames(text: str) -> tuple[int, int]:
    """``A:B`` as the first and the last frame; ``A`` alone as one frame."""
    first, colon, last = text.partition(":")
    try:
        frames = int(first), int(last if colon else first)
    except ValueError:
        raise ringlet.UserError(f"--frames {text}: must be FIRST:LAST, such as 1:48") from None
    if wrong := ringlet.limits.wrong_frames(*frames):
        raise ringlet.UserError(f"--frames {text}: {wrong}; give FIRST:LAST, such as 1:48")
    return frames


Frames = Annotated[
    Any,
    typer.Option(
        "--frames", metavar="A:B", parser=parse_frames, help="First and last frame; all by default.", show_default=False
    ),
]
