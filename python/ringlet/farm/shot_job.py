"""A whole shot as a job of Open Job Description, for render farms: groom, rest shapes, simulation, hairs and pictures.

Each is a step, which runs when those before it are done; pictures have a task for each frame. A step that runs again
goes on: a simulation from its checkpoints, on any machine that sees the folder. Specification: as for ``openjd``.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ringlet.api.shots import read_shot
from ringlet.farm.openjd import job, path_parameter, script, value_parameter, write_job
from ringlet.shot import Shot

FOLDER = "{{Param.Folder}}"
GROOM, CACHE, HAIR = (f"{FOLDER}/{name}.usdc" for name in ("groom", "cache", "hair"))
HOUR = 3600  # [s]
PROGRESS = {"RINGLET_PROGRESS": "openjd"}  # tells the command to print its progress as farms read it


def write_shot_template(path: Path | str, shot: Path | str) -> list[str]:
    """Writes a shot as a template of Open Job Description, as JSON; returns the names of its steps.

    Raises UserError for a path that does not end in .json, and for a shot that is not valid.
    """
    made = template(read_shot(Path(shot)))
    write_job(Path(path), made)
    return [step["name"] for step in made["steps"]]


def template(shot: Shot) -> dict[str, Any]:
    """The job template as plain values."""
    assert shot.path is not None
    made = shot.groom.suffix == ".toml"
    groom = GROOM if made else "{{Param.Groom}}"
    steps: list[dict[str, Any]] = []

    def add(name: str, words: list[str], hours: int, **more: Any) -> None:
        step = {"name": name, "script": script(words, timeout=hours * HOUR), **more}
        if steps:
            step["dependencies"] = [{"dependsOn": steps[-1]["name"]}]
        steps.append(step)

    if made:
        add("Groom", ["groom", "{{Param.Groom}}", "-o", groom], 2)
    if shot.rest.mode != "none":
        add("Rest", ["loft", "{{Param.Shot}}", "--groom", groom], 24, **needs(4))
    simulate = ["sim", "{{Param.Shot}}", "--groom", groom, "-o", CACHE, "--resume"]
    add("Simulate", simulate, 7 * 24, **needs(8))
    add("Hair", ["hair", groom, "--cache", CACHE, "-o", HAIR, "--fraction", "{{Param.Fraction}}"], 24, **needs(4))
    frame = {"name": "Frame", "type": "INT", "range": "{{Param.Frames}}"}
    picture = f"{FOLDER}/frames/{{{{Task.Param.Frame}}}}.{{{{Param.Format}}}}"
    render = ["render", HAIR, "--frame", "{{Task.Param.Frame}}", "-o", picture, "--camera", "{{Param.Camera}}"]
    render += ["--width", "{{Param.Width}}", "--samples", "{{Param.Samples}}"]
    add("Render", render, 12, parameterSpace={"taskParameterDefinitions": [frame]}, **needs(4))
    first, last = shot.frames
    parameters = [
        path_parameter("Groom", "FILE", "IN", "The recipe, or the groom, of the shot"),
        path_parameter("Folder", "DIRECTORY", "INOUT", "Where groom, cache, hairs and frames go"),
        value_parameter("Camera", "STRING", "The prim of the camera, among those of the head's file"),
        value_parameter(
            "Frames", "STRING", "Frames of the pictures, such as 1-24 or 1-24:2", default=f"{first}-{last}"
        ),
        value_parameter("Format", "STRING", "Of the pictures", default="png", allowedValues=["png", "exr"]),
        value_parameter("Width", "INT", "Pixels across", default=1280, minValue=1),
        value_parameter("Samples", "INT", "Light paths of a pixel", default=40, minValue=1),
        value_parameter("Fraction", "FLOAT", "Of the hairs to make", default=1.0, minValue=0.001, maxValue=1.0),
    ]
    return job(shot.path, parameters, steps, jobEnvironments=[{"name": "Progress", "variables": PROGRESS}])


def needs(processors: int) -> dict[str, Any]:
    """A host with at least so many processors, and 2 GiB of memory for each."""
    amounts = {"amount.worker.vcpu": processors, "amount.worker.memory": 2048 * processors}
    return {"hostRequirements": {"amounts": [{"name": name, "min": least} for name, least in amounts.items()]}}
