"""Units of an FMU: base units by their exponents, and the units that the importing tool shows.

FMI 2.0.4, 2.2.2 and FMI 3.0.1, 2.4.2: a unit has a factor and the exponents of the SI base units; a value v
is shown as factor · v in a display unit. Names are written as Modelica writes them: ``N.m``, ``rad/s2``.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import NamedTuple

from linkwright.kernel.reader.out_units import OutUnits
from linkwright.kernel.units.kinds import Dimension

_RAISED = str.maketrans({"²": "^2", "³": "^3", "⁴": "^4"})

# In which units tools show what nobody wants in others.
_USUAL = {"rad": "deg", "rad/s": "rpm"}


class UnitDefinition(NamedTuple):
    """A unit of the FMU."""

    name: str
    exponents: dict[str, int]  # of the SI base units, without those that are zero
    shown: tuple[str, float] | None  # unit for display, and by what a value is multiplied


def unit_name(unit: str) -> str:
    """An SI unit as Modelica writes it."""
    return re.sub(r"\s+", ".", unit.translate(_RAISED).strip()).replace("^", "")


def unit_definitions(units: Iterable[str], wanted: OutUnits) -> list[UnitDefinition]:
    """Definitions of SI units, each once, in the order of their names. `wanted`: what the reader prefers."""
    return [_definition(unit, wanted) for unit in sorted({unit for unit in units if unit}, key=unit_name)]


def _definition(unit: str, wanted: OutUnits) -> UnitDefinition:
    """One unit with its exponents."""
    exponents = {
        name: power for name, power in Dimension.of(unit.translate(_RAISED))._asdict().items() if power
    }
    name, factor = wanted.shown(unit, _USUAL.get(unit, ""))
    name = "deg" if name == "°" else unit_name(name)
    return UnitDefinition(unit_name(unit), exponents, None if factor == 1.0 else (name, 1.0 / factor))
