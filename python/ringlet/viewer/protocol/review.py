"""Messages about what is kept next to a recipe: snapshots, notes, reference pictures and bookmarks."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from ringlet.viewer.protocol.message import EntryId, Id, Message, Position, Row, Shared

MOST_PICTURE = 6_000_000  # characters of a picture in base64
Small = Annotated[float, Field(ge=-100.0, le=100.0)]
Author = Annotated[str, Field(max_length=80)]
Text = Annotated[str, Field(max_length=4000)]
Stroke = Annotated[list[tuple[Small, Small]], Field(min_length=1, max_length=2000)]


class Placement(Message):
    """Where a reference picture is.

    mode:    ``next`` to the look, ``over`` it, or ``off``
    opacity: over the look, from 0 to 1
    x, y:    its middle from that of the picture, to the right and up, in heights of the picture
    scale:   its height, in heights of the picture
    """

    mode: Literal["off", "next", "over"] = "off"
    opacity: float = Field(default=0.5, ge=0.0, le=1.0)
    x: Small = 0.0
    y: Small = 0.0
    scale: float = Field(default=0.8, ge=0.02, le=20.0)


# Of pages


class TakeSnapshot(Message):
    """Takes a snapshot of the current look. picture: PNG or JPEG in base64."""

    kind: Literal["take_snapshot"] = "take_snapshot"
    author: Author = ""
    note: Text = ""
    look: Shared
    picture: str = Field(max_length=MOST_PICTURE)


class KeepTake(Message):
    """Keeps the last seconds of live hair as a snapshot. picture: PNG or JPEG in base64."""

    kind: Literal["keep_take"] = "keep_take"
    author: Author = ""
    note: Text = ""
    look: Shared
    picture: str = Field(max_length=MOST_PICTURE)


class MakeShot(Message):
    """Writes a shot with the motion of a take, opens it and starts it, compared with the take.

    id:   of the snapshot
    name: of the new files; empty for one that is not there yet
    """

    kind: Literal["make_shot"] = "make_shot"
    id: EntryId
    name: str = Field(default="", max_length=120)


class EditSnapshot(Message):
    """Changes the note of a snapshot."""

    kind: Literal["edit_snapshot"] = "edit_snapshot"
    id: EntryId
    note: Text


class LoadSnapshot(Message):
    """Sets the recipe to a snapshot, as one undo step."""

    kind: Literal["load_snapshot"] = "load_snapshot"
    id: EntryId


class DeleteSnapshot(Message):
    """Deletes the files of a snapshot."""

    kind: Literal["delete_snapshot"] = "delete_snapshot"
    id: EntryId


class WriteNote(Message):
    """Writes a note about what is seen.

    at:      place on the hair that it is pinned to [m]; None for the view alone
    lock:    id of the lock there; None for none
    point:   of the lock, from its root
    strokes: lines that were drawn over the picture: points from its middle, to the right and up, in heights of the
             picture
    """

    kind: Literal["write_note"] = "write_note"
    author: Author = ""
    text: Text
    look: Shared
    at: Position | None = None
    lock: Id | None = None
    point: Row = 0
    strokes: list[Stroke] = Field(default_factory=list, max_length=200)


class EditNote(Message):
    """Changes the text of a note, or whether it is resolved; None leaves it as it is."""

    kind: Literal["edit_note"] = "edit_note"
    id: EntryId
    text: Text | None = None
    resolved: bool | None = None


class DeleteNote(Message):
    """Deletes a note."""

    kind: Literal["delete_note"] = "delete_note"
    id: EntryId


class AddReference(Message):
    """Keeps a reference picture. picture: PNG or JPEG in base64."""

    kind: Literal["add_reference"] = "add_reference"
    name: str = Field(max_length=120)
    picture: str = Field(max_length=MOST_PICTURE)


class PlaceReference(Placement):
    """Shows a reference picture next to the look, over it, or not."""

    kind: Literal["place_reference"] = "place_reference"
    id: EntryId


class DeleteReference(Message):
    """Deletes a reference picture."""

    kind: Literal["delete_reference"] = "delete_reference"
    id: EntryId


class KeepView(Message):
    """Keeps a look for the recipe: in bookmark 1 to 9, or as the one with which the review opens (0)."""

    kind: Literal["keep_view"] = "keep_view"
    slot: int = Field(ge=0, le=9)
    look: Shared


class PickColor(Message):
    """Sets melanin and redness of the recipe so that its hair has a color. color: sRGB, ``#rrggbb``."""

    kind: Literal["pick_color"] = "pick_color"
    color: str = Field(pattern=r"^#[0-9a-fA-F]{6}$")


AnyReview = (  # of any page
    TakeSnapshot
    | EditSnapshot
    | DeleteSnapshot
    | WriteNote
    | EditNote
    | DeleteNote
    | AddReference
    | PlaceReference
    | DeleteReference
    | KeepView
)
ReviewMessage = AnyReview | LoadSnapshot | PickColor


# Of the server


class Snapshot(Message):
    """A snapshot.

    time:    when it was taken, in ISO 8601
    seconds: of the take of live hair that it holds; 0 for none
    """

    id: EntryId
    author: Author
    note: Text
    time: str
    look: Shared
    seconds: float


class Snapshots(Message):
    """All snapshots of the recipe, the oldest first."""

    kind: Literal["snapshots"] = "snapshots"
    snapshots: list[Snapshot]


class Picture(Message):
    """A picture that is kept next to the recipe, such as ``snapshots/20260131-101530``: a PNG or JPEG file."""

    kind: Literal["picture"] = "picture"
    name: str
    arrays: ClassVar[dict[str, str]] = {"data": "u1"}


class Note(Message):
    """A note; see ``WriteNote``. time: when it was written, in ISO 8601."""

    id: EntryId
    author: Author
    text: Text
    time: str
    resolved: bool
    look: Shared
    at: Position | None
    lock: Id | None
    point: Row
    strokes: list[Stroke]


class Notes(Message):
    """All notes about the recipe, the oldest first."""

    kind: Literal["notes"] = "notes"
    notes: list[Note]


class Reference(Placement):
    """A reference picture; ``references/ID`` is its ``Picture``."""

    id: EntryId
    name: str


class References(Message):
    """All reference pictures, the oldest first."""

    kind: Literal["references"] = "references"
    references: list[Reference]


class Views(Message):
    """Kept looks by their bookmarks; ``0`` is the one with which the review opens."""

    kind: Literal["views"] = "views"
    views: dict[str, Shared]


class StageCamera(Message):
    """A camera of the scene: position and target at its first frame [m], and focal length for 36 mm of height [mm]."""

    name: str
    camera: list[float]
    focal_length: float


class Cameras(Message):
    """Cameras in the files of the scene."""

    kind: Literal["cameras"] = "cameras"
    cameras: list[StageCamera]
