"""The recipe: the settings of a groom, as a TOML file."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, PrivateAttr, Tag, ValidationError, WithJsonSchema

from ringlet.data.lengths import UNITS
from ringlet.data.quantities import LengthUnit, Section, explain
from ringlet.groom.color import ColorSettings
from ringlet.groom.edge import Edge
from ringlet.groom.edits import Edit
from ringlet.groom.fiber import FiberSettings
from ringlet.groom.gradient import Gradient
from ringlet.groom.hair_settings import HairSettings
from ringlet.groom.helper_mesh import HelperMesh
from ringlet.groom.helpers import HelperCurves
from ringlet.groom.load import load, load_text, resolved_text
from ringlet.groom.named import GROOMS
from ringlet.groom.operators import Collide, Curl, Drawn, Grown, Locks, ShapeOperator
from ringlet.groom.pins import Pin
from ringlet.groom.sculpt import Sculpt
from ringlet.groom.source import Source

OF_FILE = ("ringlet", "name", "unit", GROOMS)  # settings that no groom of several has of its own


class ScalpSettings(Source):
    """The mesh that hair grows on."""

    file: str | None = Field(
        default=None, description="USD or OBJ file with the mesh, next to the recipe or with a full path"
    )
    mesh: str | None = Field(default=None, description="prim of the mesh; needed when the file has several")
    surface: Literal["limit", "cage"] = Field(
        default="limit",
        description="where hair is rooted on a subdivision surface: on its limit surface, which renderers show, or on "
        "its cage",
    )
    region: str | None = Field(default=None, description="named faces (GeomSubset) that carry hair; all when absent")
    hide: list[str] = Field(
        default=[],
        description="prims of its USD file that this hair replaces, such as modelled brows: not shown, and nothing "
        "touches them",
    )
    edge: Edge | None = Field(
        default=None, description="lines that carry hair, as for lashes and brows; the whole area when absent"
    )


def _kind_of_guides(data: Any) -> str:
    return "drawn" if isinstance(data, Drawn) or (isinstance(data, dict) and "file" in data) else "grown"


class Recipe(Section):
    """A groom from guides to hairs. Inside, lengths are in metres."""

    ringlet: Literal[2] = Field(description="version of the format")
    name: str = Field(default="", description="what the groom is called")
    seed: int = Field(default=1, ge=0, le=2**31, description="another seed gives another head of hair of the same kind")
    unit: LengthUnit = Field(default="cm", description="unit of lengths that are plain numbers")
    extends: str | None = Field(
        default=None,
        description="another recipe that this one changes: tables are merged, `false` removes a table or a value, "
        "`[shape.NAME]` changes an operator, `[[shape.append]]` adds one",
    )
    edits: str | None = Field(
        default=None,
        description="file of manual edits of locks and guides, next to the recipe; `ringlet edit` and `ringlet "
        "view` write it",
    )
    scalp: ScalpSettings = Field(default=ScalpSettings(), description="the surface that hair grows on")
    maps: dict[str, str] = Field(
        default={}, description="pictures over the texture coordinates of the scalp, as maps by name: black 0, white 1"
    )
    gradients: dict[str, Gradient] = Field(
        default={}, description="maps by name that are computed from the height of roots, or their distance from lines"
    )
    curves: dict[str, HelperCurves] = Field(
        default={}, description="helper curves by name, which guides and operators refer to"
    )
    meshes: dict[str, HelperMesh] = Field(default={}, description="helper meshes by name, which operators refer to")
    guides: Annotated[
        Annotated[Grown, Tag("grown")] | Annotated[Drawn, Tag("drawn")], Discriminator(_kind_of_guides)
    ] = Field(
        default=Grown(), description="the curves that give silhouette and length: grown, or drawn and read from a file"
    )
    sculpt: list[Sculpt] = Field(default=[], description="manual edits of single guides")
    locks: Locks = Field(default=Locks(), description="the locks between the guides")
    shape: list[ShapeOperator] = Field(default=[], description="operators on the shape of the locks, in order")
    curl: Curl | None = Field(default=None, description="the curl; straight hair when absent")
    edit: list[Edit] = Field(default=[], description="manual edits of single locks")
    pin: list[Pin] = Field(default=[], description="hair that is held to the skin")
    collide: Collide = Field(default=Collide(), description="keeps locks out of the head and of what is worn")
    hairs: HairSettings = Field(default=HairSettings(), description="the hairs of each lock")
    color: ColorSettings | None = Field(default=None, description="colour of the hair; files have none when absent")
    fiber: FiberSettings | None = Field(
        default=None, description="optics and cross-section of a hair; those of its colour when absent"
    )
    grooms: Annotated[dict[str, Recipe], WithJsonSchema({"type": "object"})] = Field(
        default={},
        description="several grooms on one head, such as scalp hair, brows and lashes: each is a recipe of its "
        "own, may extend another, and takes what it does not set from outside of `[grooms]`. One "
        "groom when absent",
    )

    _path: Path | None = PrivateAttr(None)
    _text: str | None = PrivateAttr(None)

    @property
    def path(self) -> Path | None:
        """File of the recipe; None for a recipe from text alone."""
        return self._path

    @property
    def text(self) -> str | None:
        """Text of the recipe."""
        return self._text

    @property
    def scalp_file(self) -> Path | None:
        """File of the scalp; a relative name is resolved against the recipe's folder."""
        return self._beside(self.scalp.file)

    @property
    def edits_file(self) -> Path | None:
        """File of manual edits."""
        return self._beside(self.edits)

    @property
    def guides_file(self) -> Path | None:
        """File of drawn guides; None when guides are grown."""
        return self._beside(self.guides.file) if isinstance(self.guides, Drawn) else None

    def helper_files(self) -> dict[str, Path]:
        """Files of helper curves, by name of the curves."""
        return {name: file for name, curves in self.curves.items() if (file := self._beside(curves.file)) is not None}

    def mesh_files(self) -> dict[str, Path]:
        """Files of helper meshes, by name of the mesh."""
        return {name: file for name, mesh in self.meshes.items() if (file := self._beside(mesh.file)) is not None}

    def map_files(self) -> dict[str, Path]:
        """Texture files of maps, by name of the map."""
        return {name: file for name, text in self.maps.items() if (file := self._beside(text)) is not None}

    @property
    def offsets_file(self) -> Path | None:
        """File of adopted hairs; None when hairs are made by the settings."""
        return self._beside(self.hairs.file)

    def named_files(self) -> dict[str, Path]:
        """Files that the recipe names, by setting."""
        if self.grooms:
            return {
                f"{GROOMS}.{name}.{what}": file
                for name, one in self.grooms.items()
                for what, file in one.named_files().items()
            }
        files = {"scalp.file": self.scalp_file, "guides.file": self.guides_file, "edits": self.edits_file}
        files["hairs.file"] = self.offsets_file
        files |= {f"maps.{name}": file for name, file in self.map_files().items()}
        files |= {f"curves.{name}": file for name, file in self.helper_files().items()}
        files |= {f"meshes.{name}": file for name, file in self.mesh_files().items()}
        return {what: file for what, file in files.items() if file is not None}

    def _beside(self, name: str | None) -> Path | None:
        return (self._path.parent if self._path else Path()) / name if name else None


