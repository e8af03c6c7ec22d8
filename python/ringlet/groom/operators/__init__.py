"""The operators of the groom, one per file; ``ShapeOperator`` is the registry of shape operators."""

from typing import Annotated

from pydantic import Field

from ringlet.groom.operators.attract import Attract
from ringlet.groom.operators.bend import Bend
from ringlet.groom.operators.braid import Braid
from ringlet.groom.operators.clump import Clump
from ringlet.groom.operators.collide import Collide
from ringlet.groom.operators.cornrow import Cornrow
from ringlet.groom.operators.curl import Curl
from ringlet.groom.operators.cut import Cut
from ringlet.groom.operators.drawn import Drawn
from ringlet.groom.operators.edges import Edges
from ringlet.groom.operators.finger_wave import FingerWave
from ringlet.groom.operators.flyaways import Flyaways
from ringlet.groom.operators.frizz import Frizz
from ringlet.groom.operators.grow_to import GrowTo
from ringlet.groom.operators.grown import Grown
from ringlet.groom.operators.knot import Knot
from ringlet.groom.operators.length import Length
from ringlet.groom.operators.lift import Lift
from ringlet.groom.operators.loc import Loc
from ringlet.groom.operators.locks import Locks
from ringlet.groom.operators.noise import Noise
from ringlet.groom.operators.operator import Context, Operator
from ringlet.groom.operators.part import Part
from ringlet.groom.operators.resample import Resample
from ringlet.groom.operators.scraggle import Scraggle
from ringlet.groom.operators.shape import Shape
from ringlet.groom.operators.smooth import Smooth
from ringlet.groom.operators.straighten import Straighten
from ringlet.groom.operators.tie import Tie
from ringlet.groom.operators.twist import Twist
from ringlet.groom.operators.volume import Volume

ShapeOperator = Annotated[
    Resample
    | Smooth
    | Length
    | Lift
    | Volume
    | Bend
    | Scraggle
    | Noise
    | Frizz
    | Clump
    | Part
    | Tie
    | Flyaways
    | Straighten
    | Attract
    | Cut
    | GrowTo
    | Braid
    | Twist
    | Cornrow
    | Loc
    | Knot
    | Edges
    | FingerWave,
    Field(discriminator="op"),
]

__all__ = [
    "Attract",
    "Bend",
    "Braid",
    "Clump",
    "Collide",
    "Context",
    "Cornrow",
    "Curl",
    "Cut",
    "Drawn",
    "Edges",
    "FingerWave",
    "Flyaways",
    "Frizz",
    "GrowTo",
    "Grown",
    "Knot",
    "Length",
    "Lift",
    "Loc",
    "Locks",
    "Noise",
    "Operator",
    "Part",
    "Resample",
    "Scraggle",
    "Shape",
    "ShapeOperator",
    "Smooth",
    "Straighten",
    "Tie",
    "Twist",
    "Volume",
]
