"""Validation of a stage by the validators of USD."""

from __future__ import annotations

from pathlib import Path

from pxr import UsdValidation  # pyright: ignore[reportAttributeAccessIssue]

from ringlet.io.usd.stage import reading


def problems(path: Path | str) -> list[str]:
    """Errors that the validators of USD report for a stage and its references, one line each."""
    with reading(path) as source:
        validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
        found = UsdValidation.ValidationContext(validators).Validate(source.stage)
        return [error.GetErrorAsString() for error in found]
