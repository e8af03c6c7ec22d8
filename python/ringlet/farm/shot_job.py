"""A whole shot as a job for render farms: groom, rest shapes, simulation, hairs and pictures.

A step that runs again goes on: a simulation from its checkpoints, on any machine that sees the folder.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from ringlet.api.adoption import is_finished_hair
from ringlet.api.shots import input_files, read_shot
from ringlet.data.errors import UserError
from ringlet.data.files import check_place
from ringlet.data.names import distinct
from ringlet.data.reads import recorded
from ringlet.farm.deadline import write_deadline
from ringlet.farm.job import File, Job, Step
from ringlet.farm.openjd import write_openjd
from ringlet.farm.tractor import write_tractor

FARMS: dict[str, Callable[[Path, Job], None]] = {
    ".json": write_openjd,
    ".alf": write_tractor,
    ".deadline": write_deadline,
}


@recorded()
def write_shot_job(
    path: Path | str,
    shot: Path | str,
    *,
    folder: Path | str,
    camera: str,
    groom: Path | str | None = None,
    frames: tuple[int, int] | None = None,
    width: int = 1280,
    samples: int = 40,
    exr: bool = False,
) -> list[str]:
    """Writes a shot, from its groom to its pictures, as a job for a render farm; returns the names of its steps.

    path:    ``.json``, a template of Open Job Description; ``.alf``, a job of Tractor; or ``.deadline``, a folder of
             jobs for Deadline
    folder:  where groom, cache, hairs and pictures go
    camera:  of the pictures, a prim of the stage of the hairs
    groom:   a recipe or a groom in place of the shot's
    frames:  first and last frame of hairs and pictures; by default those of the shot
    width:   pixels across
    samples: light paths of a pixel
    exr:     writes pictures as EXR with all layers, in place of PNG

    Raises UserError for another suffix, for finished hair of other programs, and for a shot that is not valid.
    """
    path = Path(path)
    if path.suffix not in FARMS:
        raise UserError(
            f"{path}: ends in '{path.suffix}'; must end in .json for Open Job Description, .alf for Tractor or "
            ".deadline for Deadline"
        )
    check_place(path)
    values: dict[str, str | int] = {"Camera": camera, "Width": width, "Samples": samples}
    given = None if groom is None else Path(groom)
    job = shot_job(Path(shot), given, Path(folder).absolute(), frames, values, "exr" if exr else "png")
    FARMS[path.suffix](path, job)
    return [step.name for step in job.steps]


def shot_job(
    path: Path,
    given: Path | None,
    folder: Path,
    frames: tuple[int, int] | None,
    values: dict[str, str | int],
    suffix: str,
) -> Job:
    """The job of a shot.

    given:  a recipe or a groom in place of the shot's
    values: ``Camera``, ``Width`` and ``Samples`` of the pictures
    suffix: of the pictures
    """
    shot = read_shot(path)
    source = given or shot.groom
    if is_finished_hair(source):
        raise UserError(f"{source}: is finished hair, not a groom; make a recipe of it first: ringlet adopt {source}")
    files = {
        "Shot": File(path.absolute(), "The shot"),
        "Groom": File(source.absolute(), "The groom"),
        "Cache": File(folder / "cache.usdc", "The simulation of the locks"),
        "Hair": File(folder / "hair.usdc", "All hairs on demand, over the simulation"),
        "Points": File(folder / "points", "Hairs with points, a file for each frame", folder=True),
        "Pictures": File(folder / "pictures", "Pictures, one for each frame", folder=True),
    }
    steps: list[Step] = []
    if source.suffix == ".toml":
        files["Recipe"] = File(source.absolute(), "The recipe of the groom")
        files["Groom"] = File(folder / "groom.usdc", "The groom")
        steps.append(Step("Groom", ["groom", "{Recipe}", "-o", "{Groom}"], ["Recipe"], ["Groom"], 2))
    further = [file for file in input_files(path, source) if file not in (path.resolve(), source.resolve())]
    names = distinct([file.name for file in further])
    files |= {name: File(file, "Read with them") for name, file in zip(names, further, strict=True)}
    locks = ["Shot", "Groom", *names]
    if shot.rest.mode != "none":
        assert shot.rest_file is not None
        files["Rest"] = File(shot.rest_file.absolute(), "The rest shapes")
        steps.append(Step("Rest", ["loft", "{Shot}", "--groom", "{Groom}"], locks, ["Rest"], 24, 4))
        locks = [*locks, "Rest"]
    simulate = ["sim", "{Shot}", "--groom", "{Groom}", "-o", "{Cache}", "--resume"]
    hair = ["hair", "{Groom}", "--cache", "{Cache}", "-o", "{Hair}", "--on-demand"]
    points = ["hair", "{Hair}", "-o", "{Points}/{Frame}.usdc", "--frames", "{Frame}", "--velocities"]
    render = [
        "render",
        "{Hair}",
        "-o",
        f"{{Pictures}}/{{Frame}}.{suffix}",
        "--frame",
        "{Frame}",
        "--camera",
        "{Camera}",
    ]
    render += ["--width", "{Width}", "--samples", "{Samples}"]
    seen = ["Hair", "Cache", "Groom", *names]
    return Job(
        f"Ringlet: {path.name}",
        files,
        values,
        frames or shot.frames,
        [
            *steps,
            Step("Simulate", simulate, locks, ["Cache"], 7 * 24, 8),
            Step("Hair", hair, ["Cache", "Groom", *names], ["Hair"], 24, 4),
            Step("Points", points, seen, ["Points"], 2, 4, by_frame=True),
            Step("Render", render, seen, ["Pictures"], 12, 4, by_frame=True),
        ],
    )
