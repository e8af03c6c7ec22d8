"""Messages of a page: its requests to the session."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, TypeAdapter

from ringlet.data import limits
from ringlet.viewer.protocol.live import Blow, GoLive, HoldHead, MoveHead, TouchHair
from ringlet.viewer.protocol.message import (
    Coordinate,
    File,
    FrameNumber,
    Gesture,
    Id,
    Light,
    Message,
    Place,
    Position,
    Row,
    Shared,
)
from ringlet.viewer.protocol.painting import Draw, Paint, ShowMap, Stroke
from ringlet.viewer.protocol.presets import Keep, ListPresets, Take, Try
from ringlet.viewer.protocol.render import Render, StopRender
from ringlet.viewer.protocol.review import KeepTake, MakeShot, ReviewMessage

MOST_TEXT = 1_800_000  # characters of a file

PersonName = Annotated[str, Field(max_length=40)]


class Hello(Message):
    """First message of a page.

    client: name that the page keeps when it reconnects
    leads:  whether it held the edit lock when it was connected last
    person: name of the person, as others see it; empty where it is not known
    """

    kind: Literal["hello"] = "hello"
    version: Row
    client: str = Field(max_length=64)
    leads: bool = False
    person: PersonName = ""


class Introduce(Message):
    """Names the person of a page. follows: whether the page shows what the leading page looks at."""

    kind: Literal["introduce"] = "introduce"
    person: PersonName = ""
    follows: bool = True


class Point(Message):
    """Position of the leading page's pointer in the scene [m]; None where it is elsewhere."""

    kind: Literal["point"] = "point"
    at: Position | None


class Lead(Message):
    """Requests the edit lock; a page that holds it is asked, and hands it over after a while without an answer."""

    kind: Literal["lead"] = "lead"


class Set(Message):
    """Sets values of settings, in TOML notation; None removes a setting, so that its default applies.

    gesture: number of the gesture; its changes are one undo step
    resting: whether the gesture has ended; a moving one gets a draft
    """

    kind: Literal["set"] = "set"
    file: File = "recipe"
    changes: list[tuple[Annotated[Place, Field(min_length=1)], Any]] = Field(max_length=256)
    gesture: Gesture
    resting: bool = True


class Arrange(Message):
    """Adds, removes or moves a shape operator of the recipe.

    values: settings of an operator that is added, for those without a default
    """

    kind: Literal["arrange"] = "arrange"
    action: Literal["add", "remove", "move"]
    at: Row
    to: Row = 0
    op: str = Field(default="", max_length=64)
    values: dict[str, str] = Field(default_factory=dict, max_length=8)


class Mute(Message):
    """Mutes stages such as ``shape/0`` or ``curl``; not stored in the file.

    solo: the one stage that acts while it is set; the mutes stay
    """

    kind: Literal["mute"] = "mute"
    stages: list[str] = Field(max_length=256)
    solo: str = Field(default="", max_length=64)


class Choose(Message):
    """Chooses the one of several grooms whose settings are shown and changed."""

    kind: Literal["choose"] = "choose"
    groom: str = Field(max_length=240)


class Step(Message):
    """Undoes, redoes or reverts changes."""

    kind: Literal["undo", "redo", "revert"]


class Save(Message):
    """Saves a file; with a name, a copy beside it, or a variant that extends it, which the session then goes on with.

    anyway:    saves a recipe whose groom cannot be made
    with_copy: a copy of a shot names the copy of its recipe that was saved just before
    """

    kind: Literal["save"] = "save"
    file: File = "recipe"
    name: str = Field(default="", max_length=120)
    variant: bool = False
    anyway: bool = False
    with_copy: bool = False


class Open(Message):
    """Opens another recipe, shot or USD file of the project in the session.

    discard: discards unsaved changes; without it, they keep the file open
    """

    kind: Literal["open"] = "open"
    name: str = Field(max_length=240)
    discard: bool = False


class UseCopy(Message):
    """Lets the shot name the copy of its recipe that was saved last, saves the shot, and goes on with both."""

    kind: Literal["use_copy"] = "use_copy"


class Resolve(Message):
    """Resolves a conflict with the version of a file on disk.

    mine, theirs: for ``merge``, names of the settings of which the session's value, or that on disk, is kept
    """

    kind: Literal["resolve"] = "resolve"
    file: File = "recipe"
    choice: Literal["mine", "theirs", "merge"]
    mine: list[str] = Field(default_factory=list, max_length=10_000)
    theirs: list[str] = Field(default_factory=list, max_length=10_000)


class Dismiss(Message):
    """Removes a problem that needs no remedy."""

    kind: Literal["dismiss"] = "dismiss"
    subject: str = Field(max_length=64)


class Proceed(Message):
    """Makes a groom that takes much longer than the displayed one."""

    kind: Literal["proceed"] = "proceed"


class Cancel(Message):
    """Cancels the groom that is being made; the displayed one stays."""

    kind: Literal["cancel"] = "cancel"


