"""What the pages look at together: who leads, and what happens when a page asks for something."""

from __future__ import annotations

import asyncio
import logging
import secrets
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ringlet import api
from ringlet.data.errors import UserError
from ringlet.groom import Recipe
from ringlet.picture import HAIR_COLORS
from ringlet.viewer import overlays, protocol
from ringlet.viewer.board import Board, Mailbox
from ringlet.viewer.caches import Caches
from ringlet.viewer.files import Files, operator_names
from ringlet.viewer.hands import Hand
from ringlet.viewer.looks import Groomer, Look
from ringlet.viewer.playing import Playing
from ringlet.viewer.project import Project
from ringlet.viewer.scene import read_scene
from ringlet.viewer.sculpting import Sculptor
from ringlet.viewer.showing import Showing, measured
from ringlet.viewer.wire import pack, trouble
from ringlet.viewer.worker import Latest, Stale

LOOK_EVERY = 2.0  # whether other files are there [s]
NO_GROOM = "groom/trouble"  # the subject of why no groom is made

log = logging.getLogger("ringlet.viewer")


@dataclass(frozen=True)
class Work:
    """A groom that is wanted: a recipe, its revision, what is muted in it, and whether only a draft is needed."""

    recipe: Recipe
    revision: int
    muted: frozenset[str]
    draft: bool


class Page:
    """A browser that looks at the session."""

    def __init__(self, name: str, box: Mailbox) -> None:
        self.name, self.box = name, box


