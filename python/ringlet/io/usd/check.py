"""Whether a stage keeps the rules of USD."""

from __future__ import annotations

from pathlib import Path

from pxr import UsdValidation  # pyright: ignore[reportAttributeAccessIssue]

from ringlet.io.usd.stage import reading


def problems(path: Path | str) -> list[str]:
    """What the validators that come with USD find wrong in a stage, with all that it refers to; one line each."""
    with reading(path) as source:
        validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
        found = UsdValidation.ValidationContext(validators).Validate(source.stage)
        return [error.GetErrorAsString() for error in found]
