"""What the page and the server say to each other: defined here, and only here.

A message is a JSON header followed by arrays (see ``wire``); ``tools/make_protocol.py`` writes the same as TypeScript.
``arrays`` names those that a message carries, with their types; all lengths are in metres.
"""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter

VERSION = 6
Place = list[str | int]  # where a setting is in its file: ["shape", 0, "amount"]
File = Literal["recipe", "shot"]
Point = tuple[float, float, float]


class Message(BaseModel):
    """One message; ``kind`` says which."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)
    arrays: ClassVar[dict[str, str]] = {}


# From the page


class Hello(Message):
    """The first message: who is there. ``client`` is a name that a page keeps when it comes back."""

    kind: Literal["hello"] = "hello"
    version: int
    client: str = Field(max_length=64)


class Lead(Message):
    """Asks to be the one who edits."""

    kind: Literal["lead"] = "lead"


class Set(Message):
    """Gives settings new values, as TOML would say them; None takes a setting out, so that its default holds.

    gesture: changes of one gesture are undone together
    resting: whether the gesture has ended, so that quality counts more than speed
    """

    kind: Literal["set"] = "set"
    file: File = "recipe"
    changes: list[tuple[Place, Any]] = Field(max_length=256)
    gesture: int
    resting: bool = True


class Arrange(Message):
    """Adds, removes or moves an operator of the recipe's shape."""

    kind: Literal["arrange"] = "arrange"
    action: Literal["add", "remove", "move"]
    at: int = Field(ge=0)
    to: int = Field(default=0, ge=0)
    op: str = Field(default="", max_length=64)


class Mute(Message):
    """Says which stages have no effect for now: ``shape/0``, ``curl`` …; not kept in the file."""

    kind: Literal["mute"] = "mute"
    stages: list[str] = Field(max_length=256)


class Step(Message):
    """Goes back or forth in what was done."""

    kind: Literal["undo", "redo", "revert"]


class Save(Message):
    """Writes a file. With a name it is a new one beside the old: a copy, or a variant that extends it."""

    kind: Literal["save"] = "save"
    file: File = "recipe"
    name: str = Field(default="", max_length=120)
    variant: bool = False


class Restore(Message):
    """Gives back a text that a page still had when the server was started anew, and that of its file of edits."""

    kind: Literal["restore"] = "restore"
    file: File = "recipe"
    text: str = Field(max_length=900_000)
    edits: str = Field(default="", max_length=900_000)


class Compare(Message):
    """Shows another look beside this one: as it is now, as saved, or another recipe of the project, or none."""

    kind: Literal["compare"] = "compare"
    to: Literal["now", "saved", "file", "none"]
    name: str = Field(default="", max_length=240)


class Drag(Message):
    """Moves points of an isolated lock by hand [m]. Its shape becomes the lock's own."""

    kind: Literal["drag"] = "drag"
    lock: int
    point: int = Field(ge=0)
    to: Point
    reach: float = Field(default=0.2, ge=0.0, le=1.0)
    gesture: int
    resting: bool = True


class Isolate(Message):
    """Takes locks out of the procedural to be edited by hand, or returns them."""

    kind: Literal["isolate"] = "isolate"
    locks: list[int] = Field(max_length=10_000)
    out: bool = True


class Sculpt(Message):
    """Moves a brush over the guides, or gives them back to the recipe.

    at, by:   where the brush is and how far it came since the last message of this gesture [m]
    radius:   of the ball that it acts in [m]
    mirrored: does the same on the other side of the head
    """

    kind: Literal["sculpt"] = "sculpt"
    tool: Literal["grab", "comb", "smooth", "cut", "lengthen", "return"]
    at: Point
    by: Point
    radius: float = Field(gt=0.0, le=1.0)
    mirrored: bool = False
    gesture: int
    resting: bool = True


class Unsculpt(Message):
    """Gives all guides back to the recipe."""

    kind: Literal["unsculpt"] = "unsculpt"


