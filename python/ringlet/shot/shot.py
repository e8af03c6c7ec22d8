"""The shot, a TOML file: its groom, frames, material, solver, forces, contact and cloth."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, PrivateAttr, ValidationError, ValidationInfo, field_validator

from ringlet.data import limits
from ringlet.data.explain import explain
from ringlet.data.limits import wrong_frames
from ringlet.data.settings import Section, parse_toml, read_toml, refuse
from ringlet.shot.cloth import ShotCloth
from ringlet.shot.contact import Collider, ShotContact
from ringlet.shot.material import Material
from ringlet.shot.motion import WORDS, WantedMotion
from ringlet.shot.rest import Rest
from ringlet.shot.solver import Solver
from ringlet.shot.variation import Variation

STAYS = {"separation_speed": 0.0, "creep_speed": 1e-5}  # defaults of contact in equilibrium with the groom [m/s]


FrameNumber = Annotated[int, Field(ge=-limits.FRAME, le=limits.FRAME)]
Strength = Annotated[float, Field(ge=-1000, le=1000)]


class Forces(Section):
    """External forces on the strands, in metres and Y-up whatever the files use."""

    gravity: tuple[Strength, Strength, Strength] = Field(default=(0.0, -9.81, 0.0), description="acceleration [m/s²]")
    wind: tuple[Strength, Strength, Strength] = Field(default=(0.0, 0.0, 0.0), description="velocity of the air [m/s]")


class Shot(Section):
    """A simulation of a groom on its animated scalp. SI units."""

    ringlet: Literal[2] = Field(description="version of the format")
    name: str = Field(default="", description="name of the shot")
    groom: Path = Field(
        description="recipe (.toml) or groom (.usdc, .usda, .usd); a relative name counts from the shot"
    )
    frames: tuple[FrameNumber, FrameNumber] = Field(description="first and last frame")
    preroll: int = Field(
        default=24,
        ge=0,
        le=100_000,
        description="frames simulated before the first, with the head still, so that hair settles; 0: the shot "
        "begins with the groom exactly",
    )
    held: int = Field(
        default=3,
        ge=2,
        le=1000,
        description="vertices of each lock, from its root, that the scalp holds; more hold its direction more firmly",
    )
    strands: Material = Field(default=Material(), description="material of the locks")
    motion: WantedMotion = Field(
        default=WantedMotion(), description="motion of the locks in words, instead of their stiffness and damping"
    )
    variation: Variation = Field(default=Variation(), description="variation of the material over locks and along them")
    rest: Rest = Field(default=Rest(), description="rest shape of the locks")
    solver: Solver = Field(default=Solver(), description="solution of a time step")
    forces: Forces = Field(default=Forces(), description="external forces")
    contact: ShotContact | None = Field(
        default=None, description="contact of locks; without this table they pass through everything"
    )
    collider: tuple[Collider, ...] = Field(
        default=(),
        description="meshes that locks touch; by default the head with all that is visible there",
    )
    cloth: tuple[ShotCloth, ...] = Field(default=(), description="cloth that moves with the locks and touches them")

    _path: Path | None = PrivateAttr(None)

    @field_validator("frames")
    @classmethod
    def _valid_frames(cls, frames: tuple[int, int]) -> tuple[int, int]:
        if wrong := wrong_frames(*frames):
            raise refuse(f"is {list(frames)}; {wrong}")
        return frames

    @field_validator("motion")
    @classmethod
    def _words_replace_material(cls, motion: WantedMotion, info: ValidationInfo) -> WantedMotion:
        given = info.data["strands"].model_fields_set if "strands" in info.data else ()
        for word in motion.given:
            if (setting := WORDS[word]) in given:
                by = f" by its preset {motion.preset}" if motion.preset else ""
                raise refuse(f"has {word}{by}, which is given instead of strands.{setting}; take one of them away")
        return motion

    @field_validator("rest")
    @classmethod
    def _groomed_locks_do_not_sag(cls, rest: Rest, info: ValidationInfo) -> Rest:
        sag = info.data["motion"].sag if "motion" in info.data else None
        if sag is not None and rest.mode != "none":
            raise refuse(
                f'has mode "{rest.mode}", in which locks hang as groomed, but motion.sag is {sag.value:g}; take that '
                'away, or set rest.mode = "none"'
            )
        return rest

    @field_validator("collider")
    @classmethod
    def _colliders_have_contact(cls, colliders: tuple[Collider, ...], info: ValidationInfo) -> tuple[Collider, ...]:
        if colliders and info.data.get("contact", True) is None:
            raise refuse("is there, but locks touch nothing; add a table [contact]")
        return colliders

    @field_validator("cloth")
    @classmethod
    def _cloths_have_contact(cls, cloths: tuple[ShotCloth, ...], info: ValidationInfo) -> tuple[ShotCloth, ...]:
        contact = info.data.get("contact")
        if cloths and "contact" in info.data and not (contact and contact.on):
            raise refuse(
                "is there, but nothing touches; add a table [contact]" + (" with on = true" if contact else "")
            )
        return cloths

    @property
    def touching(self) -> ShotContact | None:
        """The settings of contact, if it is on. In equilibrium it neither parts nor creeps, unless settings say so."""
        if not (self.contact and self.contact.on):
            return None
        stays = STAYS if self.rest.mode == "equilibrium" else {}
        given = self.contact.model_fields_set
        return self.contact.model_copy(update={name: value for name, value in stays.items() if name not in given})

    @property
    def rest_file(self) -> Path | None:
        """The file of the rest shape: ``rest.file``, or beside the shot, after its name."""
        if self.rest.file is not None:
            return self.rest.file
        return self._path and self._path.with_name(
            f"{self._path.name.removesuffix('.toml').removesuffix('.shot')}.rest.usdc"
        )

    def named_files(self) -> dict[str, Path]:
        """The files that the shot names, by their setting."""
        files = {"groom": self.groom, "rest.file": self.rest.file}
        files |= {f"collider[{k}].file": one.file for k, one in enumerate(self.collider)}
        files |= {f"cloth[{k}].file": one.file for k, one in enumerate(self.cloth)}
        return {what: file for what, file in files.items() if file is not None}

    @property
    def path(self) -> Path | None:
        """The file of the shot."""
        return self._path


def read_shot(path: Path | str) -> Shot:
    """Reads a shot file. Raises UserError with file, setting, value and remedy."""
    path = Path(path)
    _, data = read_toml(path, "shot")
    return _shot(data, path)


def parse_shot(text: str, path: Path | None = None) -> Shot:
    """A shot from its text; ``path`` names it in messages, and relative file names are relative to it."""
    return _shot(parse_toml(text, path.name if path else "shot", "shot"), path)


def _shot(data: dict[str, Any], path: Path | None) -> Shot:
    try:
        shot = Shot.model_validate(data)
    except ValidationError as error:
        raise explain(error, path.name if path else "shot", data) from error
    folder = path.parent if path else Path()
    rest = shot.rest.model_copy(update={"file": shot.rest.file and folder / shot.rest.file})
    colliders = tuple(one.model_copy(update={"file": one.file and folder / one.file}) for one in shot.collider)
    cloths = tuple(one.model_copy(update={"file": one.file and folder / one.file}) for one in shot.cloth)
    shot = shot.model_copy(update={"groom": folder / shot.groom, "rest": rest, "collider": colliders, "cloth": cloths})
    shot._path = path
    return shot


def schema() -> dict[str, Any]:
    """The JSON schema of a shot: types, bounds, defaults and descriptions of all settings."""
    return Shot.model_json_schema()
