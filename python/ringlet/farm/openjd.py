"""Jobs of Open Job Description, for render farms, and a wedge as one.

Specification: https://github.com/OpenJobDescription/openjd-specifications/wiki. The first step of a wedge has one task
for each combination of settings; the second writes the page that compares them.
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
from ringlet.farm.task import TaskOptions

VERSION = "jobtemplate-2023-09"
MAX_NAME = 64  # characters of the name of a parameter, a job or a step


def write_template(path: Path, shot: Path, choices: Sequence[Choice], options: TaskOptions) -> None:
    """Writes the job template as JSON; its parameters are the shot and the output folder.

    Raises UserError for a path that does not end in .json.
    """
    write_job(path, template(shot, choices, options))


def write_job(path: Path, job: dict[str, Any]) -> None:
    """Writes a job template as JSON. Raises UserError for a path that does not end in .json."""
    if path.suffix != ".json":
        raise UserError(f"{path}: ends in '{path.suffix}'; must end in .json, such as wedge.template.json")
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
    return job(shot, [path_parameter("Folder", "DIRECTORY", "OUT", "Where the results go")], [simulate, compare])


def job(shot: Path, parameters: list[dict[str, Any]], steps: list[dict[str, Any]], **more: Any) -> dict[str, Any]:
    """The template of a job about a shot, with the shot and the command ringlet as its first parameters."""
    own = [
        path_parameter("Shot", "FILE", "INOUT", "The shot; what it names must be where it says"),
        value_parameter("Ringlet", "STRING", "The command ringlet", default="ringlet"),
    ]
    return {
        "specificationVersion": VERSION,
        "name": f"Ringlet: {shot.name}"[:MAX_NAME],
        "parameterDefinitions": own + parameters,
        **more,
        "steps": steps,
    }


def script(words: list[str], **more: Any) -> dict[str, Any]:
    """What a task runs: ringlet with words of the command line; ``more`` such as a timeout [s]."""
    return {"actions": {"onRun": {"command": "{{Param.Ringlet}}", "args": words, **more}}}


def value_parameter(name: str, kind: str, about: str, **more: Any) -> dict[str, Any]:
    """The definition of a parameter that is no path, with its default and its bounds."""
    return {"name": name, "type": kind, "description": about, **more}


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