class Play(Message):
    """Runs the shot: from its start, on from where it was held, or again from a frame that is there already."""

    kind: Literal["play"] = "play"
    action: Literal["start", "pause", "go_on", "again_from"]
    frame: int = 0


class Against(Message):
    """Lays the frames of another cache of the project under the shot, to compare; no name takes it away."""

    kind: Literal["against"] = "against"
    name: str = Field(default="", max_length=240)


class Watch(Message):
    """Asks for frames, the one that is looked at first, in place of those that were asked for and have not come yet."""

    kind: Literal["watch"] = "watch"
    shot: list[float] = Field(default_factory=list, max_length=64)
    against: list[float] = Field(default_factory=list, max_length=64)


FromPage = Annotated[
    Hello
    | Lead
    | Set
    | Arrange
    | Mute
    | Step
    | Save
    | Restore
    | Compare
    | Drag
    | Isolate
    | Sculpt
    | Unsculpt
    | Play
    | Against
    | Watch,
    Field(discriminator="kind"),
]
FROM_PAGE: TypeAdapter[FromPage] = TypeAdapter(FromPage)


# From the server


class Welcome(Message):
    """What a page needs to know before anything else.

    session: another one after every start of the server
    heard:   how many messages of a page of this name it has heard before
    schema:  JSON schemas of ``recipe`` and ``shot``
    pigments: hair colours by name: eumelanin, pheomelanin, roughness
    """

    kind: Literal["welcome"] = "welcome"
    version: int
    session: str
    heard: int
    name: str
    mode: Literal["recipe", "shot", "stage"]
    schemas: dict[str, Any]
    operators: list[str]
    pigments: dict[str, Point]


class Role(Message):
    """Who edits. ``others`` is the number of other pages that look at the session."""

    kind: Literal["role"] = "role"
    leads: bool
    others: int


class Files(Message):
    """What there is in the project to compare with, by name: recipes and caches. Told again when others are there."""

    kind: Literal["files"] = "files"
    names: list[str]


class Stage(Message):
    """A stage of the groom. place: where its settings are in the recipe."""

    name: str
    op: str
    place: Place
    muted: bool = False


class Change(Message):
    """A line of the file that is not as it was saved."""

    sign: Literal["+", "-", " "]
    line: str


class Document(Message):
    """A file as it stands.

    revision: grows with each change
    said:     what the file says; operators of a recipe that is extended have the places that they have in the whole
    values:   what holds, with all defaults, in SI units
    edits:    what its file of edits holds, where that is not saved
    """

    kind: Literal["document"] = "document"
    file: File
    name: str
    revision: int
    text: str
    edits: str
    said: dict[str, Any]
    values: dict[str, Any]
    stages: list[Stage]
    dirty: bool
    undo: bool
    redo: bool
    changes: list[Change]


class Body(Message):
    """A mesh of the scene, as the eye sees it. made_of: skin, eye, cloth or matte."""

    kind: Literal["body"] = "body"
    index: int
    name: str
    made_of: str
    color: Point
    arrays: ClassVar[dict[str, str]] = {"points": "f4", "triangles": "u4", "colors": "f4"}


class Locks(Message):
    """Where the locks are. side: a, or b for the look beside it.

    ``axis`` (locks, 3) is where the frame of each begins; ``marked`` is 1 for isolated ones.
    """

    kind: Literal["locks"] = "locks"
    side: Literal["a", "b"]
    draft: bool
    arrays: ClassVar[dict[str, str]] = {
        "points": "f4",
        "offsets": "i4",
        "ids": "f8",
        "axis": "f4",
        "marked": "u1",
    }


class Guides(Message):
    """Where the guides are; ``changed`` is 1 for those that were sculpted by hand."""

    kind: Literal["guides"] = "guides"
    middle: Point
    arrays: ClassVar[dict[str, str]] = {"points": "f4", "offsets": "i4", "changed": "u1"}


class Names(Message):
    """What settings may name: regions, maps and directions of the scalp, and helper curves."""

    kind: Literal["names"] = "names"
    regions: list[str]
    maps: list[str]
    vectors: list[str]
    curves: list[str]


