"""The messages between page and server, in one place.

A message is a JSON header followed by arrays (see ``wire``). ``tools/make_protocol.py`` generates the TypeScript.
``arrays`` lists the arrays of a message with their types; all lengths are in metres. Positions are relative to
``Groom.origin``, near the head, since pages have single precision.
"""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter

from ringlet.data import limits

VERSION = 8
MOST_TEXT = 1_800_000  # characters of a file

Place = list[str | int]  # path of a setting in its file: ["shape", 0, "amount"]
File = Literal["recipe", "shot"]
Point = tuple[float, float, float]
Id = Annotated[int, Field(ge=-limits.ID, le=limits.ID)]
Row = Annotated[int, Field(ge=0, le=1_000_000)]
Gesture = Annotated[int, Field(ge=-limits.ID, le=limits.ID)]
FrameNumber = Annotated[float, Field(ge=-limits.FRAME, le=limits.FRAME)]
Coordinate = Annotated[float, Field(ge=-1e6, le=1e6)]  # [m]
Position = tuple[Coordinate, Coordinate, Coordinate]


class Message(BaseModel):
    """Base of all messages; ``kind`` is the type."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)
    arrays: ClassVar[dict[str, str]] = {}


# From the page


class Hello(Message):
    """First message of a page.

    client: name that the page keeps when it reconnects
    leads:  whether it held the edit lock when it was connected last
    """

    kind: Literal["hello"] = "hello"
    version: Row
    client: str = Field(max_length=64)
    leads: bool = False


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
    changes: list[tuple[Place, Any]] = Field(max_length=256)
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

    anyway: saves a recipe whose groom cannot be made
    """

    kind: Literal["save"] = "save"
    file: File = "recipe"
    name: str = Field(default="", max_length=120)
    variant: bool = False
    anyway: bool = False


class Open(Message):
    """Opens another recipe, shot or USD file of the project in the session.

    discard: discards unsaved changes; without it, they keep the file open
    """

    kind: Literal["open"] = "open"
    name: str = Field(max_length=240)
    discard: bool = False


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
    """Shows a second groom for comparison: a snapshot, the saved one, another recipe of the project, or none."""

    kind: Literal["compare"] = "compare"
    to: Literal["now", "saved", "file", "none"]
    name: str = Field(default="", max_length=240)


class Drag(Message):
    """Drags a point of an isolated lock to a position [m]."""

    kind: Literal["drag"] = "drag"
    lock: Id
    point: Row
    to: Position
    reach: float = Field(default=0.2, ge=0.0, le=1.0)
    gesture: Gesture
    resting: bool = True


class Isolate(Message):
    """Isolates locks from the procedural groom for manual edits, or returns them."""

    kind: Literal["isolate"] = "isolate"
    locks: list[Id] = Field(max_length=10_000)
    out: bool = True


class Sculpt(Message):
    """Moves a brush over the guides, or returns guides to the recipe.

    at, by:   position of the brush, and its displacement since the last message of this gesture [m]
    radius:   radius of the brush [m]
    mirrored: whether a mirror image of the brush acts on the other side of the head
    strength: fraction of its displacement that the brush moves what is at its centre
    falloff:  of the strength towards the radius: smooth, sharp (steep at the centre) or flat (none)

    ``freeze`` protects guides from all brushes, ``thaw`` ends that; neither is stored in the file.
    """

    kind: Literal["sculpt"] = "sculpt"
    tool: Literal["grab", "comb", "smooth", "cut", "lengthen", "return", "freeze", "thaw"]
    at: Position
    by: Position
    radius: float = Field(gt=0.0, le=1.0)
    mirrored: bool = False
    strength: float = Field(default=1.0, gt=0.0, le=1.0)
    falloff: Literal["smooth", "sharp", "flat"] = "smooth"
    gesture: Gesture
    resting: bool = True


class Shared(Message):
    """How the leading page looks at the groom.

    camera: position and target [m], six numbers
    light, color, overlay: their choices on the page; empty for none
    file, place: the stage whose settings are shown
    locks:  ids of the chosen locks
    frame:  the frame that is seen; None without a timeline
    """

    camera: list[Coordinate] = Field(min_length=6, max_length=6)
    light: str = Field(max_length=64)
    color: str = Field(max_length=64)
    overlay: str = Field(max_length=64)
    file: File
    place: Place = Field(max_length=8)
    locks: list[Id] = Field(max_length=10_000)
    frame: FrameNumber | None


class Look(Shared):
    """Shares the look of the leading page with those that follow."""

    kind: Literal["look"] = "look"


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
    """Shows the frames of another cache of the project for comparison; an empty name removes them."""

    kind: Literal["against"] = "against"
    name: str = Field(default="", max_length=240)