class Restore(Message):
    """Restores unsaved text of a page, and of its file of edits, after a restart of the server.

    saved, saved_edits: the texts as they were read or saved last; another version on disk is a conflict
    """

    kind: Literal["restore"] = "restore"
    file: File = "recipe"
    text: str = Field(max_length=MOST_TEXT)
    edits: str = Field(default="", max_length=MOST_TEXT)
    saved: str = Field(default="", max_length=MOST_TEXT)
    saved_edits: str = Field(default="", max_length=MOST_TEXT)


class Compare(Message):
    """Shows another groom on a side: as it is now, as saved, a snapshot, another recipe of the project, or none.

    name: of the recipe, or id of the snapshot
    """

    kind: Literal["compare"] = "compare"
    to: Literal["now", "saved", "snapshot", "file", "none"]
    name: str = Field(default="", max_length=240)
    side: Literal["b", "c", "d"] = "b"


class Drag(Message):
    """Drags a point of an isolated lock to a position [m]; the move fades over a fraction of the lock, ``falloff``."""

    kind: Literal["drag"] = "drag"
    lock: Id
    point: Row
    to: Position
    falloff: float = Field(default=0.2, ge=0.0, le=1.0)
    gesture: Gesture
    resting: bool = True


class Isolate(Message):
    """Isolates locks from the procedural groom for manual edits, or returns them."""

    kind: Literal["isolate"] = "isolate"
    locks: list[Id] = Field(max_length=10_000)
    out: bool = True


class Sculpt(Stroke):
    """Moves a brush over the guides, or returns guides to the recipe.

    strength: fraction of its displacement that the brush moves what is at its centre

    ``freeze`` protects guides from all brushes, ``thaw`` ends that; neither is stored in the file.
    """

    kind: Literal["sculpt"] = "sculpt"
    tool: Literal["grab", "comb", "smooth", "cut", "lengthen", "return", "freeze", "thaw"]


class Look(Shared):
    """Shares the look of the leading page with those that follow."""

    kind: Literal["look"] = "look"


class Share(Message):
    """Requests a share page: one file with the look to turn.

    camera: position and target [m], six numbers
    light, color, theme: their choices on the page; empty for none
    """

    kind: Literal["share"] = "share"
    camera: list[Coordinate] = Field(min_length=6, max_length=6)
    light: Light
    color: str = Field(max_length=64)
    theme: Literal["dark", "light"] = "dark"


class Hand(Message):
    """Answers another page that asks for the edit lock."""

    kind: Literal["hand"] = "hand"
    over: bool


class Unsculpt(Message):
    """Removes the sculpts of all guides."""

    kind: Literal["unsculpt"] = "unsculpt"


class Play(Message):
    """Starts, pauses or resumes the simulation, or restarts it from an existing frame."""

    kind: Literal["play"] = "play"
    action: Literal["start", "pause", "go_on", "again_from"]
    frame: Annotated[int, Field(ge=-limits.FRAME, le=limits.FRAME)] = 0


class Against(Message):
    """Compares the shot with a cache of the project or an earlier take; without a name and a run with nothing.

    run: number of the last run of the take
    """

    kind: Literal["against"] = "against"
    name: str = Field(default="", max_length=240)
    run: Row = 0


class UseRun(Message):
    """Gives the shot the settings of an earlier take, as one undo step."""

    kind: Literal["use_run"] = "use_run"
    run: Row


class AskMotion(Message):
    """Requests the words of motion of a lock in the shot; replaces an earlier request that is still pending."""

    kind: Literal["ask_motion"] = "ask_motion"
    lock: Id


class Watch(Message):
    """Requests frames, the current one first; replaces earlier requests that are still pending."""

    kind: Literal["watch"] = "watch"
    shot: list[FrameNumber] = Field(default_factory=list, max_length=64)
    against: list[FrameNumber] = Field(default_factory=list, max_length=64)


FromPage = Annotated[
    Hello
    | Introduce
    | Point
    | Lead
    | Set
    | Arrange
    | Choose
    | Mute
    | Step
    | Save
    | Open
    | UseCopy
    | Resolve
    | Dismiss
    | Proceed
    | Cancel
    | Restore
    | Compare
    | Drag
    | Isolate
    | Sculpt
    | Unsculpt
    | ShowMap
    | Paint
    | Draw
    | ListPresets
    | Try
    | Take
    | Keep
    | Look
    | Share
    | Hand
    | Play
    | Against
    | UseRun
    | Render
    | StopRender
    | AskMotion
    | Watch
    | GoLive
    | HoldHead
    | TouchHair
    | MoveHead
    | Blow
    | KeepTake
    | MakeShot
    | ReviewMessage,
    Field(discriminator="kind"),
]
FROM_PAGE: TypeAdapter[FromPage] = TypeAdapter(FromPage)

# Messages of presence: the latest of each counts, so that they are neither acknowledged nor sent again.
PRESENCE = (Introduce, Point, Look, HoldHead, TouchHair)
