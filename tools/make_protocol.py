"""Generates web/src/protocol.ts, the messages in TypeScript, from python/ringlet/viewer/protocol.

Usage: python tools/make_protocol.py [--check]. With --check it writes nothing, and exits with 1 if the file is stale.
"""

from __future__ import annotations

import sys
import types
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic.fields import FieldInfo
from ringlet.viewer import protocol

FILE = Path(__file__).parents[1] / "web/src/protocol.ts"
ARRAYS = {
    "f4": "Float32Array",
    "f8": "Float64Array",
    "i2": "Int16Array",
    "i4": "Int32Array",
    "u4": "Uint32Array",
    "u1": "Uint8Array",
}
PLAIN: dict[Any, str] = {
    str: "string",
    int: "number",
    float: "number",
    bool: "boolean",
    Any: "Json",
    types.NoneType: "null",
}


# What messages of the server consist of.
PARTS = (
    protocol.Stage,
    protocol.KeptRun,
    protocol.Change,
    protocol.Fix,
    protocol.Difference,
    protocol.Problem,
    protocol.Person,
    protocol.Lamp,
    protocol.Rig,
    protocol.Arranged,
    protocol.Shared,
    protocol.Snapshot,
    protocol.Note,
    protocol.Placement,
    protocol.Reference,
    protocol.StageCamera,
    protocol.Preset,
)


def kind(annotation: Any) -> str:
    """TypeScript notation of a Python type."""
    if annotation in PLAIN:
        return PLAIN[annotation]
    if get_origin(annotation) is Annotated:
        return kind(get_args(annotation)[0])
    origin, arguments = get_origin(annotation), get_args(annotation)
    if origin is Literal:
        return " | ".join(f'"{value}"' for value in arguments)
    if origin in (Union, types.UnionType):
        return " | ".join(kind(argument) for argument in arguments)
    if origin is list:
        inner = kind(arguments[0])
        return f"({inner})[]" if "|" in inner else f"{inner}[]"
    if origin is tuple:
        return f"[{', '.join(kind(argument) for argument in arguments)}]"
    if origin is dict:
        return f"Record<string, {kind(arguments[1])}>"
    return annotation.__name__


def field(name: str, info: FieldInfo, *, from_page: bool) -> str:
    """A line of an interface; fields with a default are optional in messages from the page."""
    optional = "?" if from_page and not info.is_required() and name != "kind" else ""
    return f"  {name}{optional}: {kind(info.annotation)};"


def interface(message: type[protocol.Message], *, from_page: bool) -> Iterator[str]:
    """Lines of a message's interface."""
    yield f"/** {(message.__doc__ or '').splitlines()[0]} */"
    yield f"export interface {message.__name__} {{"
    for name, info in _kind_first(message.model_fields):
        yield field(name, info, from_page=from_page)
    for name, array in message.arrays.items():
        yield f"  {name}: {ARRAYS[array]};"
    yield "}"
    yield ""


def _kind_first(fields: dict[str, FieldInfo]) -> list[tuple[str, FieldInfo]]:
    return sorted(fields.items(), key=lambda item: item[0] != "kind")


def lines() -> Iterator[str]:
    """Lines of the file."""
    union = get_args(get_args(protocol.FromPage)[0])
    yield "// Made by tools/make_protocol.py from python/ringlet/viewer/protocol; change it there."
    yield ""
    yield f"export const VERSION = {protocol.VERSION};"
    yield "export type Json = string | number | boolean | null | Json[] | { [key: string]: Json };"
    yield ""
    for message in PARTS:
        yield from interface(message, from_page=False)
    for message in union:
        yield from interface(message, from_page=True)
    for message in protocol.FROM_SERVER:
        yield from interface(message, from_page=False)
    for name, messages in (("FromPage", union), ("FromServer", protocol.FROM_SERVER)):
        yield f"export type {name} ="
        yield "\n".join(f"  | {message.__name__}" for message in messages) + ";"
        yield ""


def main() -> int:
    """Writes the file, or compares it; returns the exit code."""
    text = "\n".join(lines()).rstrip() + "\n"
    if "--check" in sys.argv:
        if FILE.read_text() != text:
            print(f"{FILE}: is stale; run: python tools/make_protocol.py")
            return 1
        return 0
    FILE.write_text(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