class Session:
    """One file and all pages that look at it. Its methods are called on the event loop; grooming is done beside it."""

    def __init__(self, file: Path, project: Project) -> None:
        self.project, self.files = project, Files(file, project)
        self.id = secrets.token_hex(8)
        self.board = Board()
        self.pages: list[Page] = []
        self.leader = ""
        self._heard = Counter[str]()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._looking: asyncio.Task[None] | None = None
        self._groomer, self._beside = Groomer(project), Groomer(project)
        self._showing, self._caches = Showing(self.board), Caches(project)
        self._playing = Playing(self.files, self.board, self._showing, self._call, self.trouble)
        self._hand, self._sculptor = Hand(self.files), Sculptor(self.files)
        if "recipe" not in self.files.documents:  # what cannot be read is told before there is a server
            bodies, look = read_scene(file)
            self._showing.stage(look, bodies)
            self._playing.read(look)
        self._worker = Latest[Work](self._groom, "groom")
        self._measurer = Latest[Look](self._measure, "measure")

    # Pages

    def start(self, loop: asyncio.AbstractEventLoop) -> None:
        """Begins to work, for pages that will come."""
        self._loop = loop
        for file in self.files.documents:
            self.board.post(f"document/{file}", self.files.told(file))
        if "recipe" in self.files.documents:
            self.regroom()
        self._looking = loop.create_task(self._look_for_files())

    async def _look_for_files(self) -> None:
        """Tells what there is to compare with, and again when that changes: caches are written by others, meanwhile."""
        told = None
        while True:
            names = await asyncio.to_thread(lambda: [*self.project.files("*.recipe.toml"), *self._caches.names()])
            if names != told:
                self.board.post("files", pack(protocol.Files(names=names)))
            told = names
            await asyncio.sleep(LOOK_EVERY)

    def stop(self) -> None:
        """Ends what works in the background."""
        self._loop = None
        if self._looking is not None:
            self._looking.cancel()
        self._playing.stop()
        self._worker.stop()
        self._measurer.stop()

    def join(self, name: str) -> Page:
        """A page comes in. The first one leads; whoever led before leads again."""
        page = Page(name, self.board.join(self._welcome(self._heard[name])))
        self.pages.append(page)
        if not self.leader or not any(other.name == self.leader for other in self.pages):
            self.leader = name
        self._tell_roles()
        return page

    def leave(self, page: Page) -> None:
        """A page has gone; the lead stays free for it until another one asks."""
        self.pages.remove(page)
        self.board.leave(page.box)
        self._tell_roles()

    def _welcome(self, heard: int) -> bytes:
        schemas = api.schema()
        return pack(
            protocol.Welcome.model_validate(
                {
                    "version": protocol.VERSION,
                    "session": self.id,
                    "heard": heard,
                    "name": self.files.file.name,
                    "mode": self.files.mode,
                    "schemas": schemas,
                    "operators": operator_names(schemas["recipe"]),
                    "pigments": {
                        name: (color.eumelanin, color.pheomelanin, color.roughness)
                        for name, color in HAIR_COLORS.items()
                    },
                }
            )
        )

    def _tell_roles(self) -> None:
        others = len({page.name for page in self.pages}) - 1
        for page in self.pages:
            page.box.put("role", pack(protocol.Role(leads=page.name == self.leader, others=others)))

    # Messages

    def hear(self, page: Page, message: protocol.FromPage) -> None:
        """Does what a page asks for, and tells it how much was heard. Raises UserError for what cannot be."""
        try:
            self._do(page, message)
        finally:
            self._heard[page.name] += 1
            page.box.put("heard", pack(protocol.Heard(count=self._heard[page.name])))

    def _do(self, page: Page, message: protocol.FromPage) -> None:
        if isinstance(message, protocol.Lead):
            self.leader = page.name
            self._tell_roles()
            return
        if isinstance(message, protocol.Watch):
            page.box.want(self._playing.wanted(message))
            return
        if page.name != self.leader:
            raise UserError("another page leads this session; take the lead to edit")
        files = self.files
        if isinstance(message, protocol.Set):
            files.set(message.file, message.changes, message.gesture)
            self._edited(message.file, resting=message.resting)
        elif isinstance(message, protocol.Arrange):
            files.arrange(message.action, message.at, message.to, message.op)
            self._edited("recipe")
        elif isinstance(message, protocol.Mute):
            files.recipe.become(files.recipe.text, muted=frozenset(message.stages))
            self._edited("recipe")
        elif isinstance(message, protocol.Step):
            for file in files.go(message.kind):
                self._edited(file)
        elif isinstance(message, protocol.Save):
            path = files.save(message.file, message.name, message.variant)
            self.board.post(f"document/{message.file}", files.told(message.file))
            for each in self.pages:
                each.box.put("saved", pack(protocol.Saved(name=path.name)))
        elif isinstance(message, protocol.Restore):
            files.document(message.file).become(message.text, edits=message.edits or None)
            self._edited(message.file)
        elif isinstance(message, protocol.Compare):
            self._compare(message)
        elif isinstance(message, protocol.Isolate):
            self._hand.isolate(message)
            self._edited("recipe")
        elif isinstance(message, protocol.Drag):
            self._hand.drag(message, self._showing.look)
            self._edited("recipe", resting=message.resting)
        elif isinstance(message, protocol.Sculpt):
            self._sculpt(message)
        elif isinstance(message, protocol.Unsculpt):
            self._sculptor.give_all_back()
            self._edited("recipe")
        elif isinstance(message, protocol.Play):
            self._playing.play(message)
        elif isinstance(message, protocol.Against):
            self._playing.lay_against(message.name)
        else:
            raise UserError(f"message: {message.kind} is not for this file")

    def _sculpt(self, message: protocol.Sculpt) -> None:
        """The guides follow the hand at once, and locks as soon as they can."""
        look = self._showing.look
        if look is None:
            raise UserError("sculpt: the groom is not made yet; wait until it is seen")
        guides = self._sculptor.move(message, look.groom)
        self.board.post("guides", self._sculptor.told(guides, look.groom))
        if message.resting:
            self._edited("recipe")
        else:
            document = self.files.recipe
            sculpted = self._sculptor.preview(document.model)
            self._worker.ask(Work(sculpted, document.revision, document.state.muted, True))

    def _compare(self, message: protocol.Compare) -> None:
        self._showing.clear_beside()
        if message.to == "none":
            self.board.post("b/none", pack(protocol.Compared(name="")))
            return
        document = self.files.recipe
        recipe, muted, name = document.model, document.state.muted, "as it was"
        if message.to == "saved":
            recipe = self.files.parse(document.saved, document.path, document.saved_edits)
            muted, name = frozenset[str](), "as saved"
        elif message.to == "file":
            path = self.project.inside(message.name, "compare")
            recipe = self.files.parse(path.read_text(encoding="utf-8"), path)
            muted, name = frozenset[str](), path.name
        look = self._beside.groom(recipe, muted, draft=False, fresh=lambda: None)
        self.board.post("b/none", pack(protocol.Compared(name=name)))
        self._showing.show(look, "b")

    # Grooming

    def _edited(self, file: str, *, resting: bool = True) -> None:
        self.board.post(f"document/{file}", self.files.told(file))
        if file == "recipe":
            self.regroom(draft=not resting)
        else:
            self._playing.tell()

    def regroom(self, *, draft: bool = False) -> None:
        """Makes the groom of the recipe as it stands; while a hand moves, a draft of it."""
        document = self.files.recipe
        self._worker.ask(Work(document.model, document.revision, document.state.muted, draft))

    def _groom(self, work: Work) -> None:
        """In the background: a draft is finished whatever comes, so that something is seen while a hand moves."""
        fresh: Callable[[], None] = (lambda: None) if work.draft else self._worker.fresh
        self._measurer.drop()
        try:
            look = self._groomer.groom(work.recipe, work.muted, draft=work.draft, fresh=fresh)
            self._call(self.board.wipe, NO_GROOM)
            self._call(self._show, look, work.revision)
            if not work.draft:
                self._measurer.ask(look)
        except UserError as error:  # told to pages that come later, too: it is why they see no hair
            self._call(self.board.post, NO_GROOM, trouble(str(error)))
        except Stale:
            raise
        except Exception as error:
            log.exception("a groom could not be made")
            self._call(self.trouble, f"this is a mistake in Ringlet ({error}); see the terminal")

    def _measure(self, look: Look) -> None:
        """In the background, while nobody grooms: what can wait."""
        groom, parts = look.groom, []
        for part in overlays.depths(groom.scalp, groom.scalp.points, groom.locks, groom.locks.points):
            self._measurer.fresh()
            parts.append(part)
        self._call(self.board.post, "measured", measured(groom, np.concatenate([np.empty(0), *parts])))

    def _show(self, look: Look, revision: int) -> None:
        before = self._showing.look
        self._showing.show(look, "a", revision)
        guides_changed = before is None or before.groom.guides is not look.groom.guides
        if guides_changed and look.groom.unsculpted is not None and not self._sculptor.busy:
            self.board.post("guides", self._sculptor.told(look.groom.guides, look.groom))
        if self.files.mode == "shot" and not look.draft:
            self._playing.set_groom(look)

    def _call(self, do: Callable[..., None], *arguments: Any) -> None:
        if self._loop is not None and not self._loop.is_closed():
            self._loop.call_soon_threadsafe(do, *arguments)

    def trouble(self, message: str) -> None:
        """Tells everybody what went wrong."""
        for page in self.pages:
            page.box.put("trouble", trouble(message))
