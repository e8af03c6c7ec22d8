"""The connected pages of a session: who is there, who leads, and what is sent to them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from ringlet.viewer import protocol
from ringlet.viewer.edit_lock import EditLock
from ringlet.viewer.presence import Presence
from ringlet.viewer.publisher import Publisher, SendQueue
from ringlet.viewer.wire import pack, trouble


class Page:
    """A connected page."""

    def __init__(self, name: str, queue: SendQueue) -> None:
        self.name, self.queue = name, queue


class Pages:
    """The pages, with the edit lock. Methods run on the session's thread.

    submit: runs a call on that thread
    left:   called before another page gets the edit lock
    """

    def __init__(self, publisher: Publisher, submit: Callable[..., Any], left: Callable[[], None]) -> None:
        self._publisher, self._left = publisher, left
        self._pages: list[Page] = []
        self._presence = Presence()
        self.lock = EditLock(submit, self._answered)

    def __iter__(self) -> Iterator[Page]:
        return iter(self._pages)

    def __len__(self) -> int:
        return len(self._pages)

    def join(self, name: str, welcome: bytes, person: str, *, led: bool) -> Page:
        """Adds a page, whose first message is ``welcome``; the next says whether it leads, before what it may edit.

        It gets the edit lock when no connected page holds it.

        led: whether it held the lock when it was connected last; it does not take it from a page that asked for it
        """
        page = Page(name, SendQueue())
        page.queue.put("welcome", welcome)
        self._presence.join(page, name, person)
        self.lock.join(name, self._names, led=led)
        self._pages.append(page)
        self.send_roles()
        self._publisher.subscribe(page.queue)
        return page

    def leave(self, page: Page) -> None:
        """Removes a page; the edit lock stays reserved for it until another page requests it."""
        self._pages.remove(page)
        self._presence.leave(page)
        self._publisher.unsubscribe(page.queue)
        if self.leads(page):
            self._left()
        self.lock.leave(page.name)
        self.send_roles()

    def leads(self, page: Page) -> bool:
        """Whether a page holds the edit lock."""
        return page.name == self.lock.leader

    def ask(self, page: Page) -> None:
        """A page asks for the edit lock."""
        self.lock.ask(page.name, self._names)
        self.send_roles()

    def present(self, page: Page, message: protocol.FromPage) -> None:
        """Handles a message of presence; what a page shares that no longer leads is outdated."""
        if isinstance(message, protocol.Introduce):
            self._presence.rename(page, message.person)
            self._presence[page].follows = message.follows
            self.send_roles()
        elif not self.leads(page):
            return
        elif isinstance(message, protocol.Look):  # also for those that join later
            self._publisher.publish("followed", pack(protocol.Followed(**message.model_dump(exclude={"kind"}))))
            page.queue.discard("followed")
        elif isinstance(message, protocol.Point):
            for other in self._pages:
                if other is not page:
                    other.queue.put("pointer", pack(protocol.Pointer(at=message.at)))

    def send(self, subject: str, message: bytes, to: str = "") -> None:
        """Sends a message to the page of a name, or to all pages."""
        for page in self._pages:
            if to in ("", page.name):
                page.queue.put(subject, message)

    def notice(self, message: str, to: str = "") -> None:
        """Shows a short message on the page of a name, or on all pages."""
        self.send("notice", pack(protocol.Notice(message=message)), to)

    def trouble(self, message: str) -> None:
        """Sends an error message to all pages."""
        self.send("trouble", trouble(message))

    def send_roles(self) -> None:
        """Tells each page who is there, and whether it leads."""
        people = [
            protocol.Person(**vars(self._presence[page]), leads=self.leads(page), you=False) for page in self._pages
        ]
        for k, page in enumerate(self._pages):
            mine = [person.model_copy(update={"you": k == other}) for other, person in enumerate(people)]
            role = {"people": mine, **self.lock.role(page.name)}
            if role["asked"]:
                role["asking"] = self._person(self.lock.asking)
            page.queue.put("role", pack(protocol.Role.model_validate(role)))

    def _answered(self, asked: str, before: str) -> None:
        """The page that asked for the edit lock has it, or ``before`` keeps it."""
        leader = self.lock.leader
        if asked == leader:
            self._left()
        if asked and leader != before:
            self.notice(f"{self._person(leader)} can edit now")
        elif asked != leader:
            self.notice(f"{self._person(leader)} goes on editing", to=asked)
        self.send_roles()

    def _person(self, name: str) -> str:
        """Name of the person at a page."""
        return next((self._presence[page].name for page in self._pages if page.name == name), "Another page")

    @property
    def _names(self) -> set[str]:
        return {page.name for page in self._pages}
