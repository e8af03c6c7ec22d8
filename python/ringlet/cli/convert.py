"""``ringlet convert``: hair from one file format to another."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

import typer

import ringlet
from ringlet.cli.options import (
    UNITS,
    Axis,
    Frames,
    FromUnit,
    FromUp,
    Json,
    Threads,
    Unit,
    Wider,
    frame_option,
    points_option,
)
from ringlet.cli.output import wrote


def convert(
    source: Annotated[Path, typer.Argument(metavar="IN", help="USD, .abc, .hair, .tfx, or .obj with polylines.")],
    target: Annotated[Path, typer.Argument(metavar="OUT", help="The file to write; its suffix names the format.")],
    unit: Annotated[
        Unit | None, typer.Option("--unit", help="Unit of OUT; cm for Alembic, else that of IN.", show_default=False)
    ] = None,
    up: Annotated[
        Axis | None, typer.Option("--up", help="Up-axis of OUT; Y for Alembic, else that of IN.", show_default=False)
    ] = None,
    from_unit: FromUnit = None,
    from_up: FromUp = None,
    frames: Frames = None,
    frame: Annotated[int | None, frame_option("One frame, in place of --frames.")] = None,
    only: Annotated[
        Literal["hairs", "guides"] | None,
        typer.Option("--only", help="Leave the other curves out.", show_default=False),
    ] = None,
    bodies: Annotated[bool, typer.Option("--bodies/--no-bodies", help="Write the head and other surfaces.")] = True,
    fraction: Annotated[
        float, typer.Option("--fraction", min=0.0001, max=1.0, help="Fraction of the curves to keep.")
    ] = 1.0,
    wider: Wider = False,
    points: Annotated[int | None, points_option("Points of each curve, evenly spaced along it.")] = None,
    unreal: Annotated[
        bool,
        typer.Option("--unreal", help="Write an archive that Unreal imports as a groom."),
    ] = False,
    deformable: Annotated[
        Path | None,
        typer.Option(
            "--deformable",
            metavar="SHOT",
            help="Write elastic rods of the material of this shot, in the schema that Newton imports.",
            show_default=False,
        ),
    ] = None,
    as_json: Json = False,
    threads: Threads = None,
) -> None:
    """Converts hair between USD, Alembic, .hair, TressFX .tfx and OBJ, and reports what the format cannot hold.

    Examples: ringlet convert hair.usdc hair.abc --unreal · ringlet convert mohawk.tfx mohawk.usdc --from-unit cm
    """
    if frame is not None:
        if frames is not None:
            raise ringlet.UserError(f"--frame {frame}: does not go together with --frames; leave one of them out")
        frames = (frame, frame)
    done: dict[str, Any] = ringlet.convert(
        source,
        target,
        source_unit=UNITS[from_unit] if from_unit else None,
        source_up=from_up,
        unit=UNITS[unit] if unit else None,
        up=up,
        only=only,
        bodies=bodies,
        frames=frames,
        fraction=fraction,
        wider=wider,
        points=points,
        unreal=unreal,
        deformable=deformable,
    )
    counts = {name: done[name] for name in ("hairs", "guides", "points", "bodies", "frames")}
    if as_json:
        wrote(target, counts, True, unit=done["unit"], up=done["up"], lost=done["lost"])
        return
    wrote(target, counts, False)
    names = {length: name for name, length in UNITS.items()}
    print(f"in {names.get(done['unit'], format(done['unit'], 'g') + ' m')}, {done['up']} up")
    for sentence in done["lost"]:
        print(f"lost: {sentence}")
