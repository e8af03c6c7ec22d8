"""The operators of the groom, one per file. A new shape operator needs its file and a place in ``ShapeOperator``."""

from typing import Annotated

from pydantic import Field

from ringlet.groom.operators.clean import Clean
from ringlet.groom.operators.clump import Clump
from ringlet.groom.operators.curl import Curl
from ringlet.groom.operators.drawn import Drawn
from ringlet.groom.operators.grown import Grown
from ringlet.groom.operators.length import Length
from ringlet.groom.operators.locks import Locks
from ringlet.groom.operators.loft import Loft
from ringlet.groom.operators.operator import Context, Operator
from ringlet.groom.operators.resample import Resample
from ringlet.groom.operators.scraggle import Scraggle

ShapeOperator = Annotated[Resample | Length | Loft | Scraggle | Clump, Field(discriminator="op")]

__all__ = [
    "Clean",
    "Clump",
    "Context",
    "Curl",
    "Drawn",
    "Grown",
    "Length",
    "Locks",
    "Loft",
    "Operator",
    "Resample",
    "Scraggle",
    "ShapeOperator",
]