class Watch(Message):
    """Requests frames, the current one first; replaces earlier requests that are still pending."""

    kind: Literal["watch"] = "watch"
    shot: list[FrameNumber] = Field(default_factory=list, max_length=64)
    against: list[FrameNumber] = Field(default_factory=list, max_length=64)


FromPage = Annotated[
    Hello
    | Lead
    | Set
    | Arrange
    | Choose
    | Mute
    | Step
    | Save
    | Open
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
    | Look
    | Hand
    | Play
    | Against
    | Watch,
    Field(discriminator="kind"),
]
FROM_PAGE: TypeAdapter[FromPage] = TypeAdapter(FromPage)


# From the server


class Welcome(Message):
    """First message of the server.

    session:  id of the server's run
    heard:    number of messages that the server has handled for pages of this name
    schemas:  JSON schemas of ``recipe`` and ``shot``
    recovered: whether the server recovered what pages of an earlier run had not saved
    colors:   linear reflectance in red, green and blue, and roughness, of each hair colour
    """

    kind: Literal["welcome"] = "welcome"
    version: int
    session: str
    heard: int
    name: str
    mode: Literal["recipe", "shot", "stage"]
    schemas: dict[str, Any]
    operators: list[str]
    recovered: bool
    colors: dict[str, tuple[float, float, float, float]]


class Role(Message):
    """Holder of the edit lock.

    others: number of other connected pages
    asked:  whether another page asks this one for the lock
    asks:   whether this page waits for the answer
    """

    kind: Literal["role"] = "role"
    leads: bool
    others: int
    asked: bool = False
    asks: bool = False


class Followed(Shared):
    """The look of the leading page."""

    kind: Literal["followed"] = "followed"


class Files(Message):
    """Names of the recipes and caches of the project; sent again when they change."""

    kind: Literal["files"] = "files"
    names: list[str]


class Stage(Message):
    """A stage of the groom. place: path of its settings in the recipe."""

    name: str
    op: str
    place: Place
    muted: bool = False
    solo: bool = False


class Change(Message):
    """A line of the diff against the saved file."""

    sign: Literal["+", "-", " "]
    line: str


class Document(Message):
    """Current state of a file.

    revision: counter of changes
    said:     contents of the file; operators inherited from a base have their index in the resolved recipe
    values:   values of all settings, defaults included, in SI units
    edits:    unsaved text of its file of edits
    saved, saved_edits: the texts as they were read or saved last; empty where they are ``text`` and ``edits``
    grooms:   names of several grooms; ``said``, ``values`` and ``stages`` are those of ``groom``, the chosen one
    """

    kind: Literal["document"] = "document"
    file: File
    name: str
    revision: int
    text: str
    edits: str
    saved: str
    saved_edits: str
    said: dict[str, Any]
    values: dict[str, Any]
    stages: list[Stage]
    grooms: list[str]
    groom: str
    dirty: bool
    undo: bool
    redo: bool
    changes: list[Change]


class Body(Message):
    """A mesh of the scene. made_of: its material: skin, eye, cloth or matte."""

    kind: Literal["body"] = "body"
    index: int
    name: str
    made_of: str
    color: Point
    arrays: ClassVar[dict[str, str]] = {"points": "f4", "triangles": "u4", "colors": "f4"}


