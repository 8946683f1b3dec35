"""Units in which numbers are shown: SI, unless the reader asks for others, such as ``mm, rpm, kN``.

Tables, figures and heads of CSV ask `reader` for them; what is computed, and JSON, is in SI whoever reads it.
A unit of length is taken for velocities, accelerations and lengths per angle too: with ``mm``, m/s² is shown
as mm/s². Torques and energies have one dimension, and the spelling decides: ``kN m`` is for torques, ``kJ``
for energies.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, replace
from functools import cache
from typing import TYPE_CHECKING, NamedTuple

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError
from linkwright.kernel.public import public
from linkwright.kernel.units.kinds import Dimension
from linkwright.kernel.units.spellings import factor_of, is_energy, normal, unknown

if TYPE_CHECKING:
    from pydantic import BaseModel

_RAISED = re.compile(r"\^([234])")
_RAISE = {"2": "²", "3": "³", "4": "⁴"}
_JOULE = Dimension.of("J")
# A unit at the end of a head or of a label.
_BRACKETS = re.compile(r"\[([^\[\]]+)\]$")


# Significant digits of numbers in tables, cards and sentences, where nobody asks for others.
DIGITS = 4

# Significant digits that a double has for sure.
DIGITS_MAX = 15


class _Unit(NamedTuple):
    """A unit by its spelling, its factor to SI, its dimension, and whether energies are measured in it."""

    name: str
    factor: float
    dimension: Dimension
    is_energy: bool

    def measures(self, other: _Unit) -> bool:
        return self.dimension == other.dimension and self.is_energy == other.is_energy


@cache
def _unit(text: str) -> _Unit | None:
    """A unit by its spelling; None if nobody knows it."""
    known = factor_of(text) if text else None
    if known is None:
        return None
    name = normal(text)
    return _Unit(name, *known, known[1] == _JOULE and is_energy(name))


@dataclass(frozen=True)
class OutUnits:
    """Units for what is shown, and its significant digits."""

    chosen: tuple[_Unit, ...] = ()  # the units, one of a kind
    digits: int = DIGITS

    @classmethod
    def of(cls, text: str, where: str = "--units") -> OutUnits:
        """Units of a list such as ``"mm, rpm, kN"``; `InputError` if unknown or double, naming `where`."""
        units: list[_Unit] = []
        for name in (part.strip() for part in text.split(",") if part.strip()):
            unit = _unit(name)
            if unit is None:
                raise InputError(f"{where}: {unknown(name)}")
            same = next((other for other in units if other.measures(unit)), None)
            if same is not None:
                raise InputError(f"{where}: found {same.name} and {unit.name}, expected one unit of a kind")
            units.append(unit)
        return cls(tuple(units))

    @classmethod
    def of_table(cls, table: BaseModel | None) -> OutUnits:
        """Units by the table ``[units]`` of a machine file; none without one."""
        if table is None:
            return cls()
        names = [unit for _, unit in table if unit is not None]
        return cls(tuple(unit for unit in map(_unit, names) if unit is not None))

    def over(self, other: OutUnits) -> OutUnits:
        """These, and of another choice what these leave open."""
        rest = (unit for unit in other.chosen if not any(own.measures(unit) for own in self.chosen))
        return OutUnits((*self.chosen, *rest), self.digits)

    def has(self, unit: str) -> bool:
        """Whether a unit was chosen for what is in another one, or follows from that of lengths."""
        own = _unit(unit)
        return own is not None and self._wanted(own) is not None

    def shown(self, unit: str, usual: str = "") -> tuple[str, float]:
        """The unit in which a quantity is shown, and by what its value is divided.

        `unit`: that it is in, empty for a plain number; `usual`: where no other is wanted, empty for the
        same.
        """
        response, per, entry = f" {unit}".partition(" per ")
        if per:
            # Of a derivative: by an entry that has its own unit; a response without any has none above.
            (above, over), (below, under) = self.shown(response.strip()), self.shown(entry)
            return f"{above} per {below}".strip(), over / under
        own = _unit(unit) if self.chosen or usual else None
        if own is None:
            # What has two units, or one of its own, is shown as it is.
            return unit, 1.0
        wanted = self._wanted(own) or _unit(usual)
        if wanted is None or wanted.name == own.name:
            return unit, 1.0
        return _pretty(wanted.name), wanted.factor / own.factor

    def _wanted(self, own: _Unit) -> _Unit | None:
        """The unit for what is in another one; None where none is wanted."""
        for unit in self.chosen:
            if unit.measures(own):
                return unit
        length = next((unit for unit in self.chosen if unit.dimension == Dimension(m=1)), None)
        if length and own.dimension == Dimension(m=-1):
            return _Unit(f"1/{length.name}", 1 / length.factor, own.dimension, is_energy=False)
        per = next((per for si, per in _PER_LENGTH.items() if own.dimension == si), None)
        return _unit(length.name + per) if length and per else None

    def column(self, head: str, values: Floats) -> tuple[str, Floats]:
        """A column of a table as it is shown: head with a unit in brackets, values in it → the same."""
        label, factor = self.label(head)
        return label, values if factor == 1.0 else values / factor

    def label(self, text: str) -> tuple[str, float]:
        """A label with a unit in brackets at its end as it is shown, and by what values are divided."""
        match = _BRACKETS.search(text)
        if match is None:
            return text, 1.0
        unit, factor = self.shown(match[1])
        return f"{text[: match.start()]}[{unit}]", factor


# Dimension → what is written behind a unit of length.
_PER_LENGTH = {
    Dimension.of(f"m{per}"): per for per in ("/s", "/s^2", "/s^3", "/s^4", "/rad", "/rad^2", "/rad^3")
}


def _pretty(unit: str) -> str:
    text = _RAISED.sub(lambda power: _RAISE[power[1]], unit)
    return "°" if text == "deg" else text


_SI = OutUnits()
_READER: ContextVar[OutUnits] = ContextVar("reader", default=_SI)


def reader() -> OutUnits:
    """The units of whoever reads what is being printed or drawn."""
    return _READER.get()


@contextmanager
def reading(units: OutUnits) -> Iterator[None]:
    """Show numbers in these units as long as the block lasts."""
    token = _READER.set(units)
    try:
        yield
    finally:
        _READER.reset(token)


def with_units_of(table: BaseModel | None) -> AbstractContextManager[None]:
    """Show numbers in the units of a machine file as long as the block lasts, those of the reader first."""
    return reading(reader().over(OutUnits.of_table(table)))


@public
def shown_in(units: str = "", *, digits: int | None = None) -> AbstractContextManager[None]:
    """Tables and figures in other units than SI, or with other digits than four, within a ``with``.

    Parameters
    ----------
    units : str
        Such as ``"mm, rpm, kN"``.
    digits : int, optional
        Significant digits, 1 to 15.

    Returns
    -------
    context manager
        What is printed, drawn or written as CSV inside is in these units; results stay SI.

    Raises
    ------
    InputError
        A unit is not known, two measure the same, or digits out of range.

    Examples
    --------
    >>> import linkwright as lw
    >>> with lw.shown_in("mm, rpm"):
    ...     lw.write_report(lw.study(machine), "report.html")  # doctest: +SKIP
    """
    if digits is not None and not 1 <= digits <= DIGITS_MAX:
        raise InputError(f"digits: found {digits}, expected 1 to {DIGITS_MAX}")
    shown = OutUnits.of(units, "units").over(reader())
    return reading(replace(shown, digits=digits or reader().digits))


def shown_columns(columns: Mapping[str, Floats]) -> dict[str, Floats]:
    """Columns of a table, heads with units in brackets → the same in the reader's units."""
    units = reader()
    return dict(units.column(head, values) for head, values in columns.items())
