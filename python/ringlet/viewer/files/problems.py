"""What stands in the way of a session, each problem with its remedies; shown until it is gone."""

from __future__ import annotations

from typing import Any

from ringlet.data.errors import UserError, one_line
from ringlet.viewer.protocol import Difference, File, Fix, Problem, Problems
from ringlet.viewer.publisher import Publisher
from ringlet.viewer.wire import pack

GROOM = "groom"  # the groom cannot be made
WORK = "work"  # the groom takes much longer than the one that is seen
SAVE = "save"  # a file is not saved, as its groom cannot be made
COPIED = "copied"  # a copy of a shot's recipe is saved, and the shot names the recipe
LIGHT = "light"  # an HDRI cannot be read
RECOVERED = "recovered"
RENAMED = "renamed"  # the file has former names of settings
OF_OPENING = {RECOVERED, RENAMED}

UNDO = Fix(label="Undo", message={"kind": "undo"})


def gone(file: File) -> str:
    """Subject of a problem: a file is no longer on disk."""
    return f"gone/{file}"


class ProblemList:
    """The problems of a session, by subject."""

    def __init__(self, publisher: Publisher) -> None:
        self._publisher = publisher
        self._problems: dict[str, Problem] = {}

    def __contains__(self, subject: str) -> bool:
        return subject in self._problems

    def __getitem__(self, subject: str) -> Problem:
        return self._problems[subject]

    @property
    def subjects(self) -> set[str]:
        """Subjects of the problems."""
        return set(self._problems)

    def show(
        self,
        subject: str,
        message: str,
        fixes: list[Fix] | None = None,
        *,
        place: tuple[File, str] | None = None,
        differences: list[Difference] | None = None,
    ) -> None:
        """Shows a problem in place of an earlier one of the subject.

        place:       file and name of the setting that is wrong
        differences: settings in which the version on disk differs, for a conflict
        """
        problem = Problem(
            subject=subject,
            message=one_line(message),
            file=place[0] if place else "recipe",
            setting=place[1] if place else "",
            fixes=fixes or [],
            differences=differences or [],
        )
        if self._problems.get(subject) != problem:
            self._problems[subject] = problem
            self.publish()

    def clear(self, *subjects: str) -> None:
        """Removes problems."""
        if removed := self._problems.keys() & set(subjects):
            self._problems = {name: one for name, one in self._problems.items() if name not in removed}
            self.publish()

    def publish(self) -> None:
        """Publishes the problems."""
        self._publisher.publish("problems", pack(Problems(problems=list(self._problems.values()))))


def dismiss(subject: str) -> Fix:
    """Remedy of a problem that needs none."""
    return Fix(label="Go on", message={"kind": "dismiss", "subject": subject})


def conflict_fixes(file: File) -> list[Fix]:
    """Remedies of a conflict with the version on disk; the page adds the choice setting by setting."""
    return [
        Fix(label=label, message={"kind": "resolve", "file": file, "choice": choice})
        for label, choice in (("Keep mine", "mine"), ("Load theirs", "theirs"))
    ]


def fixes_of(error: UserError, file: File) -> list[Fix]:
    """Remedies of an error: the values that it proposes."""
    return [
        Fix(label=f"Set {fix.name} to {fix.value}", message=_set(file, fix.place, fix.value)) for fix in error.fixes
    ]


def _set(file: File, place: tuple[str | int, ...], value: Any) -> dict[str, Any]:
    return {"kind": "set", "file": file, "changes": [[list(place), value]]}
