"""Known answers that the simulator is held to: each with its error at several resolutions."""

from ringlet.errors import UserError
from ringlet.settings import did_you_mean
from ringlet.validate import cantilever, hanging_helix, vibration
from ringlet.validate.case import Case, Row

CASES: dict[str, Case] = {case.name: case for case in (cantilever.CASE, hanging_helix.CASE, vibration.CASE)}


def run_case(name: str) -> list[Row]:
    """Computes a case's rows. Raises UserError where there is no such case."""
    if name not in CASES:
        raise UserError(f"validate: there is no case '{name}'{did_you_mean(name, CASES)}")
    return list(CASES[name].run())


__all__ = ["CASES", "Case", "Row", "run_case"]
