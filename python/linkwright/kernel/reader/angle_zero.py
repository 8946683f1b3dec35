"""Crank angles as they are shown: counted from where the machine file counts, or from a dead centre.

Tables, figures, heads of CSV and sentences ask `zero_shown`; what is computed, and JSON, count as the file
does.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from math import isfinite, pi
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from linkwright.kernel.arrays import Floats

# An angle as near as this to the end of its cycle is its beginning [rad]: rounding of a root.
_ROUNDING = 2e-8

# Columns of crank angles and of the time in a table of curves.
_COLUMN, _TIME = "crank_angle [rad]", "time [s]"
# Column of the time from rest, with which a motion does not repeat.
_IN_TIME = "crank_time [s]"


class Zero(NamedTuple):
    """A crank angle from which others are counted.

    Attributes
    ----------
    angle : float
        Within one period of the mechanism, if it repeats [rad].
    words : str
        Such as ``"inner dead centre of ram"``; empty where angles are those of the file.
    cycle : float
        After which all that is shown repeats [rad]; 0 where it does not, as within a range of crank angles.
    """

    angle: float = 0.0
    words: str = ""
    cycle: float = 0.0

    def counted(self, angle: float) -> float:
        """A crank angle of the file [rad] as it is shown: within the cycle, from 0 on."""
        if not self.words:
            return angle
        at = angle - self.angle
        if self.cycle:
            at %= self.cycle
            return 0.0 if self.cycle - at < _ROUNDING else at
        return at

    def rolled(self, angle: Floats, columns: Mapping[str, Floats]) -> tuple[Floats, dict[str, Floats]]:
        """Angles [rad], (n,), and curves over them by head with a unit, (n,), as they are shown.

        Over a whole cycle they begin at the zero; time, and the angle of a link that turns, go on growing.
        Other angles are counted from the zero and stay in their order.
        """
        cycle = self.cycle_of(angle)
        if not cycle:
            return (angle - self.angle if self.words else angle), dict(columns)
        # Sample at the zero, or behind it; what ends the cycle begins it again.
        into = (self.angle - angle[0]) % cycle
        behind = 0.0 if cycle - into < _ROUNDING else into
        start = int(angle[:-1].searchsorted(angle[0] + behind - _ROUNDING))
        counted = _turned(angle, start, cycle)
        counted += self._replace(cycle=cycle).counted(float(counted[0])) - counted[0]
        return counted, {name: _turned(own, start, _growth(name, own)) for name, own in columns.items()}

    def cycle_of(self, angle: Floats) -> float:
        """Cycle through which angles run once [rad]: some periods of the mechanism; 0 if it is none."""
        if not (self.words and self.cycle and len(angle) > 2):
            return 0.0
        span = float(angle[-1] - angle[0])
        turns = round(span / (2 * pi))
        is_cycle = turns > 0 and abs(span - 2 * pi * turns) < _WHOLE
        return 2 * pi * turns if is_cycle else 0.0


# How far the ends of a cycle are from whole revolutions at most [rad].
_WHOLE = 1e-6

_FILE = Zero()
_SHOWN: ContextVar[Zero] = ContextVar("angle_zero", default=_FILE)


def zero_shown() -> Zero:
    """From where crank angles are counted in what is being printed or drawn."""
    return _SHOWN.get()


@contextmanager
def counting(zero: Zero) -> Iterator[None]:
    """Show crank angles from this zero as long as the block lasts."""
    token = _SHOWN.set(zero)
    try:
        yield
    finally:
        _SHOWN.reset(token)


def counted_columns(columns: Mapping[str, Floats]) -> dict[str, Floats]:
    """Columns of a table by head; crank angles from the zero that is shown.

    Of curves over a whole cycle the rows begin there too; what runs over the time from rest keeps its rows.
    """
    zero = zero_shown()
    if not zero.words or _COLUMN not in columns:
        return dict(columns)
    angle = columns[_COLUMN]
    if _IN_TIME in columns:
        return {**columns, _COLUMN: angle - zero.angle}
    # Columns of another length do not run over the crank angle.
    own = {name: values for name, values in columns.items() if len(values) == len(angle)}
    counted, curves = zero.rolled(angle, own)
    if _TIME in curves:
        curves[_TIME] = curves[_TIME] - curves[_TIME][0]
    return {**columns, **curves, _COLUMN: counted}


def _turned(values: Floats, start: int, growth: float) -> Floats:
    """Values over a cycle, both ends included, from a sample on; by how much they grow over the cycle."""
    # Imported here: what prints a help text needs no arrays.
    import numpy as np

    return np.concatenate([values[start:-1], values[: start + 1] + growth])


def _growth(head: str, values: Floats) -> float:
    """By how much a column grows over the cycle: time, and angles by whole revolutions."""
    rise = float(values[-1] - values[0])
    if head == _TIME:
        return rise
    is_angle = head.endswith("[rad]") and isfinite(rise)
    return 2 * pi * round(rise / (2 * pi)) if is_angle else 0.0
