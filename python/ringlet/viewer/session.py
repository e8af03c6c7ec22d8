"""What the pages look at together: files being edited, the groom they make, and who leads."""

from __future__ import annotations

import asyncio
import logging
import secrets
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ringlet import api
from ringlet.errors import UserError
from ringlet.groom import Recipe, parse_recipe, row_of
from ringlet.mesh import Clip, Mesh
from ringlet.picture import HAIR_COLORS
from ringlet.settings import parse_toml, read_toml
from ringlet.shot.start import depths
from ringlet.viewer import protocol
from ringlet.viewer.board import Board, Mailbox
from ringlet.viewer.document import Document
from ringlet.viewer.looks import Groomer, Look, named_files, penetrations
from ringlet.viewer.project import Project
from ringlet.viewer.pull import pulled
from ringlet.viewer.scene import body_message, read_bodies, read_frames, read_scene
from ringlet.viewer.simulation import Simulation, Stage
from ringlet.viewer.wire import pack
from ringlet.viewer.worker import Latest, Stale

log = logging.getLogger("ringlet.viewer")


@dataclass(frozen=True)
class Work:
    """A groom that is wanted: a recipe, what is muted in it, and whether only a draft is needed."""

    recipe: Recipe
    muted: frozenset[str]
    draft: bool
    side: str = "a"


class Page:
    """A browser that looks at the session."""

    def __init__(self, name: str, box: Mailbox) -> None:
        self.name, self.box = name, box


