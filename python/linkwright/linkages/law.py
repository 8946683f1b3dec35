r"""Laws of the driver: the crank angle over time with three derivatives.

| law | is |
| --- | --- |
| `PolynomialLaw` | :math:`\varphi = \sum c_k t^k` |
| `RampLaw` | from rest to rest, or from rest to a speed, by polynomials on [0, 1] |
| `TableLaw` | natural cubic spline through points |
| `FunctionLaw` | a function written with numpy |
| `FormulaLaw` | a formula of the time, as a user writes it |

A user gives points as a table of times and angles too: `read_law_table`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.formula import NUMBERS, FormulaError, names, parse
from linkwright.kernel.errors import InputError, MachineFileError, Problem, ShapeError, UnitError, show
from linkwright.kernel.files.text_file import TextError, text_of
from linkwright.kernel.limits import POINT_BYTES
from linkwright.kernel.numerics.formula_value import OPERATIONS, value
from linkwright.kernel.numerics.taylor import Taylor
from linkwright.kernel.public.arguments import rows, shown
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.units.kinds import ANGLE, TIME, Kind
from linkwright.kernel.units.marks import Quantity
from linkwright.kernel.units.reading import NUMBER
from linkwright.kernel.units.reading import parse as parse_quantity


class Law(Protocol):
    """What moves the crank."""

    def at(self, times: Floats) -> Floats:
        """Crank angle and three derivatives at times (n,) [s]: (4, n) [rad, rad/s, rad/s², rad/s³]."""


@dataclass(frozen=True)
class PolynomialLaw:
    """A polynomial of time.

    Attributes
    ----------
    coefficients : tuple of float
        Of 1, t, t², … [rad, rad/s, rad/s², …].
    """

    coefficients: tuple[float, ...]

    def at(self, times: Floats) -> Floats:
        """See `Law.at`."""
        return _polynomial(self.coefficients, times)


def constant_speed(speed: float, start: float = 0.0) -> PolynomialLaw:
    """The crank at a constant speed [rad/s], from an angle at time zero [rad]."""
    return PolynomialLaw((start, speed))


# Rise from 0 to 1 on [0, 1] (VDI 2143): coefficients of 1, u, u², ….
_RISES = {
    "3-4-5": (0.0, 0.0, 0.0, 10.0, -15.0, 6.0),
    "4-5-6-7": (0.0, 0.0, 0.0, 0.0, 35.0, -84.0, 70.0, -20.0),
}


@dataclass(frozen=True)
class RampLaw:
    r"""From rest through an angle to rest again, or from rest to a constant speed.

    Attributes
    ----------
    duration : float
        [s].
    angle : float
        Turned from rest to rest [rad]; zero with ``speed``.
    speed : float
        Kept after the ramp [rad/s]; zero with ``angle``. The speed then rises by the polynomial.
    start : float
        Crank angle at time zero [rad].
    shape : str
        ``"3-4-5"``, whose jerk jumps at the ends, or ``"4-5-6-7"``, whose jerk starts from zero.

    References
    ----------
    .. [1] VDI 2143: motion rules for cams.
    """

    duration: float
    angle: float = 0.0
    speed: float = 0.0
    start: float = 0.0
    shape: str = "3-4-5"

    def __post_init__(self) -> None:
        if not self.duration > 0 or self.shape not in _RISES or bool(self.angle) == bool(self.speed):
            raise ShapeError(
                f"a ramp needs a duration above zero, a shape of {' or '.join(_RISES)}, and either an angle "
                f"or a speed; found duration {self.duration!r}, shape {self.shape!r}, angle {self.angle!r}, "
                f"speed {self.speed!r}"
            )

    def at(self, times: Floats) -> Floats:
        """See `Law.at`."""
        T = self.duration
        u = np.clip(times / T, 0.0, 1.0)
        rise = _polynomial(_RISES[self.shape], u)
        scale = T ** -np.arange(4.0)[:, None]
        inside = (times >= 0) & (times <= T)
        if self.angle:
            angle = self.angle * rise * scale
            angle[1:] *= inside
        else:
            # φ = ω T ∫ rise du, and ω (t − T) beyond.
            course = [0.0, *(c / (k + 1) for k, c in enumerate(_RISES[self.shape]))]
            angle = np.stack([_polynomial(course, u)[0], rise[0], rise[1], rise[2]]) * self.speed * T * scale
            angle[0] += self.speed * np.maximum(times - T, 0.0)
            angle[2:] *= inside
        angle[0] += self.start
        return angle


class TableLaw:
    """A natural cubic spline through points: speed and acceleration are continuous, the jerk jumps.

    Parameters
    ----------
    times, angles : array_like, shape (n,)
        Points, times increasing [s, rad].

    Raises
    ------
    ShapeError
        Fewer than three points, times that do not increase, or numbers that are not finite.
    """

    def __init__(self, times: ArrayLike, angles: ArrayLike) -> None:
        in_range(times=(times, Quantity(TIME)), angles=(angles, Quantity(ANGLE)))
        t, phi = (np.asarray(values, dtype=float) for values in (times, angles))
        if t.ndim != 1 or t.shape != phi.shape or len(t) < 3:
            raise ShapeError(
                f"a table of times and angles needs two lists of one length, at least 3 numbers each; "
                f"found shapes {t.shape} and {phi.shape}"
            )
        # Of what is closer together than the smallest time, no speed can be given.
        close = np.diff(t) < TIME.least / 2
        if close.any():
            at = int(np.argmax(close))
            raise ShapeError(
                f"times must increase by {TIME.least:g} s or more; found {t[at]:g} s followed by "
                f"{t[at + 1]:g} s"
            )
        self.times, self.angles = t, phi
        self._bend = _natural_spline(t, phi)

    def at(self, times: Floats) -> Floats:
        """See `Law.at`; beyond the table its end polynomials go on."""
        t, y, m = self.times, self.angles, self._bend
        k = np.clip(np.searchsorted(t, times, side="right") - 1, 0, len(t) - 2)
        h, x = t[k + 1] - t[k], times - t[k]
        jerk = (m[k + 1] - m[k]) / h
        slope = (y[k + 1] - y[k]) / h - h * (2 * m[k] + m[k + 1]) / 6
        angle = y[k] + x * (slope + x * (m[k] / 2 + x * jerk / 6))
        return np.stack([angle, slope + x * (m[k] + x * jerk / 2), m[k] + x * jerk, jerk])


def _natural_spline(t: Floats, y: Floats) -> Floats:
    """Second derivatives at the points, zero at the ends; by elimination in the tridiagonal system."""
    h, n = np.diff(t), len(t)
    right = 6 * np.diff(np.diff(y) / h)
    diagonal = 2 * (h[:-1] + h[1:])
    for k in range(1, n - 2):
        share = h[k] / diagonal[k - 1]
        diagonal[k] -= share * h[k]
        right[k] -= share * right[k - 1]
    bend = np.zeros(n)
    for k in range(n - 2, 0, -1):
        bend[k] = (right[k - 1] - h[k] * bend[k + 1]) / diagonal[k - 1]
    return bend


class FunctionLaw:
    """A function of time written with numpy; its derivatives follow by Taylor arithmetic.

    Parameters
    ----------
    function : callable
        Takes times [s], gives angles [rad]. It may use arithmetic, numpy's elementary functions, comparisons
        and `numpy.where`.
    """

    def __init__(self, function: Callable[[Any], Any]) -> None:
        self.function = function

    def at(self, times: Floats) -> Floats:
        """See `Law.at`; a `ShapeError` if the function uses something without a known derivative."""
        variable = Taylor.variable(np.asarray(times, dtype=float))
        try:
            # Where the law has no value or is beyond all numbers, `motion` says when.
            with np.errstate(all="ignore"):
                return variable._like(self.function(variable)).derivatives
        except ValueError as error:
            raise ShapeError(f"the law gives what is no angle: {error}") from None
        except TypeError as error:
            raise ShapeError(
                f"the law uses a function without a known derivative ({error}); write it with arithmetic and "
                "numpy's elementary functions, or give it as a table"
            ) from None


def as_law(law: Law | Callable[[Any], Any] | Sequence[ArrayLike]) -> Law:
    """A law, function, or pair of times and angles (n,) as a law; `ShapeError` for anything else."""
    if hasattr(law, "at") and callable(law.at):
        return law
    if callable(law):
        return FunctionLaw(law)
    if (
        isinstance(law, tuple | list | np.ndarray)
        and (not isinstance(law, np.ndarray) or law.ndim)
        and len(law) == 2
    ):
        return TableLaw(rows("law: times", law[0]), rows("law: angles", law[1]))
    raise ShapeError(f"a law, a function of time or a pair of times and angles is needed, found {shown(law)}")


def _polynomial(coefficients: Sequence[float], x: Floats) -> Floats:
    """Value and three derivatives of a polynomial, (4, n)."""
    p = np.polynomial.Polynomial(list(coefficients))
    return np.stack([(p.deriv(k) if k else p)(x) + np.zeros_like(x) for k in range(4)])


def read_law_table(path: Path) -> tuple[list[float], list[float]]:
    """Read times [s] and angles [rad], a line for each point, parted by a comma or a semicolon.

    A first line without numbers is the head. Raises `MachineFileError`, with file and line, if the file
    cannot be read, or a line is no time and angle.
    """
    try:
        lines = text_of(path, POINT_BYTES).splitlines()
    except TextError as error:
        expected = "a table of times and angles"
        raise MachineFileError([Problem("", error.found, expected, error.remedy, str(path))]) from None
    rows: list[tuple[float, float]] = []
    for nth, line in enumerate(lines, start=1):
        cells = [cell.strip() for cell in line.replace(";", ",").split(",")]
        are_numbers = [NUMBER.fullmatch(cell) is not None for cell in cells]
        if are_numbers == [True, True]:
            rows.append((_number(cells[0], TIME, path, nth), _number(cells[1], ANGLE, path, nth)))
        elif any(are_numbers) or (nth > 1 and line.strip()):
            expected = "a time [s] and an angle [rad]"
            raise MachineFileError([Problem("", show(line), expected, "", str(path), nth)])
    return [time for time, _ in rows], [angle for _, angle in rows]


def _number(cell: str, kind: Kind, path: Path, line: int) -> float:
    """A number of the table; its line, if it is no such quantity."""
    try:
        return parse_quantity(float(cell), kind)
    except UnitError as error:
        raise MachineFileError([replace(error.problem, path=str(path), line=line)]) from None


# Functions that a number with derivatives does not know, made of others that it does.
_OPERATIONS: dict[str, Callable[..., Any]] = {
    **OPERATIONS,
    "sign": lambda x: np.where(x > 0, 1.0 + 0.0 * x, np.where(x < 0, -1.0 + 0.0 * x, 0.0 * x)),
    "step": lambda x: np.where(x >= 0, 1.0 + 0.0 * x, 0.0 * x),
    "atan2": lambda y, x: 2 * np.arctan(y / (np.sqrt(x * x + y * y) + x)),
}


@dataclass(frozen=True)
class FormulaLaw:
    """The crank angle [rad] as a formula of the time t [s].

    Attributes
    ----------
    text : str
        In the language of the loads' formulas, with ``t`` as the only variable.
    """

    text: str

    def __post_init__(self) -> None:
        """Read it once, for its errors. Raises InputError: it is no formula of t."""
        try:
            asked = names(parse(self.text))
        except FormulaError as error:
            remedy = f"; {error.remedy}" if error.remedy else ""
            raise InputError(
                f'law: found "{self.text}", expected a formula of t: {error.expected}{remedy}'
            ) from None
        wrong = [name for name in asked if name != "t" and name not in NUMBERS]
        if wrong:
            raise InputError(
                f'law: found "{wrong[0]}" in "{self.text}", expected t, pi, g, numbers and functions'
            )

    def at(self, times: Floats) -> Floats:
        """See `Law.at`."""
        tree = parse(self.text)
        return FunctionLaw(lambda t: value(tree, {**NUMBERS, "t": t}, _OPERATIONS)).at(times)