class Hairs(Message):
    """How hairs sit in their locks; see ``src/ringlet/groom/hairs.h`` for the formula.

    Hairs come in an order of which every beginning is spread over all locks. ``profile``, ``hold``, ``blend`` and
    ``thinning`` run along all hairs; ``frizz`` has ``knots`` × 2 numbers a hair; ``root`` is from the lock's root to
    the hair's; ``width`` is the diameter of each, which ``thinning`` goes with.
    """

    kind: Literal["hairs"] = "hairs"
    side: Literal["a", "b"]
    count: int
    points: int
    knots: int
    arrays: ClassVar[dict[str, str]] = {
        "lock": "u4",
        "offset": "f4",
        "tip": "f4",
        "taper": "f4",
        "other": "i4",
        "share": "f4",
        "frizz": "f4",
        "root": "f4",
        "profile": "f4",
        "hold": "f4",
        "blend": "f4",
        "width": "f4",
        "thinning": "f4",
    }


class Numbers(Message):
    """What to keep in sight. revision: of the recipe that is shown; times: of the stages that were computed [ms]."""

    kind: Literal["numbers"] = "numbers"
    revision: int
    locks: int
    hairs: int
    groom_ms: float
    times: dict[str, float]
    draft: bool


class Measured(Message):
    """What is only measured at rest. inside: points of locks that are in the head.

    ``depth`` and ``nail`` are overlays: a byte for each point of the locks, 255 for all that is shown; empty for none.
    """

    kind: Literal["measured"] = "measured"
    inside: int
    arrays: ClassVar[dict[str, str]] = {"depth": "u1", "nail": "u1"}


class Frame(Message):
    """A frame of the shot or of a cache. layer: ``shot``, or ``against`` for the cache that it is compared with.

    ``drawn`` are hairs, in the order of ``Hairs``, that are drawn towards their lock, so as not to go through what it
    lies on, and ``left`` tells how much of their way from it is left at each of their points, 255 for all.
    ``stretch``, ``contact``, ``depth`` and ``curl`` are overlays (see ``Measured``); what is not known is empty.
    """

    kind: Literal["frame"] = "frame"
    layer: Literal["shot", "against"]
    frame: float
    statistics: dict[str, Any]
    arrays: ClassVar[dict[str, str]] = {
        "points": "f4",
        "axis": "f4",
        "root": "f4",
        "drawn": "u4",
        "left": "u1",
        "bodies": "f4",
        "stretch": "u1",
        "contact": "u1",
        "depth": "u1",
        "curl": "u1",
    }


class Timeline(Message):
    """What the simulation does, and which frames there are to see: of the shot, and of the cache beside it.

    key: another one when frames have become void
    """

    kind: Literal["timeline"] = "timeline"
    first: float
    last: float
    fps: float
    state: Literal["none", "still", "rolling", "running", "paused", "done"]
    rolled: int
    preroll: int
    key: int
    against: str = ""
    arrays: ClassVar[dict[str, str]] = {"frames": "f8", "beside": "f8"}


class Compared(Message):
    """What is shown beside the look that is edited; nothing for no name."""

    kind: Literal["compared"] = "compared"
    name: str


class Heard(Message):
    """How many messages of a page of this name were heard: what they asked for was done, begun or refused."""

    kind: Literal["heard"] = "heard"
    count: int


class Saved(Message):
    """A file was written."""

    kind: Literal["saved"] = "saved"
    name: str


class Trouble(Message):
    """Something that cannot be, in one line."""

    kind: Literal["trouble"] = "trouble"
    message: str


FROM_SERVER: tuple[type[Message], ...] = (
    Welcome,
    Role,
    Files,
    Document,
    Body,
    Locks,
    Guides,
    Names,
    Hairs,
    Numbers,
    Measured,
    Frame,
    Timeline,
    Compared,
    Heard,
    Saved,
    Trouble,
)
