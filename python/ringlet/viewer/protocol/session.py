"""Messages of the server with the state of the session: its pages, files and timeline, and answers to a page."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

from pydantic import Field

from ringlet.viewer.protocol.lights import Rig
from ringlet.viewer.protocol.message import File, Message, Place, Point, Shared, Side


class Welcome(Message):
    """First message of the server.

    session:  id of the server's run
    heard:    number of messages that the server has handled for pages of this name
    schemas:  JSON schemas of ``recipe`` and ``shot``
    recovered: whether the server recovered what pages of an earlier run had not saved
    colors:   linear reflectance in red, green and blue, roughness and azimuthal roughness, of each hair colour
    rigs:     light rigs of pictures, by name; HDRIs by their path
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
    colors: dict[str, tuple[float, float, float, float, float]]
    rigs: dict[str, Rig]


class LockMotion(Message):
    """Words of motion of a lock, by its id, or why it has none."""

    kind: Literal["lock_motion"] = "lock_motion"
    lock: int
    text: str


class Person(Message):
    """A person at a connected page.

    hue:     number of their color, from 0
    leads:   whether their page holds the edit lock
    follows: whether their page shows what the leading page looks at
    you:     whether it is the page that receives the message
    """

    name: str
    hue: int
    leads: bool
    follows: bool
    you: bool


class Role(Message):
    """Holder of the edit lock, and the people at the connected pages.

    asked:  whether another page asks this one for the lock
    asking: name of the person who asks this page; empty for none
    asks:   whether this page waits for the answer
    """

    kind: Literal["role"] = "role"
    leads: bool
    asked: bool = False
    asking: str = ""
    asks: bool = False
    people: list[Person]


class Pointer(Message):
    """Position of the leading page's pointer in the scene [m]; None where it is elsewhere."""

    kind: Literal["pointer"] = "pointer"
    at: Point | None


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


class KeptRun(Message):
    """An earlier take of the shot, by the number of its last run.

    first, last: its frames
    contact:     whether its hair touches; without contact it swings freely
    same_groom:  whether it is of the groom that is shown
    changes:     settings that differ from those of the shot, with their values
    """

    number: int
    first: float
    last: float
    contact: bool
    same_groom: bool
    changes: list[str]


class Timeline(Message):
    """State of the simulation, and the existing frames of the shot and of what it is compared with.

    key:   changes when existing frames become invalid
    runs:  number of the run that made each frame, from 1; 0 for frames of a file
    stale: 1 for frames of other settings than the present ones
    kept:  earlier takes, with other settings or of other grooms
    swings, against_swings: three numbers a frame, for frames of runs: mean speed of tips and of roots [m/s], and the
           estimated fraction of the converged motion; NaN where it is not known
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
    kept: list[KeptRun] = Field(default_factory=list)
    arrays: ClassVar[dict[str, str]] = {
        "frames": "f8",
        "against_frames": "f8",
        "runs": "i4",
        "stale": "u1",
        "swings": "f4",
        "against_swings": "f4",
    }


class Compared(Message):
    """A look that is compared; ``a`` is the open recipe.

    name:     of the groom or cache; empty for none
    detail:   author and time of a snapshot
    settings: those that its recipe sets, in the notation of TOML; empty for a cache
    take:     id of the snapshot whose take plays; empty for none
    """

    kind: Literal["compared"] = "compared"
    side: Side
    name: str
    detail: str = ""
    take: str = ""
    settings: dict[str, str] = Field(default_factory=dict)


class Heard(Message):
    """Number of messages that the server has handled for pages of this name."""

    kind: Literal["heard"] = "heard"
    count: int


class Saved(Message):
    """A file was written."""

    kind: Literal["saved"] = "saved"
    name: str


class SharePage(Message):
    """A share page, as UTF-8, to be kept as a file. hairs: number of its hairs, of the ``of`` of the look."""

    kind: Literal["share_page"] = "share_page"
    name: str
    hairs: int
    of: int
    arrays: ClassVar[dict[str, str]] = {"text": "u1"}


class Notice(Message):
    """A short message of what has happened."""

    kind: Literal["notice"] = "notice"
    message: str


class Trouble(Message):
    """An error message of one line, for a request that was refused."""

    kind: Literal["trouble"] = "trouble"
    message: str


class Progress(Message):
    """Progress of a groom that takes long. done: fraction of the stage; an empty stage ends it."""

    kind: Literal["progress"] = "progress"
    stage: str
    done: float
