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
        return [error.GetErrorAsString() for error in found if not _is_unknown_node(error)]


def _is_unknown_node(error: UsdValidation.ValidationError) -> bool:
    """Whether an error is that of a MaterialX node in a USD without MaterialX, such as ``usd-core``."""
    if error.GetName() != "MissingShaderIdInRegistry":
        return False
    return all(site.IsProperty() and str(site.GetProperty().Get()).startswith("ND_") for site in error.GetSites())