def read_recipe(path: Path | str) -> Recipe:
    """Reads a recipe file; raises UserError with file, setting, value and remedy."""
    path = Path(path)
    return _recipe(*load(path), path)


def parse_recipe(text: str, path: Path | None = None, edits: str | None = None) -> Recipe:
    """Parses the text of a recipe.

    path:  file of the recipe, for messages and for relative file names
    edits: text that replaces the contents of the file of edits
    """
    return _recipe(*load_text(text, path, edits), path)


def _recipe(text: str, data: dict[str, Any], path: Path | None) -> Recipe:
    unit = data.get("unit", "cm")
    try:
        recipe = Recipe.model_validate(data, context={"unit": UNITS.get(unit, 1.0) if isinstance(unit, str) else 1.0})
    except ValidationError as error:
        raise explain(error, path.name if path else "recipe", data) from error
    recipe._path, recipe._text = path, text
    for name, groom in recipe.grooms.items():
        groom._path, groom._text = path, resolved_text(data[GROOMS][name])
    return recipe


def schema() -> dict[str, Any]:
    """The JSON schema of a recipe: types, bounds, units, defaults and descriptions of all settings."""
    found = Recipe.model_json_schema()
    of_groom = {name: {"$ref": f"#/properties/{name}"} for name in found["properties"] if name not in OF_FILE}
    found["properties"][GROOMS]["additionalProperties"] = {
        "type": "object",
        "additionalProperties": False,
        "properties": of_groom,
    }
    return found