class Locks(Message):
    """Positions of the locks. side: a, or b for the groom to compare with.

    ``axis`` (locks, 3) is the reference direction of each lock; ``marked`` is 1 for isolated locks.
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
    """Positions of the guides; ``changed`` is 1 for sculpted ones, ``frozen`` for those that brushes leave."""

    kind: Literal["guides"] = "guides"
    middle: Point
    arrays: ClassVar[dict[str, str]] = {"points": "f4", "offsets": "i4", "changed": "u1", "frozen": "u1"}


class Names(Message):
    """Valid names in settings: regions, maps and directions of the scalp, and helper curves."""

    kind: Literal["names"] = "names"
    regions: list[str]
    maps: list[str]
    vectors: list[str]
    curves: list[str]


class Hairs(Message):
    """Hairs relative to their locks; see ``src/ringlet/groom/hairs.h`` for the formula.

    Any prefix of the hairs covers all locks evenly. ``profile``, ``hold``, ``pace``, ``blend`` and ``thinning`` are
    functions along the hairs of each groom, one groom after another; ``group`` is the groom of a hair. ``frizz`` has
    ``knots`` × 2 numbers a hair; ``root`` is the offset from the lock's root to the hair's. The diameter is ``width``
    of the hair times ``thinning``. The arrays from ``window`` on are those of the curl of hairs; empty where these only
    follow their lock.
    """

    kind: Literal["hairs"] = "hairs"
    side: Literal["a", "b"]
    count: int
    points: int
    knots: int
    arrays: ClassVar[dict[str, str]] = {
        "lock": "u4",
        "group": "u1",
        "offset": "f4",
        "tip": "f4",
        "join": "f4",
        "flat": "f4",
        "taper": "f4",
        "other": "i4",
        "share": "f4",
        "frizz": "f4",
        "root": "f4",
        "profile": "f4",
        "hold": "f4",
        "pace": "f4",
        "blend": "f4",
        "width": "f4",
        "thinning": "f4",
        "window": "i4",
        **dict.fromkeys(("slip", "escape", "relax", "family", "coil", "phase"), "f4"),
        **dict.fromkeys(("escaping", "relaxing", "tight", "opening"), "f4"),
    }


class Colors(Message):
    """Colours of the hairs, in the order of ``Hairs``; none where the groom has no colour.

    ``reflectance`` holds red, green and blue of each of the ``stations`` of each hair, evenly spaced from root to tip:
    the fourth root of the linear reflectance (``ringlet.data.pigment``), times 255. tilt: of the cuticle [degrees].
    """

    kind: Literal["colors"] = "colors"
    side: Literal["a", "b"]
    stations: int
    roughness: float
    tilt: float
    arrays: ClassVar[dict[str, str]] = {"reflectance": "u1"}


class Numbers(Message):
    """Statistics of the groom. revision: of the displayed recipe; times: times of the computed stages [ms]."""

    kind: Literal["numbers"] = "numbers"
    revision: int
    locks: int
    hairs: int
    groom_ms: float
    times: dict[str, float]
    draft: bool


class Measured(Message):
    """Measurements of a groom that is not a draft. inside: number of lock points in the head.

    ``depth`` and ``nail`` are overlays: a byte for each point of the locks, 255 for the end of the scale; empty for
    none.
    """

    kind: Literal["measured"] = "measured"
    inside: int
    arrays: ClassVar[dict[str, str]] = {"depth": "u1", "nail": "u1"}


class Frame(Message):
    """A frame of the shot or of a cache. layer: ``shot``, or ``against`` for the cache to compare with.

    ``drawn`` lists hairs, in the order of ``Hairs``, that are pulled towards their lock to stay out of bodies. ``left``
    is the fraction of their offset that remains at each of their points, 255 for all of it. ``stretch``, ``contact``,
    ``depth`` and ``curl`` are overlays (see ``Measured``); an unknown one is empty.
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
    """State of the simulation, and the existing frames of the shot and of the cache to compare with.

    key:   changes when existing frames become invalid
    runs:  number of the run that made each frame, from 1; 0 for frames of a file
    stale: 1 for frames of other settings than the present ones
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
    arrays: ClassVar[dict[str, str]] = {"frames": "f8", "beside": "f8", "runs": "i4", "stale": "u1"}


class Compared(Message):
    """Name of the groom or cache to compare with; empty for none."""

    kind: Literal["compared"] = "compared"
    name: str


class Heard(Message):
    """Number of messages that the server has handled for pages of this name."""

    kind: Literal["heard"] = "heard"
    count: int


class Saved(Message):
    """A file was written."""

    kind: Literal["saved"] = "saved"
    name: str


class Notice(Message):
    """A short message of what has happened."""

    kind: Literal["notice"] = "notice"
    message: str


class Trouble(Message):
    """An error message of one line, for a request that was refused."""

    kind: Literal["trouble"] = "trouble"
    message: str


class Fix(Message):
    """A remedy of a problem: a button, and the message of the page that it sends."""

    label: str
    message: dict[str, Any]


class Difference(Message):
    """A setting of a file whose value on disk (theirs) differs from that of the session (mine).

    base: value in their common ancestor
    both: whether both changed it
    """

    name: str
    base: str
    mine: str
    theirs: str
    both: bool


class Problem(Message):
    """What stands in the way, until it is gone.

    subject:     ``groom`` for a groom that cannot be made; the page then marks the look that it shows
    file:        file of ``setting``, or of the conflict
    setting:     name of the setting that is wrong; empty for none
    differences: of a conflict with the version on disk
    """

    subject: str
    message: str
    file: File
    setting: str
    fixes: list[Fix]
    differences: list[Difference]


class Problems(Message):
    """All problems of the session."""

    kind: Literal["problems"] = "problems"
    problems: list[Problem]


class Progress(Message):
    """Progress of a groom that takes long. done: fraction of the stage; an empty stage ends it."""

    kind: Literal["progress"] = "progress"
    stage: str
    done: float


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
    Colors,
    Numbers,
    Measured,
    Frame,
    Timeline,
    Compared,
    Heard,
    Saved,
    Notice,
    Followed,
    Trouble,
    Problems,
    Progress,
)
