"""Jobs and wedges as templates of Open Job Description, for render farms.

Specification: https://github.com/OpenJobDescription/openjd-specifications/wiki. Files of a job are parameters that
farms map and bring to their machines. The first step of a wedge has one task for each combination of settings; the
second writes the page that compares them.
"""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ringlet.data.errors import UserError
from ringlet.data.files import replacing
from ringlet.data.names import distinct, identifier
from ringlet.data.toml import to_toml
from ringlet.farm.grid import Choice
from ringlet.farm.job import FRAME, HOUR, Job, Step
from ringlet.farm.task import TaskOptions

VERSION = "jobtemplate-2023-09"
PROGRESS = {"RINGLET_PROGRESS": "openjd"}  # tells the command to print its progress as farms read it
MEMORY = 2048  # of each processor [MiB]
MAX_NAME = 64  # characters of the name of a parameter, a job or a step


def write_template(path: Path, shot: Path, choices: Sequence[Choice], options: TaskOptions) -> None:
    """Writes the job template as JSON; its parameters are the shot and the output folder.

    Raises UserError for a path that does not end in .json.
    """
    if path.suffix != ".json":
        raise UserError(f"{path}: ends in '{path.suffix}'; must end in .json, such as wedge.template.json")
    _write(path, template(shot, choices, options))


def write_openjd(path: Path, job: Job) -> None:
    """Writes a job as JSON. Parameters are its files with what they have to do with it, its values and its frames."""
    files = [
        {
            "name": name,
            "type": "PATH",
            "objectType": "DIRECTORY" if file.folder else "FILE",
            "dataFlow": "OUT" if job.is_made(name) else "IN",
            "default": _default(file.path, path.absolute().parent),
            "description": file.about,
        }
        for name, file in job.files.items()
    ]
    values = [
        {"name": name, "type": "INT" if isinstance(value, int) else "STRING", "default": value}
        for name, value in job.values.items()
    ]
    first, last = job.frames
    frames = {"name": "Frames", "type": "STRING", "default": f"{first}-{last}", "description": "Such as 1-24 or 1-24:2"}
    steps: list[dict[str, Any]] = []
    for step in job.steps:
        after = {"dependencies": [{"dependsOn": steps[-1]["name"]}]} if steps else {}
        steps.append({**_step(step, job), **after})
    environment = {"name": "Progress", "variables": PROGRESS}
    _write(path, _template(job.title, [*files, *values, frames], steps) | {"jobEnvironments": [environment]})


def _default(file: Path, folder: Path) -> str:
    """A path as the default of a parameter: relative to the folder of the template where it is in it, else absolute."""
    return (file.relative_to(folder) if file.is_relative_to(folder) else file).as_posix()


def _step(step: Step, job: Job) -> dict[str, Any]:
    texts = {name: f"{{{{Param.{name}}}}}" for name in (*job.files, *job.values)}
    words = step.command({**texts, FRAME: f"{{{{Task.Param.{FRAME}}}}}"})
    amounts = {"amount.worker.vcpu": step.processors, "amount.worker.memory": MEMORY * step.processors}
    frame = {"name": FRAME, "type": "INT", "range": "{{Param.Frames}}"}
    return {
        "name": step.name,
        "description": f"Reads {', '.join(step.reads)}. Writes {', '.join(step.writes)}.",
        "hostRequirements": {"amounts": [{"name": name, "min": least} for name, least in amounts.items()]},
        "script": script(words, timeout=step.hours * HOUR),
        **({"parameterSpace": {"taskParameterDefinitions": [frame]}} if step.by_frame else {}),
    }


def _template(title: str, parameters: list[dict[str, Any]], steps: list[dict[str, Any]]) -> dict[str, Any]:
    """A template, with the command ringlet as the last parameter."""
    ringlet = {"name": "Ringlet", "type": "STRING", "description": "The command ringlet", "default": "ringlet"}
    return {
        "specificationVersion": VERSION,
        "name": title[:MAX_NAME],
        "parameterDefinitions": [*parameters, ringlet],
        "steps": steps,
    }


def _write(path: Path, job: dict[str, Any]) -> None:
    with replacing(path) as aside:
        aside.write_text(json.dumps(job, indent=2) + "\n", encoding="utf-8")


def template(shot: Path, choices: Sequence[Choice], options: TaskOptions) -> dict[str, Any]:
    """The job template as plain values."""
    names = _names(choices)
    shot_and_folder = ["{{Param.Shot}}", "--output", "{{Param.Folder}}"]
    sets = [f"--set={choice.name}={{{{Task.Param.{name}}}}}" for name, choice in zip(names, choices, strict=True)]
    simulate: dict[str, Any] = {
        "name": "Simulate",
        "script": script(["wedge", *shot_and_folder, *sets, "--here", *_arguments(options)]),
    }
    if choices:
        simulate["parameterSpace"] = {
            "taskParameterDefinitions": [
                {"name": name, "type": "STRING", "range": [_text(value) for value in choice.values]}
                for name, choice in zip(names, choices, strict=True)
            ]
        }
    compare = {
        "name": "Compare",
        "dependencies": [{"dependsOn": "Simulate"}],
        "script": script(["wedge", *shot_and_folder, "--compare"]),
    }
    parameters = [
        path_parameter("Shot", "FILE", "INOUT", "The shot; what it names must be where it says"),
        path_parameter("Folder", "DIRECTORY", "OUT", "Where the results go"),
    ]
    return _template(f"Ringlet: {shot.name}", parameters, [simulate, compare])


def script(words: list[str], **more: Any) -> dict[str, Any]:
    """What a task runs: ringlet with words of the command line; ``more`` such as a timeout [s]."""
    return {"actions": {"onRun": {"command": "{{Param.Ringlet}}", "args": words, **more}}}


def path_parameter(name: str, kind: str, flow: str, about: str) -> dict[str, str]:
    """The definition of a parameter that is a path, which farms map.

    kind, flow: ``FILE`` or ``DIRECTORY``; ``IN``, ``OUT`` or ``INOUT``
    """
    return {"name": name, "type": "PATH", "objectType": kind, "dataFlow": flow, "description": about}


def _arguments(options: TaskOptions) -> list[str]:
    """Command-line options that are equivalent to ``options``."""
    frames = ["--frames", f"{options.frames[0]}:{options.frames[1]}"] if options.frames else []
    frame = [] if options.frame is None else ["--frame", str(options.frame)]
    threads = [] if options.threads is None else ["--threads", str(options.threads)]
    return [*frames, *frame, *threads, *([] if options.picture else ["--no-picture"])]


def _names(choices: Sequence[Choice]) -> list[str]:
    """Valid and unique parameter names of the settings."""
    return distinct([choice.name for choice in choices], lambda name: _parameter(name)[: MAX_NAME - 4])


def _parameter(name: str) -> str:
    return identifier(re.sub(r"[^A-Za-z0-9_]+", "_", name).strip("_"))


def _text(value: Any) -> str:
    """A value for ``--set``: strings in quotes, since they may contain commas."""
    return "".join(to_toml({"value": value}).partition(" = ")[2].rstrip("\n"))
