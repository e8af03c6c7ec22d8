"""A job as a script of Pixar's Tractor, in the language of Alfred: ``tractor-spool JOB.alf`` submits it.

Steps are serial subtasks; one with a task for each frame has these as subtasks, in parallel. Operators are those of
https://rmanwiki.pixar.com/display/TRA/Job+Scripting+Operators.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ringlet.data.files import replacing
from ringlet.farm.job import HOUR, Job, Step


def write_tractor(path: Path, job: Job) -> None:
    """Writes the job."""
    tasks = "\n".join(_step(step, job) for step in job.steps)
    text = f"##AlfredToDo 3.0\nJob -title {tcl(job.title)} -serialsubtasks 1 -subtasks {{\n{tasks}\n}}\n"
    with replacing(path) as aside:
        aside.write_text(text, encoding="utf-8")


def _step(step: Step, job: Job) -> str:
    if not step.by_frame:
        return f"Task {tcl(step.name)} -cmds {{ {_command(step, job, '')} }}"
    first, last = job.frames
    tasks = [
        f"  Task {tcl(f'{step.name} {frame}')} -cmds {{ {_command(step, job, str(frame))} }}"
        for frame in range(first, last + 1)
    ]
    return "\n".join([f"Task {tcl(step.name)} -subtasks {{", *tasks, "}"])


def _command(step: Step, job: Job, frame: str) -> str:
    words = ["ringlet", *step.command(job.texts(frame))]
    return f"RemoteCmd {tcl(_list(words))} -atleast {step.processors} -maxrunsecs {step.hours * HOUR}"


def _list(words: Sequence[str]) -> str:
    return " ".join(map(tcl, words))


def tcl(word: str) -> str:
    """A word of Tcl that stands for a text."""
    if word and not any(character in ' \t\n"{}[]$;\\#' for character in word):
        return word
    if not any(character in "{}\\" for character in word):
        return f"{{{word}}}"
    return "".join(f"\\{character}" if character in ' \t"{}[]$;\\#' else character for character in word)
