"""A whole shot as a job of Open Job Description, for render farms: groom, rest shapes, simulation, hairs and pictures.

Each is a step, which runs when those before it are done; pictures have a task for each frame. A step that runs again
goes on: a simulation from its checkpoints, on any machine that sees the folder. Specification: as for ``openjd``.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ringlet.api.shots import read_shot
from ringlet.farm.openjd import MAX_NAME, VERSION, path_parameter, write_job
from ringlet.shot import Shot

FOLDER = "{{Param.Folder}}"
GROOM, CACHE, HAIR = (f"{FOLDER}/{name}.usdc" for name in ("groom", "cache", "hair"))
HOUR = 3600  # [s]
PROGRESS = {"RINGLET_PROGRESS": "openjd"}  # tells the command to print its progress as farms read it


def write_shot_template(path: Path | str, shot: Path | str) -> list[str]:
    """Writes a shot as a template of Open Job Description, as JSON; returns the names of its steps.

    Raises UserError for a path that does not end in .json, and for a shot that is not valid.
    """
    job = template(read_shot(Path(shot)))
    write_job(Path(path), job)
    return [step["name"] for step in job["steps"]]


def template(shot: Shot) -> dict[str, Any]:
    """The job template as plain values."""
    assert shot.path is not None
    made = shot.groom.suffix == ".toml"
    groom = GROOM if made else "{{Param.Groom}}"
    steps: list[dict[str, Any]] = []

    def add(name: str, words: list[str], hours: int, **more: Any) -> None:
        action = {"command": "{{Param.Ringlet}}", "args": words, "timeout": hours * HOUR}
        step = {"name": name, "script": {"actions": {"onRun": action}}, **more}
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
    return {
        "specificationVersion": VERSION,
        "name": f"Ringlet: {shot.path.name}"[:MAX_NAME],
        "parameterDefinitions": [
            path_parameter("Shot", "FILE", "INOUT", "The shot; what it names must be where it says"),
            path_parameter("Groom", "FILE", "IN", "The recipe, or the groom, of the shot"),
            path_parameter("Folder", "DIRECTORY", "INOUT", "Where groom, cache, hairs and frames go"),
            _value("Ringlet", "STRING", "ringlet", "The command ringlet"),
            {
                "name": "Camera",
                "type": "STRING",
                "description": "The prim of the camera, among those of the head's file",
            },
            _value("Frames", "STRING", f"{first}-{last}", "Frames of the pictures, such as 1-24 or 1-24:2"),
            _value("Format", "STRING", "png", "Of the pictures", allowedValues=["png", "exr"]),
            _value("Width", "INT", 1280, "Pixels across", minValue=1),
            _value("Samples", "INT", 40, "Light paths of a pixel", minValue=1),
            _value("Fraction", "FLOAT", 1.0, "Of the hairs to make", minValue=0.001, maxValue=1.0),
        ],
        "jobEnvironments": [{"name": "Progress", "variables": PROGRESS}],
        "steps": steps,
    }


def needs(processors: int) -> dict[str, Any]:
    """A host with at least so many processors, and 2 GiB of memory for each."""
    amounts = {"amount.worker.vcpu": processors, "amount.worker.memory": 2048 * processors}
    return {"hostRequirements": {"amounts": [{"name": name, "min": least} for name, least in amounts.items()]}}


def _value(name: str, kind: str, default: Any, about: str, **bounds: Any) -> dict[str, Any]:
    return {"name": name, "type": kind, "default": default, "description": about, **bounds}
