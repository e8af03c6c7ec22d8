"""The requests of hosts, checked."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

from ringlet.data import limits
from ringlet.data.explain import explain
from ringlet.data.settings import check_texts

Name = Annotated[str, Field(pattern=r"^[^/\\:]*[^./\\:][^/\\:]*$", max_length=120)]  # of a file in the folder
Place = Annotated[list[str | Annotated[int, Field(ge=0)]], Field(min_length=1, max_length=20)]
Frame = Annotated[int, Field(ge=-limits.FRAME, le=limits.FRAME)]
Share = Annotated[float, Field(ge=0.001, le=1.0)]


class Part(BaseModel):
    """A part of a request; unknown keys are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class SetValue(Part):
    """Sets the value of a setting; null removes the setting, and its default counts."""

    set: Place
    value: Any = None


class AddTable(Part):
    """Adds a row to an array of tables, such as an operator to ``shape``."""

    add: Literal["shape"]
    at: int = Field(ge=0)
    entry: dict[str, Any]


class RemoveTable(Part):
    """Removes a row of an array of tables."""

    remove: Literal["shape"]
    at: int = Field(ge=0)


class MoveTable(Part):
    """Moves a row of an array of tables."""

    move: Literal["shape"]
    at: int = Field(ge=0)
    to: int = Field(ge=0)


Change = SetValue | AddTable | RemoveTable | MoveTable


class Text(Part):
    """A recipe or a shot: the name of its file in the folder, its text, and changes to the text.

    overlay: changes that count besides, and are in the file, but not in the text of the answer
    """

    name: Name
    text: str = Field(max_length=10_000_000)
    changes: list[Change] = []
    overlay: list[Change] = []


class Surface(Part):
    """A mesh of ``write_meshes``; its arrays begin with its row, ``0/points``.

    subdivided: whether it is the cage of a Catmull-Clark surface
    """

    name: str = Field(min_length=1, max_length=200)
    subdivided: bool = False


class Request(Part):
    """A request. id: a number that its answers have"""

    id: int


class InFolder(Request):
    """A request about files in a folder; relative names in texts count from there."""

    folder: Path


class Hello(Request):
    """Answers with version, the version of these messages, and the names of the looks that come with Ringlet."""

    do: Literal["hello"]


class Look(Request):
    """Answers with the text of a recipe that comes with Ringlet."""

    do: Literal["look"]
    name: str


class WriteMeshes(InFolder):
    """Writes polygon meshes to a USD file of the folder.

    meters_per_unit, up_axis, fps: of the points and of the file
    first_frame:                   of ``k/motion``
    """

    do: Literal["write_meshes"]
    file: Name
    meshes: list[Surface] = Field(min_length=1)
    meters_per_unit: float = Field(default=1.0, ge=1e-9, le=1e6)
    up_axis: Literal["Y", "Z"] = "Y"
    fps: float = Field(default=24.0, ge=1e-2, le=1e5)
    first_frame: Frame = 1


class WriteCurves(InFolder):
    """Writes curves to a USD file of the folder, as drawn guides or as curves that operators go by."""

    do: Literal["write_curves"]
    file: Name
    meters_per_unit: float = Field(default=1.0, ge=1e-9, le=1e6)
    up_axis: Literal["Y", "Z"] = "Y"


class Edit(InFolder):
    """Applies the changes of a text, writes its file, and answers with the new text and all settings."""

    do: Literal["edit"]
    kind: Literal["recipe", "shot"]
    text: Text


class Groom(InFolder):
    """``edit`` of a recipe; then makes the groom and answers with its curves."""

    do: Literal["groom"]
    recipe: Text
    hairs: Share | None = Field(default=None, description="fraction of the hairs to make; null: none")


class WriteGroom(InFolder):
    """Writes the groom of a recipe as USD, with further recipes as variants by the name of their files."""

    do: Literal["write_groom"]
    recipe: Text
    file: Name
    variants: list[Text] = []


class Simulate(InFolder):
    """Writes recipe, shot and groom, and simulates to the USD file ``cache`` of the folder.

    resume: goes on with a run that was canceled or killed
    """

    do: Literal["simulate"]
    recipe: Text
    shot: Text
    cache: Name = "cache.usdc"
    resume: bool = False


class Hairs(InFolder):
    """Writes the hairs of a cache to the USD file ``file`` of the folder."""

    do: Literal["hairs"]
    cache: Name = "cache.usdc"
    file: Name = "hair.usdc"
    fraction: Share = 1.0
    velocities: bool = False


class Cancel(Request):
    """Cancels a request, which is then answered with ``canceled``; one that was answered is left alone."""

    do: Literal["cancel"]
    request: int


AnyRequest = Hello | Look | WriteMeshes | WriteCurves | Edit | Groom | WriteGroom | Simulate | Hairs | Cancel
_REQUEST: TypeAdapter[AnyRequest] = TypeAdapter(Annotated[AnyRequest, Field(discriminator="do")])


def parse_request(header: dict[str, Any]) -> AnyRequest:
    """Checks a request; raises UserError with the wrong entry."""
    check_texts(header, "request")
    try:
        return _REQUEST.validate_python(header)
    except ValidationError as error:
        raise explain(error, "request", header) from None
