"""Writes references as Markdown from the program itself: recipes, shots, commands, known answers, the Python API."""

from __future__ import annotations

import inspect
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import typer.main
from ringlet.cli.app import app
from ringlet.data.files import replacing
from ringlet.data.former_names import RECIPE, SHOT
from setting_pictures import write_setting_pictures

import ringlet
from ringlet import validate

PIPELINE = ("grooms", "check", "shots", "live", "caches", "hairs", "pictures")  # modules of ringlet.api


def write_references(folder: Path) -> None:
    """Writes the references to a folder, each only when it has changed."""
    folder.mkdir(exist_ok=True)
    schemas = ringlet.schema()
    pictures = write_setting_pictures(schemas, folder / "settings")
    for name, lines in {
        "recipe": settings(schemas["recipe"], pictures),
        "shot": settings(schemas["shot"], pictures),
        "commands": commands(),
        "python": public_names(),
        "cases": cases(),
        "former_names": former_names(),
    }.items():
        path, text = folder / f"{name}.md", "\n".join(lines) + "\n"
        if not path.exists() or path.read_text() != text:
            with replacing(path) as aside:
                aside.write_text(text)


def settings(schema: dict[str, Any], pictures: dict[tuple[str, str], str]) -> Iterator[str]:
    """A table for the file itself, then one for every kind of table in it.

    pictures: of what settings do, by table and setting
    """
    yield from table(schema, "The file", {})
    for name, definition in schema.get("$defs", {}).items():
        if "properties" in definition:
            drawn = {setting: file for (of, setting), file in pictures.items() if of == name}
            yield from table(definition, definition.get("title", name), drawn)


def table(definition: dict[str, Any], title: str, drawn: dict[str, str]) -> Iterator[str]:
    """Key, type, default, meaning and picture of everything in one table."""
    yield f"\n## {title}\n"
    if text := definition.get("description"):
        yield inspect.cleandoc(text) + "\n"
    yield "| setting | value | default | meaning |\n|---|---|---|---|"
    required = definition.get("required", [])
    for key, about in definition.get("properties", {}).items():
        unit = about.get("unit", "")
        default = "*required*" if key in required else written(about.get("default"), unit)
        shown = f" ![{key}, without and with](_generated/settings/{drawn[key]})" if key in drawn else ""
        yield f"| `{key}` | {kind(about, unit)} | {default} | {cell(about.get('description', ''))}{shown} |"


def kind(about: dict[str, Any], unit: str = "") -> str:
    """Type and bounds in words: ``number, at least 0``. A length may be a number or a text such as ``5 mm``."""
    if "anyOf" in about or "oneOf" in about:
        options = [option for option in about.get("anyOf", about.get("oneOf", [])) if option.get("type") != "null"]
        if unit == "m":
            options = [option for option in options if option.get("type") != "string"]
        return " or ".join(dict.fromkeys(kind(option, unit) for option in options))
    if "$ref" in about:
        name = about["$ref"].rpartition("/")[2]
        return f"[{name}](#{name.lower()})"
    if "const" in about or "enum" in about:
        return ", ".join(f"`{value}`" for value in about.get("enum", [about.get("const")]))
    if about.get("type") == "array":
        return f"list of {kind(about['items'])}" if about.get("items") else "list"
    if about.get("format") == "color":
        return "colour `#rrggbb`"
    words = {"integer": "whole number", "object": "table", "boolean": "true or false", "string": "text"}
    name = "length" if unit == "m" else words.get(about.get("type", ""), about.get("type", "any"))
    bounds = {"minimum": "at least", "exclusiveMinimum": "above", "maximum": "at most", "exclusiveMaximum": "below"}
    told_bounds = [f"{word} {number(about[key], unit)}" for key, word in bounds.items() if key in about]
    return ", ".join([f"{name} in degrees" if unit == "deg" else name, *told_bounds])


def number(value: float, unit: str) -> str:
    """A number with its unit, lengths in the unit that suits them."""
    if unit != "m" or value == 0:
        return f"{value}" if isinstance(value, int) else f"{value:g}"
    return f"{1e3 * value:g} mm" if value < 0.1 else f"{value:g} m"


def written(value: Any, unit: str) -> str:
    """A default in a few words; nothing for what is simply absent, or is a table of its own."""
    if isinstance(value, dict):
        if "value" not in value:
            return ""
        rest = {
            k: v
            for k, v in value.items()
            if k in ("vary", "noise", "ramp") and v not in (0.0, [[0.0, 1.0], [1.0, 1.0]])
        }
        return ", ".join([written(value["value"], unit), *(f"{k} `{v}`" for k, v in rest.items())])
    if value is None or value in ("", []):
        return ""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return f"`{cell(str(value).lower() if isinstance(value, bool) else str(value))}`"
    return f"`{number(value, unit)}`"


def cell(text: str) -> str:
    """Text that cannot break out of a table's cell."""
    return " ".join(text.split()).replace("|", "\\|")


def commands() -> Iterator[str]:
    """The ``--help`` text of every command."""
    group: Any = typer.main.get_command(app)
    for name, command in group.commands.items():
        arguments = [p.metavar for p in command.params if p.param_type_name == "argument"]
        yield f"\n## ringlet {name}\n\n```\n{' '.join(['ringlet', name, *arguments])} [OPTIONS]\n```\n"
        yield inspect.cleandoc(command.help) + "\n"
        yield "| | |\n|---|---|"
        for param in command.params:
            names = [param.metavar] if param.param_type_name == "argument" else param.opts
            value = f" {param.metavar}" if param.param_type_name == "option" and param.metavar else ""
            yield f"| `{', '.join(names)}{value}` | {cell(param.help or '')} |"


def former_names() -> Iterator[str]:
    """The settings that have a new name."""
    for title, renames in (("Recipes", RECIPE), ("Shots", SHOT)):
        if renames:
            yield f"## {title}\n\n| former name | present name |\n|---|---|"
            yield from (f"| `{rename.former}` | `{rename.name}` |" for rename in renames)
            yield ""


def public_names() -> Iterator[str]:
    """Everything that ``import ringlet`` gives: functions in the order of the pipeline, then classes."""
    public = [name for name in sorted(ringlet.__all__) if not name.startswith("__")]
    names = [name for name in public if not inspect.ismodule(getattr(ringlet, name))]
    classes = [name for name in names if inspect.isclass(getattr(ringlet, name))]
    functions = sorted(set(names) - set(classes), key=in_pipeline)
    yield "## Functions\n\n```{eval-rst}"
    yield from (f".. autofunction:: ringlet.{name}" for name in functions)
    yield "```\n\n## Classes\n\n```{eval-rst}"
    yield from (f".. autoclass:: ringlet.{name}\n   :members:\n   :exclude-members: model_config" for name in classes)
    yield "```"


def in_pipeline(name: str) -> tuple[int, str, int]:
    """The place of a public function among all: by its module, in the order of the pipeline, then by its line."""
    function = getattr(ringlet, name)
    module = function.__module__.rpartition(".")[2]
    return PIPELINE.index(module) if module in PIPELINE else len(PIPELINE), module, inspect.getsourcelines(function)[1]


def cases() -> Iterator[str]:
    """The known answers, each in a sentence."""
    yield "| case | what must hold |\n|---|---|"
    yield from (f"| `{name}` | {cell(case.title)} |" for name, case in validate.CASES.items())
