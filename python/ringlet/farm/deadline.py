"""A job as a folder for Deadline: a job of its plug-in CommandLine for each step, and ``submit.txt``.

``deadlinecommand FOLDER.deadline/submit.txt`` submits them all, each of which waits for the one before it. Keys are
those of the manual, https://docs.thinkboxsoftware.com: "Manual Job Submission".
"""

from __future__ import annotations

from pathlib import Path

from ringlet.data.files import replacing
from ringlet.farm.job import HOUR, Job, Step

FRAME = "<STARTFRAME>"  # of a task, as Deadline puts it in


def write_deadline(path: Path, job: Job) -> None:
    """Writes ``submit.txt``, and the information of job and plug-in for each step, to a folder."""
    words = ["-SubmitMultipleJobs", "-dependent"]
    for step in job.steps:
        info, plugin = (path.absolute() / f"{step.name}.{kind}" for kind in ("job", "plugin"))
        _write(info, [f"{key}={value}" for key, value in _info(step, job).items()])
        _write(plugin, [f"{key}={value}" for key, value in _plugin(step, job).items()])
        words += ["-job", str(info), str(plugin)]
    _write(path / "submit.txt", words)


def _info(step: Step, job: Job) -> dict[str, object]:
    first, last = job.frames
    outputs = {f"OutputDirectory{k}": _folder(name, job) for k, name in enumerate(step.writes)}
    return {
        "Plugin": "CommandLine",
        "Name": step.name,
        "BatchName": job.title,
        "Frames": f"{first}-{last}" if step.by_frame else 0,
        "ChunkSize": 1,
        "TaskTimeoutSeconds": step.hours * HOUR,
        **outputs,
    }


def _folder(name: str, job: Job) -> Path:
    file = job.files[name]
    return file.path if file.folder else file.path.parent


def _plugin(step: Step, job: Job) -> dict[str, str]:
    words = step.command(job.texts(FRAME))
    return {"Executable": "ringlet", "Arguments": " ".join(f'"{word}"' if " " in word else word for word in words)}


def _write(path: Path, lines: list[str]) -> None:
    with replacing(path) as aside:
        aside.write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")
