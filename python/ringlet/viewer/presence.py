"""Presence: the people whose pages are connected, with their names and colors."""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable
from dataclasses import dataclass

HUES = 12  # colors that people are distinguished by


@dataclass
class Person:
    """A person at a connected page.

    name:    as others see it; a guest with a number for a person without one
    hue:     number of their color
    follows: whether their page shows what the leading page looks at
    """

    name: str
    hue: int
    follows: bool = True


class Presence:
    """The connected people, by page. A page that reconnects keeps its color."""

    def __init__(self) -> None:
        self._people: dict[Hashable, Person] = {}
        self._hues: dict[str, int] = {}  # by the name that a page keeps when it reconnects

    def join(self, page: Hashable, client: str, name: str) -> Person:
        """Adds the person of a page.

        client: name of the page
        name:   name of the person; empty where none is known
        """
        self._people[page] = Person("", self._hues.setdefault(client, self._free()))
        self.rename(page, name)
        return self._people[page]

    def leave(self, page: Hashable) -> None:
        """Removes the person of a page."""
        self._people.pop(page, None)

    def rename(self, page: Hashable, name: str) -> None:
        """Names a person; without a name they are a guest, with a number that no other guest has."""
        person = self._people[page]
        person.name = " ".join(name.split()) or (person.name if _is_guest(person.name) else self._guest(page))

    def _free(self) -> int:
        """A color that no page has had; with many pages, the one that the fewest have had."""
        used = Counter(self._hues.values())
        return min(range(HUES), key=lambda hue: (used[hue], hue))

    def _guest(self, page: Hashable) -> str:
        names = {person.name for other, person in self._people.items() if other is not page}
        return next(name for k in range(1, len(names) + 2) if (name := f"Guest {k}") not in names)

    def __getitem__(self, page: Hashable) -> Person:
        """The person of a connected page."""
        return self._people[page]


def _is_guest(name: str) -> bool:
    return name.startswith("Guest ") and name[6:].isdigit()
