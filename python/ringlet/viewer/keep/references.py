"""Reference pictures of a look: ``references/ID.toml`` says where a picture is shown, ``ID.png`` or ``.jpg`` is it."""

from __future__ import annotations

from pydantic import BaseModel

from ringlet.data.errors import UserError
from ringlet.viewer.keep.review_entries import Entries
from ringlet.viewer.keep.review_folder import FORMATS, ReviewFolder, decode_picture
from ringlet.viewer.protocol import AddReference, Placement, PlaceReference, Reference

NEXT = Placement(mode="next", x=-0.35, scale=0.45)  # on the left of the look, which stays in sight
PLACEMENT = tuple(Placement.model_fields)


class Stored(BaseModel):
    """Contents of the file of a reference picture. suffix: of the file of the picture."""

    name: str = ""
    suffix: str = ".png"
    placement: Placement = Placement()


class ReferenceStore(Entries[Stored]):
    """The reference pictures of a recipe, by id, the oldest first."""

    def __init__(self, folder: ReviewFolder) -> None:
        super().__init__(folder, "reference", Stored, most=24, suffixes=tuple(FORMATS.values()))

    @property
    def references(self) -> list[Reference]:
        """All reference pictures, the oldest first."""
        return [Reference(id=id, name=one.name, **dict(one.placement)) for id, one in self.entries.items()]

    def picture(self, id: str) -> bytes:
        """File of a picture; raises UserError when there is none."""
        suffix = self[id].suffix
        if suffix not in FORMATS.values():
            raise UserError(f"reference: {id} is a {suffix} file; must be PNG or JPEG")
        return self.folder.bytes(self.file(id, suffix))

    def keep(self, message: AddReference) -> str:
        """Writes a picture, shown next to the look; returns its id. Raises UserError for no PNG or JPEG file."""
        data, suffix = decode_picture(message.picture, f"reference: {message.name or 'picture'}")
        id = self.new_id()
        self.folder.write_bytes(self.file(id, suffix), data)
        return self.add(Stored(name=message.name, suffix=suffix, placement=NEXT), id)

    def place(self, message: PlaceReference) -> None:
        """Shows a picture elsewhere."""
        placement = Placement.model_validate({name: getattr(message, name) for name in PLACEMENT})
        self.change(message.id, {"placement": placement})
