"""Expressions over the attributes of locks, such as ``id % 3 == 0 and length > 0.05``."""

from __future__ import annotations

import ast
import operator
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.settings import did_you_mean, refuse

SECTIONED = ("section", "strand", "u", "v", "edge")  # attributes of locks that grow from sections
NAMES = ("id", "random", "length", "x", "y", "z", *SECTIONED)  # x, y, z are of the root
FUNCTIONS: dict[str, Callable[..., Any]] = {
    "abs": np.abs,
    "min": np.minimum,
    "max": np.maximum,
    "floor": np.floor,
    "sqrt": np.sqrt,
    "sin": np.sin,
    "cos": np.cos,
}
_OPERATORS: dict[type, Callable[..., Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: np.true_divide,
    ast.Mod: np.mod,
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.And: np.logical_and,
    ast.Or: np.logical_or,
    ast.Not: np.logical_not,
    ast.USub: operator.neg,
    ast.UAdd: operator.pos,
}


def check(text: str) -> str:
    """Returns the text of an expression that ``evaluate`` supports; else raises a validation error."""
    try:
        tree = ast.parse(text, mode="eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise refuse(f"is '{text[:80]}'; must be an expression such as \"id % 2 == 0\"") from None
    for node in ast.walk(tree):
        if isinstance(node, ast.Name) and node.id not in (*NAMES, *FUNCTIONS):
            raise refuse(f"has '{node.id}', which is not known{did_you_mean(node.id, (*NAMES, *FUNCTIONS))}")
        if not _allowed(node):
            raise refuse(f"is '{text[:80]}'; may use only numbers, comparisons, and, or, not, {', '.join(FUNCTIONS)}")
    return text


def names(text: str) -> set[str]:
    """Names of values that a checked expression uses."""
    return {node.id for node in ast.walk(ast.parse(text, mode="eval")) if isinstance(node, ast.Name)} & set(NAMES)


def evaluate(text: str, values: Mapping[str, NDArray]) -> NDArray[np.float64]:
    """Evaluates a checked expression for each lock, shape (count,); true is 1.

    values: an array of shape (count,) for ``id`` and each name of the expression
    """
    with np.errstate(all="ignore"):  # the caller reports results that are not finite
        result = _value(ast.parse(text, mode="eval").body, values)
    return np.broadcast_to(np.asarray(result, np.float64), values["id"].shape)


def _allowed(node: ast.AST) -> bool:
    if isinstance(node, ast.Constant):
        return isinstance(node.value, int | float) and abs(node.value) < 1e300
    if isinstance(node, ast.Call):
        least = 2 if isinstance(node.func, ast.Name) and node.func.id in ("min", "max") else 1
        return isinstance(node.func, ast.Name) and node.func.id in FUNCTIONS and len(node.args) == least
    whole = (ast.Expression, ast.Name, ast.Load, ast.BinOp, ast.BoolOp, ast.UnaryOp, ast.Compare)
    return isinstance(node, (*whole, *_OPERATORS))


def _value(node: ast.expr, values: Mapping[str, NDArray]) -> Any:
    match node:
        case ast.Constant():
            return node.value
        case ast.Name():
            return values[node.id]
        case ast.Call():
            assert isinstance(node.func, ast.Name)
            return FUNCTIONS[node.func.id](*(_value(argument, values) for argument in node.args))
        case ast.UnaryOp():
            return _OPERATORS[type(node.op)](_value(node.operand, values))
        case ast.BinOp():
            return _OPERATORS[type(node.op)](_value(node.left, values), _value(node.right, values))
        case ast.BoolOp():
            operands = [_value(operand, values) for operand in node.values]
            for operand in operands[1:]:
                operands[0] = _OPERATORS[type(node.op)](operands[0], operand)
            return operands[0]
        case ast.Compare():
            sides = [_value(side, values) for side in (node.left, *node.comparators)]
            result: Any = True
            for op, a, b in zip(node.ops, sides[:-1], sides[1:], strict=True):
                result = np.logical_and(result, _OPERATORS[type(op)](a, b))
            return result
    raise AssertionError(f"{node} was not checked")
