"""A force or torque by a formula: ``force = "-200*v - 50*sign(v)"``."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Annotated, Any, Literal

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.machine.base import fault, suggestion
from linkwright.machine.formula import (
    DEPTH,
    FUNCTIONS,
    NUMBERS,
    VARIABLES,
    FormulaError,
    depth,
    names,
    parse,
    program,
    terms,
)
from linkwright.machine.loads.base import Load, one_of
from linkwright.units import Angle, AnyQuantity

_NAME = re.compile(r"[A-Za-z_]\w*")


class FormulaLoad(Load):
    """A force or a torque by a formula in angle, speed, time, position and velocity of what it acts on."""

    kind: Literal["formula"]
    on: str = Field(description="Moving point, slider or link that it acts on.")
    force: str | None = Field(None, description="Formula of a force in N, on a point or a slider.")
    torque: str | None = Field(None, description="Formula of a torque in N m, on a link, counter-clockwise.")
    direction: Angle | None = Field(
        None, description="Direction of the force, from the x axis, or from the link `along`."
    )
    along: str | None = Field(None, description="Link that the force turns with.")
    constants: dict[str, Annotated[float, AnyQuantity()]] = Field(
        default_factory=dict, description="Numbers of the formula by name, in any unit; they count in SI."
    )

    @property
    def text(self) -> str:
        """The formula."""
        return self.force if self.force is not None else self.torque or ""

    @property
    def knows_time(self) -> bool:
        """Whether the load changes with time itself."""
        return "t" in names(parse(self.text))

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from one_of(self, "force", "torque")
        yield from self._constant_faults()
        for key in ("force", "torque"):
            text = getattr(self, key)
            if text is not None:
                yield from _text_faults(key, text, self.constants)
        for key in ("direction", "along"):
            if self.torque is not None and getattr(self, key) is not None:
                expected = "nothing: a torque is counter-clockwise"
                yield fault(key, found=getattr(self, key), expected=expected)

    def _constant_faults(self) -> Iterator[InitErrorDetails]:
        """Constants that a formula cannot ask for, or does not."""
        taken = VARIABLES | FUNCTIONS.keys() | NUMBERS.keys()
        for name, value in self.constants.items():
            if name in taken:
                remedy = f'"{name}" has a meaning of its own in formulas'
                yield fault("constants", name, found=value, expected="another name", remedy=remedy)
            elif not _NAME.fullmatch(name):
                remedy = "letters, digits and _, as in spring_rate"
                yield fault("constants", name, found=value, expected="a name for a formula", remedy=remedy)
            elif (used := _used(self.text)) is not None and name not in used:
                expected = "a constant that the formula asks for"
                yield fault("constants", name, found=value, expected=expected, remedy="remove it")


def _used(text: str) -> dict[str, int] | None:
    """Names in a formula; None if it cannot be read."""
    try:
        return names(parse(text))
    except FormulaError:
        return None


def _text_faults(key: str, text: str, constants: dict[str, Any]) -> Iterator[InitErrorDetails]:
    """A text that is no formula, and names in it that stand for nothing."""
    try:
        tree = parse(text)
    except FormulaError as found:
        yield fault(key, found=text, expected=found.expected, remedy=found.remedy)
        return
    known = [*VARIABLES, *NUMBERS, *constants]
    for name, at in sorted(names(tree).items(), key=lambda each: each[1]):
        if name not in known:
            expected = f'a variable or constant at character {at}, where "{name}" stands'
            yield fault(key, found=text, expected=expected, remedy=_meant(name, known))
    if any(depth(program(each)) > DEPTH for each in terms(tree)):
        expected = f"at most {DEPTH} numbers at once before an operator joins them"
        yield fault(key, found=text, expected=expected, remedy="write it as a sum of shorter parts")


def _meant(name: str, known: list[str]) -> str:
    if name in FUNCTIONS:
        return f"a function has brackets: {name}(…)"
    return suggestion(name, known) or f"define it: constants = {{ {name} = … }}"


def variable_faults(key: str, text: object, known: frozenset[str], on: str) -> Iterator[tuple[str, str, str]]:
    """Variables that what a load acts on does not have.

    Parameters
    ----------
    key : str
        ``force`` or ``torque``.
    text : object
        The formula.
    known : frozenset of str
        Variables that there are.
    on : str
        What the load acts on, in words.

    Yields
    ------
    tuple of str
        Key, what is expected, and the remedy.
    """
    used = _used(text) if isinstance(text, str) else None
    for name, at in (used or {}).items():
        if name in VARIABLES and name not in known:
            remedy = f"{on} has {', '.join(sorted(known))}"
            yield key, f'another variable at character {at}, where "{name}" stands', remedy
