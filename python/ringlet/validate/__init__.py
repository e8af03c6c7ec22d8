"""Validation of the simulator against known answers, each with its error at several resolutions."""

from ringlet.data.errors import UserError
from ringlet.data.settings import did_you_mean
from ringlet.validate import (
    bounce,
    buckling,
    cantilever,
    friction,
    hanging_chain,
    hanging_helix,
    loose_waves,
    love,
    nest,
    out_of_plane,
    plucked_coil,
    push,
    tip_load,
    vibration,
)
from ringlet.validate.case import Case, Row

_MODULES = (
    cantilever,
    tip_load,
    hanging_helix,
    love,
    vibration,
    plucked_coil,
    bounce,
    hanging_chain,
    buckling,
    out_of_plane,
    loose_waves,
    friction,
    push,
    nest,
)
CASES: dict[str, Case] = {module.CASE.name: module.CASE for module in _MODULES}


def run_case(name: str) -> list[Row]:
    """Computes the rows of a case; raises UserError for an unknown name."""
    if name not in CASES:
        raise UserError(f"validate: there is no case '{name}'{did_you_mean(name, CASES)}")
    return list(CASES[name].run())


__all__ = ["CASES", "Case", "Row", "run_case"]
