"""Names of regions, maps and files as identifiers of USD; the original names are kept as metadata."""

from __future__ import annotations

from collections.abc import Collection

from pxr import Sdf, Usd

from ringlet.data.names import unique

ORIGINAL = "ringlet:name"


def identifier(name: str, taken: Collection[str] = ()) -> str:
    """Returns the name with every character that USD refuses replaced, and with a number where it is taken."""
    valid = "".join(letter if Sdf.Path.IsValidIdentifier(f"_{letter}") else "_" for letter in name)
    valid = valid if Sdf.Path.IsValidIdentifier(valid) else f"_{valid}"
    return unique(valid, taken)


def keep_name(of: Usd.Object, name: str) -> None:
    """Stores the original name of a prim or a property, which is also the one that programs show."""
    of.SetCustomDataByKey(ORIGINAL, name)
    of.SetMetadata("displayName", name)


def original_name(of: Usd.Object, default: str) -> str:
    """The original name of a prim or a property; ``default`` where none is kept."""
    kept = of.GetCustomDataByKey(ORIGINAL)
    return kept if isinstance(kept, str) else default
