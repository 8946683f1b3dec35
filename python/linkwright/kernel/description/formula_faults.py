"""What can be wrong with a formula in a file: its text, its names, its constants."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Any

from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import fault, suggestion
from linkwright.kernel.description.formula import (
    DEPTH,
    FUNCTIONS,
    NUMBERS,
    SPEEDS,
    VARIABLES,
    FormulaError,
    depth,
    names,
    parse,
    program,
    terms,
)

_NAME = re.compile(r"[A-Za-z_]\w*")


def constant_faults(constants: dict[str, Any], text: str) -> Iterator[InitErrorDetails]:
    """Constants with a meaning of their own, names that are none, and those that the formula lacks."""
    taken = VARIABLES | FUNCTIONS.keys() | NUMBERS.keys()
    for name, value in constants.items():
        if name in taken:
            remedy = f'"{name}" has a meaning of its own in formulas'
            yield fault("constants", name, found=value, expected="another name", remedy=remedy)
        elif not _NAME.fullmatch(name):
            remedy = "letters, digits and _, as in spring_rate"
            yield fault("constants", name, found=value, expected="a name for a formula", remedy=remedy)
        elif (used := used_names(text)) is not None and name not in used:
            expected = "a constant that the formula asks for"
            yield fault("constants", name, found=value, expected=expected, remedy="remove it")


def used_names(text: str) -> dict[str, int] | None:
    """Names in a formula and the character at which each stands first; None if it cannot be read."""
    try:
        return names(parse(text))
    except FormulaError:
        return None


def text_faults(
    key: str, text: str, constants: dict[str, Any], variables: Iterable[str] = VARIABLES
) -> Iterator[InitErrorDetails]:
    """A text at a key that is no formula, and names in it that are neither constants nor variables."""
    try:
        tree = parse(text)
    except FormulaError as found:
        yield fault(key, found=text, expected=found.expected, remedy=found.remedy)
        return
    known = [*variables, *NUMBERS, *constants]
    for name, at in sorted(names(tree).items(), key=lambda name: name[1]):
        if name not in known:
            expected = f'a variable or constant at character {at}, where "{name}" stands'
            yield fault(key, found=text, expected=expected, remedy=_meant(name, known))
    # A law of a driver is worked as a whole, a load summand by summand.
    parts = terms(tree) if set(variables) >= SPEEDS else (tree,)
    if any(depth(program(part)) > DEPTH for part in parts):
        expected = f"at most {DEPTH} numbers at once before an operator joins them"
        yield fault(key, found=text, expected=expected, remedy="write it as a sum of shorter parts")


def _meant(name: str, known: list[str]) -> str:
    if name in FUNCTIONS:
        return f"a function has brackets: {name}(…)"
    return suggestion(name, known) or f"define it: constants = {{ {name} = … }}"
