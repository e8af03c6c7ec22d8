"""Contact and friction of locks, colliders and cloth."""

from __future__ import annotations

from pathlib import Path

from pydantic import Field

from ringlet.data.settings import Section


class Contact(Section):
    """Contact of strands with one another and with bodies."""

    radius: float = Field(
        default=5e-4,
        gt=0,
        le=0.1,
        description="[m] half the distance at which two locks begin to repel each other; larger is bulkier",
    )
    friction: float = Field(default=0.3, ge=0, le=10, description="Coulomb's μ of lock on lock")
    stiffness: float = Field(
        default=1.0,
        gt=0,
        le=1e6,
        description="factor on the contact stiffness, which follows the load of each contact",
    )
    creep_speed: float = Field(
        default=1e-3,
        gt=0,
        le=1,
        description="[m/s] sliding speed below which friction sticks; smaller holds more firmly. By default 1e-5 "
        "where rest.mode is 'equilibrium'",
    )
    separation_speed: float = Field(
        default=2e-3,
        ge=0,
        le=1,
        description="[m/s] at which locks that begin closer than their contact distance separate; larger clears "
        "overlaps sooner and pushes harder. 0: they stay, which is the default where rest.mode is "
        "'equilibrium'",
    )


class Pair(Section):
    """The friction of two materials on each other, in place of what each of them says."""

    between: tuple[str, str] = Field(
        description="`locks`, or the names of colliders and cloths; twice the same name: on itself"
    )
    friction: float = Field(ge=0, le=10, description="Coulomb's μ")


class ShotContact(Contact):
    """Contact of locks with one another, with colliders and with cloth."""

    on: bool = Field(default=True, description="false: no contact, as without this table")
    own_radius: float = Field(
        default=0.85,
        ge=0,
        le=1,
        description="locks that have a radius of their own, such as strands of braids and locs, touch at this "
        "fraction of it, if that is more than `radius`; below 1, as straight edges cut the corners of "
        "a lock's path",
    )
    pair: tuple[Pair, ...] = Field(
        default=(),
        description="friction of pairs; by default a lock on something has the friction of that, and two other "
        "things the geometric mean of both",
    )


class Collider(Section):
    """Meshes that locks cannot pass through. Where several entries name one mesh, the last of them counts."""

    name: str = Field(
        default="", description="name for pins and friction; by default the last part of each mesh's path"
    )
    file: Path | None = Field(
        default=None,
        description="USD file with the animation of the groom's head; by default that head. A relative name counts "
        "from the shot",
    )
    mesh: str | None = Field(
        default=None, description="path of a prim: the meshes at and below it; by default all that are visible"
    )
    animated: bool = Field(default=True, description="false: it stays as at the first frame of the shot")
    thickness: float = Field(
        default=5e-4,
        ge=0,
        le=0.1,
        description="[m] distance from the surface at which contact begins, in addition to `contact.radius`",
    )
    friction: float = Field(default=0.3, ge=0, le=10, description="Coulomb's μ of a lock on it")
