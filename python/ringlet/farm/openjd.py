"""A wedge as a job of Open Job Description, for render farms.

Specification: https://github.com/OpenJobDescription/openjd-specifications/wiki. A step has a task for every combination
of settings; when all are done, another writes the page that compares them.
"""

from __future__ import annotations

import itertools
import json
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ringlet.data.errors import UserError
from ringlet.data.files import replacing
from ringlet.data.toml import to_toml
from ringlet.farm.grid import Choice
from ringlet.farm.task import Wanted

VERSION = "jobtemplate-2023-09"
LONGEST_NAME = 64  # of a parameter, a job or a step


def write_template(path: Path, shot: Path, choices: Sequence[Choice], wanted: Wanted) -> None:
    """Writes the template, as JSON; it asks for the shot and for the folder of the results."""
    if path.suffix != ".json":
        raise UserError(f"{path}: ends in '{path.suffix}'; must end in .json, such as wedge.template.json")
    with replacing(path) as aside:
        aside.write_text(json.dumps(template(shot, choices, wanted), indent=2) + "\n", encoding="utf-8")


def template(shot: Path, choices: Sequence[Choice], wanted: Wanted) -> dict[str, Any]:
    """The job."""
    names = _names(choices)
    shot_and_folder = ["{{Param.Shot}}", "--output", "{{Param.Folder}}"]
    sets = [f"--set={choice.name}={{{{Task.Param.{name}}}}}" for name, choice in zip(names, choices, strict=True)]
    simulate: dict[str, Any] = {
        "name": "Simulate",
        "script": _script(["wedge", *shot_and_folder, *sets, "--here", *_options(wanted)]),
    }
    if choices:
        simulate["parameterSpace"] = {
            "taskParameterDefinitions": [
                {"name": name, "type": "STRING", "range": [_text(value) for value in choice.values]}
                for name, choice in zip(names, choices, strict=True)
            ]
        }
    return {
        "specificationVersion": VERSION,
        "name": f"Ringlet: {shot.name}"[:LONGEST_NAME],
        "parameterDefinitions": [
            _path("Shot", "FILE", "INOUT", "The shot; what it names must be where it says"),
            _path("Folder", "DIRECTORY", "OUT", "Where the results go"),
            {"name": "Ringlet", "type": "STRING", "default": "ringlet", "description": "The command ringlet"},
        ],
        "steps": [
            simulate,
            {
                "name": "Compare",
                "dependencies": [{"dependsOn": "Simulate"}],
                "script": _script(["wedge", *shot_and_folder, "--compare"]),
            },
        ],
    }


def _script(words: list[str]) -> dict[str, Any]:
    return {"actions": {"onRun": {"command": "{{Param.Ringlet}}", "args": words}}}


def _path(name: str, kind: str, flow: str, about: str) -> dict[str, str]:
    return {"name": name, "type": "PATH", "objectType": kind, "dataFlow": flow, "description": about}


def _options(wanted: Wanted) -> list[str]:
    """The options of the command that ask for the same."""
    frames = ["--frames", f"{wanted.frames[0]}:{wanted.frames[1]}"] if wanted.frames else []
    frame = [] if wanted.frame is None else ["--frame", str(wanted.frame)]
    threads = [] if wanted.threads is None else ["--threads", str(wanted.threads)]
    return [*frames, *frame, *threads, *([] if wanted.picture else ["--no-picture"])]


def _names(choices: Sequence[Choice]) -> list[str]:
    """Names that parameters of a task may have, all different."""
    names: list[str] = []
    for choice in choices:
        name = re.sub(r"[^A-Za-z0-9_]+", "_", choice.name).strip("_")[: LONGEST_NAME - 4]
        names.append(next(n for k in itertools.count(1) if (n := name if k == 1 else f"{name}_{k}") not in names))
    return names


def _text(value: Any) -> str:
    """A value as ``--set`` takes it: text in quotes, since it may hold a comma."""
    return "".join(to_toml({"value": value}).partition(" = ")[2].rstrip("\n"))