class Session:
    """One file and all pages that look at it. Its methods are called on the event loop; grooming is done beside it."""

    def __init__(self, file: Path, project: Project) -> None:
        self.project, self.file = project, project.inside(file, "view")
        self.id = secrets.token_hex(8)
        self.board = Board()
        self.pages: list[Page] = []
        self.leader = ""
        self.documents: dict[str, Document] = {}
        self._loop: asyncio.AbstractEventLoop | None = None
        self._groomer = Groomer(project)
        self._beside = Groomer(project)
        self._layouts: dict[str, object] = {}
        self._bodies: object = None
        self._held: tuple[int, int, np.ndarray] | None = None
        self._moves: tuple[int, list[dict[str, Any]]] | None = None
        self._frames: np.ndarray | None = None
        self.look: Look | None = None
        self.stage: Stage | None = None
        self.simulation = Simulation(self._post, lambda: self._call(self.tell_timeline), self._failed)
        self.against = ""
        self._seen: list[tuple[Mesh, Clip | None]] = []
        self.mode = "stage"
        if self.file.suffix == ".toml":
            self._open()
        self._worker = Latest[Work](self._groom, "groom")

    def _open(self) -> None:
        """Opens the recipe, or a shot and the recipe that it names."""
        _, data = read_toml(self.file, "recipe or shot")
        recipe = self.file
        if "groom" in data and "frames" in data:
            self.mode = "shot"
            shot = api.read_shot(self.file)
            self.documents["shot"] = Document(self.file, lambda text: self.parse_shot(text))
            recipe = self.project.inside(shot.groom, f"{self.file.name}: groom")
        else:
            self.mode = "recipe"
        if recipe.suffix == ".toml":
            self.documents["recipe"] = Document(recipe, lambda text: self.parse(text, recipe))

    # What the files say

    def parse(self, text: str, path: Path) -> Recipe:
        """The recipe of a text, which may name files of the project only."""
        self._confine(parse_toml(text, path.name, "recipe"), path)
        recipe = parse_recipe(text, path)
        for what, file in named_files(recipe).items():
            self.project.inside(file, f"{path.name}: {what}")
        return recipe

    def _confine(self, data: dict[str, Any], path: Path) -> None:
        """Refuses what a recipe would read of itself outside of the project: what it extends, and edits."""
        for setting in ("extends", "edits"):
            if not isinstance(name := data.get(setting), str):
                continue
            file = self.project.inside(path.parent / name, f"{path.name}: {setting}")
            if setting == "extends" and file.is_file() and file != path.resolve():
                self._confine(read_toml(file, "recipe")[1], file)

    def parse_shot(self, text: str) -> Any:
        """The shot of a text, which may name files of the project only."""
        from ringlet.shot import parse_shot

        shot = parse_shot(text, self.file)
        named = {"groom": shot.groom, "rest.file": shot.rest.file}
        named |= {f"collider[{k}].file": one.file for k, one in enumerate(shot.collider)}
        for what, file in named.items():
            if file is not None:
                self.project.inside(file, f"{self.file.name}: {what}")
        return shot

    @property
    def recipe(self) -> Document:
        """The recipe that is edited."""
        if "recipe" not in self.documents:
            raise UserError(f"{self.file.name}: holds no recipe to edit; open a recipe or a shot that names one")
        return self.documents["recipe"]

    def document(self, file: str) -> Document:
        """An open file by its kind."""
        if file not in self.documents:
            raise UserError(f"{self.file.name}: no {file} is open; open one with: ringlet view")
        return self.documents[file]

    # Pages

    def start(self, loop: asyncio.AbstractEventLoop) -> None:
        """Begins to work, for pages that will come."""
        self._loop = loop
        for file in self.documents:
            self.tell_document(file)
        if "recipe" in self.documents:
            self.regroom(resting=True)
        else:
            self._show_stage()

    def stop(self) -> None:
        """Ends what works in the background."""
        self._loop = None
        self.simulation.stop()
        self._worker.stop()

    def join(self, name: str) -> Page:
        """A page comes in. The first one leads; whoever led before leads again."""
        page = Page(name, self.board.join(self._welcome()))
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

    def _welcome(self) -> bytes:
        schemas = api.schema()
        return pack(
            protocol.Welcome.model_validate(
                {
                    "version": protocol.VERSION,
                    "session": self.id,
                    "name": self.file.name,
                    "mode": self.mode,
                    "schemas": schemas,
                    "operators": operator_names(schemas["recipe"]),
                    "pigments": {
                        name: (color.eumelanin, color.pheomelanin, color.roughness)
                        for name, color in HAIR_COLORS.items()
                    },
                    "files": self.project.files("*.recipe.toml", "*.usdc", "*.usda", "*.usd"),
                }
            )
        )

    def _tell_roles(self) -> None:
        others = len({page.name for page in self.pages}) - 1
        for page in self.pages:
            page.box.put("role", pack(protocol.Role(leads=page.name == self.leader, others=others)))

    # Messages

    def hear(self, page: Page, message: protocol.FromPage) -> None:
        """Does what a page asks for. Raises UserError for what cannot be."""
        if isinstance(message, protocol.Lead):
            self.leader = page.name
            self._tell_roles()
            return
        if page.name != self.leader:
            raise UserError("another page leads this session; take the lead to edit")
        if isinstance(message, protocol.Set):
            self.document(message.file).set(message.changes, message.gesture)
            self._edited(message.file, resting=message.resting)
        elif isinstance(message, protocol.Arrange):
            entry = {"op": message.op} if message.op else None
            self.recipe.arrange(message.action, "shape", message.at, message.to, entry)
            self._edited("recipe")
        elif isinstance(message, protocol.Mute):
            self.recipe.become(self.recipe.text, muted=frozenset(message.stages))
            self._edited("recipe")
        elif isinstance(message, protocol.Step):
            self._step(message.kind)
        elif isinstance(message, protocol.Save):
            self._save(message)
        elif isinstance(message, protocol.Restore):
            self.document(message.file).become(message.text)
            self._edited(message.file)
        elif isinstance(message, protocol.Compare):
            self._compare(message)
        elif isinstance(message, protocol.Isolate):
            self._isolate(message)
        elif isinstance(message, protocol.Drag):
            self._drag(message)
        elif isinstance(message, protocol.Play):
            self._play(message)
        elif isinstance(message, protocol.Against):
            self._lay_against(message.name)
        else:
            raise UserError(f"message: {message.kind} is not for this file")

    def _step(self, kind: str) -> None:
        for file, document in self.documents.items():
            before = document.state
            if kind == "revert":
                document.become(document.saved)
            else:
                getattr(document, kind)()
            if document.state != before:
                self._edited(file)
                if kind != "revert":
                    return

    def _save(self, message: protocol.Save) -> None:
        document = self.document(message.file)
        if not message.name:
            path = document.save()
        else:
            path = self.project.beside(message.name, f".{message.file}.toml")
            if path.exists():
                raise UserError(f"save: {path.name} is there already; give another name")
            text = variant(document.path, document) if message.variant else document.text
            if message.file == "recipe":
                self.parse(text, path)
            document.save(path, text)
        self.tell_document(message.file)
        for page in self.pages:
            page.box.put("saved", pack(protocol.Saved(name=path.name)))

    def _compare(self, message: protocol.Compare) -> None:
        self.board.wipe("b/")
        self._layouts.pop("b", None)
        if message.to == "none":
            self.board.post("b/none", pack(protocol.Compared(name="")))
            return
        path, text, muted = self.recipe.path, self.recipe.text, self.recipe.state.muted
        if message.to == "saved":
            text, muted = self.recipe.saved, frozenset[str]()
        elif message.to == "file":
            path = self.project.inside(message.name, "compare")
            text, muted = path.read_text(encoding="utf-8"), frozenset[str]()
        work = Work(self.parse(text, path), muted, False, "b")
        look = self._beside.groom(work.recipe, work.muted, draft=False, fresh=lambda: None)
        names = {"now": "as it was", "saved": "as saved", "file": path.name}
        self.board.post("b/none", pack(protocol.Compared(name=names[message.to])))
        self._show(look, "b")

    # Single locks

    def _isolate(self, message: protocol.Isolate) -> None:
        """Takes locks out of the procedural, or returns them. What is taken out begins where it is."""
        document = self.recipe
        edits = document.said().get("edit", [])
        if message.out:
            known = {edit.get("lock") for edit in edits}
            for lock in message.locks:
                if lock not in known:
                    still = {"lock": lock, "move": [{"at": 1.0, "by": [0.0, 0.0, 0.0]}]}
                    document.arrange("add", "edit", len(document.said().get("edit", [])), entry=still)
        else:
            for k in reversed(range(len(edits))):
                if edits[k].get("lock") in message.locks:
                    document.arrange("remove", "edit", k)
        self._edited("recipe")

    def _drag(self, message: protocol.Drag) -> None:
        """Pulls a place of an isolated lock to where the hand is: in the frame of the lock's shape."""
        look = self.look
        edits = self.recipe.said().get("edit", [])
        index = next((k for k, edit in enumerate(edits) if edit.get("lock") == message.lock), None)
        if look is None or index is None:
            raise UserError(f"lock {message.lock} is not isolated; isolate it before it is dragged")
        row = row_of(look.groom, message.lock)
        count = int(look.groom.locks.counts[row])
        if not 0 < message.point < count:
            raise UserError(
                f"lock {message.lock} has points 1 to {count - 1} to drag; there is none at {message.point}"
            )
        at = round(message.point / (count - 1), 4)
        if self._held is None or self._held[:2] != (message.gesture, message.point):
            self._held = (message.gesture, message.point, np.array(look.groom.locks[row][message.point]))
        shift = pulled(look.groom, row, at, np.array(message.to) - self._held[2])
        moves = [move for move in self._before(message.gesture, edits[index]) if any(move["by"])]
        by = [f"{1e3 * x:.2f} mm" for x in shift]
        moves = [*moves, {"at": at, "by": by, "reach": max(round(message.reach, 3), 0.001)}]
        self.recipe.set([(["edit", index, "move"], moves)], message.gesture)
        self._edited("recipe", resting=message.resting)

    def _before(self, gesture: int, edit: dict[str, Any]) -> list[dict[str, Any]]:
        """The moves of a lock as they were before a gesture began."""
        if self._moves is None or self._moves[0] != gesture:
            self._moves = (gesture, edit.get("move", []))
        return self._moves[1]

    # Shots

    def _play(self, message: protocol.Play) -> None:
        if message.action == "pause":
            self.simulation.pause()
        elif message.action == "go_on":
            self.simulation.go_on()
        else:
            shot = self.parse_shot(self.document("shot").text)
            if self.stage is None:
                raise UserError("shot: its groom is not made yet; wait until it is seen")
            again = message.frame if message.action == "again_from" else None
            for name in [n for n in self.board.subjects("frame/shot/") if again is None or frame_of(n) > again]:
                self.board.wipe(name)
            self.simulation.start(shot, self.stage, again)

    def _lay_against(self, name: str) -> None:
        """Shows the frames of a cache beside the shot."""
        self.board.wipe("frame/against/")
        self.board.wipe("b/")
        self._layouts.pop("b", None)
        self.against = name
        if name:
            path = self.project.inside(name, "against")
            cache = api.read_cache(path)
            if self.stage is None or self.look is None or cache.points.shape[1] != len(self.stage.groom.locks.points):
                raise UserError(f"{name}: is of another groom than that of the shot; choose a cache of the same groom")
            self._show(self.look, "b")
            for k, frame in enumerate(cache.frames):
                told = cache.statistics[k] if k < len(cache.statistics) else {}
                subject = f"frame/against/{frame:g}"
                self.board.post(subject, self.stage.frame("against", float(frame), cache.points[k], told))
        self.board.post("b/none", pack(protocol.Compared(name=name)))
        self.tell_timeline()

    def tell_timeline(self) -> None:
        """Tells everybody which frames there are, and what the simulation does."""
        if self.mode != "shot" and self._frames is None:
            return
        if self.mode == "shot":
            shot = self.parse_shot(self.document("shot").text)
            first, last, preroll = float(shot.frames[0]), float(shot.frames[1]), shot.preroll
        else:
            assert self._frames is not None
            first, last, preroll = float(self._frames[0]), float(self._frames[-1]), 0
        simulation = self.simulation
        timeline = protocol.Timeline.model_validate(
            {
                "first": first,
                "last": last,
                "fps": self.stage.clip.fps if self.stage else 24.0,
                "ready": simulation.ready if self.mode == "shot" else last,
                "state": simulation.state if self.mode == "shot" else "none",
                "rolled": simulation.rolled,
                "preroll": preroll,
                "key": simulation.key,
                "against": self.against,
            }
        )
        self.board.post("timeline", pack(timeline))

    def _post(self, subject: str, message: bytes) -> None:
        self._call(self.board.post, subject, message)

    def _failed(self, message: str) -> None:
        self._call(self.trouble, message)

    # Grooming

    def _edited(self, file: str, *, resting: bool = True) -> None:
        self.tell_document(file)
        if file == "recipe":
            self.regroom(resting=resting)
        elif self.mode == "shot":
            self.tell_timeline()

    def regroom(self, *, resting: bool) -> None:
        """Makes the groom of the recipe as it stands; while a hand moves, a draft of it."""
        document = self.recipe
        self._worker.ask(Work(self.parse(document.text, document.path), document.state.muted, not resting))

    def _groom(self, work: Work) -> None:
        """In the background: a draft is finished whatever comes, so that something is seen while a hand moves."""
        fresh: Callable[[], None] = (lambda: None) if work.draft else self._worker.fresh
        try:
            look = self._groomer.groom(work.recipe, work.muted, draft=work.draft, fresh=fresh)
            self._call(self._show, look, work.side)
            if not work.draft:
                inside = penetrations(look.groom, depths)
                self._call(self._tell_numbers, look, inside)
        except UserError as error:
            self._call(self.trouble, str(error))
        except Stale:
            raise
        except Exception as error:
            log.exception("a groom could not be made")
            self._call(self.trouble, f"this is a mistake in Ringlet ({error}); see the terminal")

    def _call(self, do: Callable[..., None], *arguments: Any) -> None:
        if self._loop is not None and not self._loop.is_closed():
            self._loop.call_soon_threadsafe(do, *arguments)

    def _show(self, look: Look, side: str) -> None:
        if side == "a":
            self.look = look
            if self._bodies is not look.groom.scalp:
                self._bodies = look.groom.scalp
                self._show_bodies(look)
            if self.mode == "shot" and not look.draft:
                self._set_stage(look)
        layout = look.hairs.curves if look.hairs else look.groom.locks
        if self._layouts.get(side) is not layout:
            self._layouts[side] = layout
            self.board.post(f"{side}/hairs", look.layout(side))
        self.board.post(f"{side}/locks", look.locks(side))
        if side == "a" and look.draft:
            self._tell_numbers(look, -1)

    def _show_bodies(self, look: Look) -> None:
        self.board.wipe("body/")
        self._seen = read_bodies(look.groom.scalp, look.groom.scalp_file)
        for index, (mesh, _) in enumerate(self._seen):
            self.board.post(f"body/{index}", body_message(index, mesh, mesh.points))

    def _set_stage(self, look: Look) -> None:
        """The groom has changed: frames of the one before are void."""
        if self.stage is None or self.stage.groom.locks.points is not look.groom.locks.points:
            self.simulation.stop()
            self.simulation.reset()
            self.board.wipe("frame/")
            self.against = ""
            self.stage = Stage(look.groom, look.hairs, api.scalp_clip(look.groom), self._seen)
        self.tell_timeline()

    def _show_stage(self) -> None:
        """Hair of a USD file, as it is, with its frames if it has some."""
        self._seen, look = read_scene(self.file)
        for index, (mesh, clip) in enumerate(self._seen):
            self.board.post(f"body/{index}", body_message(index, mesh, clip.points[0] if clip else mesh.points))
        self._show(look, "a")
        self._tell_numbers(look, -1)
        self._frames, moving = read_frames(self.file, look)
        if self._frames is None:
            return
        still = Clip(np.zeros(1), look.groom.scalp.points[None], 24.0)
        clip = api.scalp_clip(look.groom) if look.groom.scalp_file else still
        self.stage = Stage(look.groom, look.hairs, clip, self._seen)
        for frame, points, told in moving:
            self.board.post(f"frame/shot/{frame:g}", self.stage.frame("shot", frame, points, told))
        self.tell_timeline()

    def _tell_numbers(self, look: Look, inside: int) -> None:
        numbers = protocol.Numbers(
            locks=len(look.groom.locks),
            hairs=look.count,
            inside=inside,
            groom_ms=round(look.took, 1),
            times=look.times,
            draft=look.draft,
        )
        self.board.post("numbers", pack(numbers))

    def trouble(self, message: str) -> None:
        """Tells everybody what went wrong."""
        for page in self.pages:
            page.box.put("trouble", pack(protocol.Trouble(message=" ".join(message.split()))))

    def tell_document(self, file: str) -> None:
        """Tells everybody what a file says now."""
        document = self.documents[file]
        model = self.parse(document.text, document.path) if file == "recipe" else self.parse_shot(document.text)
        message = protocol.Document.model_validate(
            {
                "file": file,
                "name": document.path.name,
                "text": document.text,
                "said": document.said(),
                "values": model.model_dump(mode="json"),
                "stages": stages(model, document.state.muted) if file == "recipe" else [],
                "dirty": document.dirty,
                "undo": document.can_undo,
                "redo": document.can_redo,
                "changes": document.changes(),
            }
        )
        self.board.post(f"document/{file}", pack(message))


