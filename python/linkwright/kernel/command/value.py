"""Values of options that are quantities, such as ``--at "30 deg"``."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, NamedTuple

from linkwright.kernel.errors import InputError, UnitError, cut, require_within

if TYPE_CHECKING:
    from linkwright.kernel.limits import Limit
    from linkwright.kernel.units.kinds import Kind
    from linkwright.kernel.units.marks import Quantity


def option_value(option: str, text: str, of: Kind | Quantity) -> float:
    """The value of an option that is a quantity; a bare number is SI, where it can mean but one unit.

    Raises `InputError`, which names the option, for anything else, for what is beyond the bound of a mark,
    and for an angle, a speed or a power without its unit.
    """
    from linkwright.kernel.units.kinds import ANGLE, POWER, SPEED
    from linkwright.kernel.units.marks import Quantity
    from linkwright.kernel.units.reading import parse

    mark = of if isinstance(of, Quantity) else Quantity(of)
    kind = mark.kind

    # On a command line people mean degrees as often as radians; zero is the same in both.
    choices = {
        ANGLE.dimension: ("deg", "rad"),
        SPEED.dimension: ("rpm", "rad/s"),
        POWER.dimension: ("kW", "W"),
    }
    units = choices.get(kind.dimension)
    if _is_number(text) and not math.isfinite(float(text)):
        raise InputError(f"{option}: found {cut(text)}, expected a finite number with its unit")
    if units and _is_number(text) and float(text) != 0:
        text = cut(text)
        one, other = (f'"{text} {unit}"' for unit in units)
        before = "" if "=" in option else f"{option} "
        raise InputError(
            f"{option}: found {text}, which may be {units[0]} or {units[1]}; give its unit, "
            f"{before}{one} or {before}{other}"
        )
    try:
        value = parse(float(text) if _is_number(text) else text, kind)
    except UnitError as error:
        problem = error.problem
        # The file takes a bare number there, the command line does not.
        expected = problem.expected.partition(" or a number in ")[0] if units else problem.expected
        remedy = f"; {cut(problem.remedy)}" if problem.remedy else ""
        raise InputError(f"{option}: found {cut(problem.found)}, expected {expected}{remedy}") from None
    if not mark.holds(value):
        hint = mark.remedy(value) or f'such as "{kind.example}"'
        expected = f"{kind.word}{mark.bound.words.rstrip(',')}; {hint}"
        raise InputError(f"{option}: found {cut(text)}, expected {expected}")
    return value


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


class Steps(NamedTuple):
    """Evenly spaced values."""

    low: float
    high: float
    number: int


def stepped(
    option: str, texts: Iterable[str], kinds: Mapping[str, Kind], words: str, example: str, most: Limit
) -> dict[str, Steps]:
    """Values by name, of an option with ``NAME=LOW:HIGH:N`` for each; an `InputError` for anything else.

    `kinds`: of what may vary, by name; `words`: what that is; `example`: such values and what they mean;
    `most`: how many values there may be.
    """
    from linkwright.kernel.description.base import suggestion

    known: dict[str, Steps] = {}
    for text in texts:
        name, _, values = text.partition("=")
        parts = [part.strip().strip("\"'") for part in values.split(":")]
        if name not in kinds:
            remedy = suggestion(name, kinds)
            raise InputError(f'{option} {text}: found "{name}", expected {words}; {remedy}')
        if len(parts) != 3 or not parts[2].isdigit() or int(parts[2]) < 1:
            raise InputError(f'{option} {text}: found "{values}", expected LOW:HIGH:N; such as {example}')
        if name in known:
            raise InputError(f"{option}: found the same name twice, expected each once")
        low, high = (option_value(f"{option} {text}", part, kinds[name]) for part in parts[:2])
        # A count of thousands of digits is no number for Python.
        known[name] = Steps(low, high, int(parts[2][:16]))
        require_within(most, known[name].number, text, "take fewer values")
    return known
