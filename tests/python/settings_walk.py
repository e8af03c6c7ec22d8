"""Walks the tables of a model, and sets values in the tables of a text: for tests that change every setting."""

from __future__ import annotations

import tomllib
from typing import Any, get_args

from pydantic import BaseModel
from ringlet.data.quantities import Varied
from ringlet.groom.mask import Mask


def tables(model: type[BaseModel], found: dict[str, type[BaseModel]]) -> dict[str, type[BaseModel]]:
    """The tables of a model by the names of their classes; a value with its variation or a mask is none."""
    if model.__name__ not in found:
        found[model.__name__] = model
        for field in model.model_fields.values():
            for kind in kinds(field.annotation):
                if isinstance(kind, type) and issubclass(kind, BaseModel) and not issubclass(kind, Varied | Mask):
                    tables(kind, found)
    return found


def kinds(annotation: Any) -> list[Any]:
    """The types that an annotation is made of, and the values of its literals."""
    parts = get_args(annotation)
    return [kind for part in parts for kind in kinds(part)] if parts else [annotation]


def add(data: dict[str, Any], text: str) -> None:
    """Adds the tables of a text to those of a recipe; 'none' takes a setting out."""
    merge(data, tomllib.loads(text))


def merge(into: dict[str, Any], given: dict[str, Any]) -> None:
    """Adds tables to those of a recipe; 'none' takes a setting out."""
    for key, value in given.items():
        if isinstance(value, dict) and isinstance(into.get(key), dict):
            merge(into[key], value)
        elif value == "none":
            into.pop(key, None)
        else:
            into[key] = value


def at(data: dict[str, Any], place: str) -> Any:
    """The table at a place such as ``shape.0``."""
    for part in filter(None, place.split(".")):
        data = data[int(part)] if part.isdigit() else data.setdefault(part, {})
    return data