def frame_of(subject: str) -> float:
    """The frame that a subject is about."""
    return float(subject.rsplit("/", 1)[1])


def stages(recipe: Recipe, muted: frozenset[str]) -> list[protocol.Stage]:
    """The stages of a recipe in their order."""
    found: list[tuple[str, str, protocol.Place]] = [("guides", "guides", ["guides"]), ("locks", "locks", ["locks"])]
    found += [(operator.op, operator.op, ["shape", k]) for k, operator in enumerate(recipe.shape)]
    for name in ("curl", "clean", "hairs"):
        found.append((name, name, [name]))
    return [
        protocol.Stage(name=name, op=op, place=place, muted="/".join(map(str, place)) in muted)
        for name, op, place in found
    ]


def operator_names(schema: dict[str, Any]) -> list[str]:
    """The operators that a recipe's shape may hold."""
    return list(schema["properties"]["shape"]["items"]["discriminator"]["mapping"])


def variant(base: Path, document: Document) -> str:
    """The text of a recipe that extends another one and says only what differs."""
    import tomllib

    from ringlet.viewer.document import written

    before, now = tomllib.loads(document.saved), document.said()
    lines = [f"# {now.get('name') or base.stem}, with other values.", "ringlet = 1", f'extends = "{base.name}"']
    tables: list[str] = []
    for name, value in now.items():
        if name in ("ringlet", "extends") or before.get(name) == value:
            continue
        if isinstance(value, dict):
            old = before.get(name, {})
            changed = [f"{key} = {written(entry)}" for key, entry in value.items() if old.get(key) != entry]
            tables += ["", f"[{name}]", *changed]
        else:
            lines.append(f"{name} = {written(value)}")
    return "\n".join([*lines, *tables, ""])
