"""Units in which numbers are shown: SI, unless others are asked for, such as ``mm,rpm,kN``.

A unit of length is taken for velocities and accelerations too: with ``mm``, m/s² is shown as mm/s².
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.errors import InputError
from linkwright.kernel.units.kinds import Dimension
from linkwright.kernel.units.spellings import factor_of, unknown

Floats = NDArray[np.float64]

_POWERS = str.maketrans({"²": "^2", "³": "^3", "⁴": "^4", "·": " "})
_RAISED = re.compile(r"\^([234])")
_RAISE = {"2": "²", "3": "³", "4": "⁴"}
_PER_TIME = re.compile(r"m(/s(?:\^[234])?)")


@dataclass(frozen=True)
class OutUnits:
    """Units for what is shown.

    Attributes
    ----------
    chosen : tuple of tuple
        Of each unit its spelling, its factor to SI and its dimension.
    """

    chosen: tuple[tuple[str, float, Dimension], ...] = ()

    @classmethod
    def of(cls, text: str) -> OutUnits:
        """Units by a list such as ``"mm, rpm, kN"``.

        Raises
        ------
        InputError
            A unit is not known, or two measure the same.
        """
        found: list[tuple[str, float, Dimension]] = []
        for name in (part.strip() for part in text.split(",") if part.strip()):
            known = factor_of(name)
            if known is None:
                raise InputError(f"--units: {unknown(name)}")
            same = next((other for other, _, dimension in found if dimension == known[1]), None)
            if same is not None:
                raise InputError(f"--units: found {same} and {name}, expected one unit of a kind")
            found.append((name, *known))
        return cls(tuple(found))

    def with_degrees(self) -> OutUnits:
        """The same with angles in degrees, unless another unit of angles is wanted."""
        if any(dimension == Dimension(rad=1) for _, _, dimension in self.chosen):
            return self
        return OutUnits((*self.chosen, *OutUnits.of("deg").chosen))

    def shown(self, unit: str) -> tuple[str, float]:
        """How a quantity of an SI unit is shown.

        Parameters
        ----------
        unit : str
            Coherent SI unit; empty for a plain number.

        Returns
        -------
        str, float
            The unit in which it is shown, and by what its SI value is divided.
        """
        plain = unit.translate(_POWERS)
        try:
            dimension = Dimension.of(plain) if unit else None
        except KeyError:
            # What has two units, or one of its own, is shown as it is.
            return unit, 1.0
        for name, factor, other in self.chosen:
            if other == dimension:
                return _pretty(name), factor
        rate = _PER_TIME.fullmatch(plain)
        length = next(((n, f) for n, f, other in self.chosen if other == Dimension(m=1)), None)
        if rate and length:
            return _pretty(length[0] + rate[1]), length[1]
        return unit, 1.0


def _pretty(unit: str) -> str:
    """With raised powers, and degrees as a sign."""
    text = _RAISED.sub(lambda power: _RAISE[power[1]], unit)
    return "°" if text == "deg" else text


def shown_columns(
    curves: Mapping[str, Floats], unit_of: Callable[[str], str], units: OutUnits
) -> dict[str, Floats]:
    """Curves as columns of a table in the units that are wanted.

    Parameters
    ----------
    curves : mapping of str to ndarray, shape (n,)
        By name, in SI.
    unit_of : callable
        Name → SI unit.
    units : OutUnits
        What is wanted.

    Returns
    -------
    dict of str to ndarray, shape (n,)
        Head with the unit → values.
    """
    columns = {}
    for name, curve in curves.items():
        unit, factor = units.shown(unit_of(name))
        columns[f"{name} [{unit or '-'}]"] = curve / factor
    return columns
