"""Published pumping units by the letters of API Spec 11E, from `pumping_units.json`, and their machine files.

The file has inches and pounds as its source has them; here everything is SI.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import InputError, MachineError, Problem, show
from linkwright.kernel.public import public
from linkwright.pumping.model.unit import INCH, POUND_FORCE, PumpingUnit, Rating, rating_of


@dataclass(frozen=True, slots=True)
class CatalogueUnit:
    """One published pumping unit.

    Attributes
    ----------
    designation : str
        By API.
    A, C, I, P, H, G : float
        Dimensions by the letters of API [m].
    holes : tuple of float
        Crank radii, from the outermost hole in [m].
    structural_unbalance : float
        [N].
    """

    designation: str
    A: float
    C: float
    I: float  # noqa: E741
    P: float
    H: float
    G: float
    holes: tuple[float, ...]
    structural_unbalance: float

    @property
    def rating(self) -> Rating:
        """What the designation says."""
        rating = rating_of(self.designation)
        assert rating is not None, "a designation of the catalogue"
        return rating

    @public
    def unit(self, hole: int = 1) -> PumpingUnit:
        """The conventional unit with its crank pin in a hole, 1 the outermost; else an `InputError`."""
        if not 1 <= hole <= len(self.holes):
            raise InputError(
                f"hole {hole}: {self.designation} has {len(self.holes)} crank holes; expected 1 (outermost) "
                f"to {len(self.holes)}"
            )
        letters = {name: getattr(self, name) for name in _LETTERS}
        return PumpingUnit(
            designation=self.designation,
            **letters,
            R=self.holes[hole - 1],
            structural_unbalance=self.structural_unbalance,
        )


_LETTERS = ("A", "C", "I", "P", "H", "G")


def pumping_units() -> tuple[CatalogueUnit, ...]:
    """All units of the catalogue, in its order.

    Returns
    -------
    tuple of CatalogueUnit
        In SI.
    """
    return tuple(_units().values())


def catalogue_unit(designation: str) -> CatalogueUnit:
    """One unit [SI] of the catalogue by its designation; capitals do not matter.

    Raises `MachineError`, whose remedy names close ones, if there is none.

    >>> round(catalogue_unit("C-114D-133-54").A, 4)
    1.8288
    """
    wanted = designation.strip().upper()
    unit = _units().get(wanted)
    if unit is None:
        expected, remedy = "a designation of the catalogue of pumping units", suggestion(wanted, _units())
        raise MachineError([Problem(found=show(designation), expected=expected, remedy=remedy)])
    return unit


@cache
def _units() -> dict[str, CatalogueUnit]:
    import json
    import pkgutil

    data = pkgutil.get_data("linkwright.pumping.model", "pumping_units.json")
    assert data is not None, "pumping_units.json is part of the package"
    return {row["designation"]: _unit(row) for row in json.loads(data)["units"]}


def _unit(row: dict[str, Any]) -> CatalogueUnit:
    return CatalogueUnit(
        designation=row["designation"],
        **{name: row[name] * INCH for name in _LETTERS},
        holes=tuple(radius * INCH for radius in row["R_holes"]),
        structural_unbalance=row["structural_unbalance_lbf"] * POUND_FORCE,
    )


# Comments of the letters, in the order of the file.
_WORDS = {
    "A": "saddle bearing to polished rod",
    "C": "saddle bearing to equalizer bearing",
    "I": "saddle bearing in front of the crankshaft",
    "P": "pitman",
    "H": "saddle bearing above the base",
    "G": "crankshaft above the base",
}


def unit_template(designation: str | None = None, hole: int | None = None) -> str:
    """A machine file of a pumping unit."""
    known = catalogue_unit(designation) if designation is not None else pumping_units()[0]
    number = 1 if hole is None else hole
    stroke = float(known.unit(number).stroke)
    return f"""\
# Beam pumping unit {known.designation}, crank pin in hole {number}.
# Dimensions by the letters of API Spec 11E.
#
# The stroke of the mechanism is {stroke:.4f} m;
# the longest by the designation is {known.rating.stroke:.4f} m.
format = 1
name = "Pumping unit {known.designation}, hole {number}"
source = "Guo, Lyons, Ghalambor, Petroleum Production Engineering, 2007, table 12.1"

[drive]
speed = "8 rpm"                          # strokes per minute

[pumping_unit]
geometry = "conventional"
designation = "{known.designation}"
{_dimensions(known, number)}
structural_unbalance = "{known.structural_unbalance / POUND_FORCE:.6g} lbf"

# Load of the polished rod; replace it by that of your well, or remove it.
[pumping_unit.load]
position = [0, 0.1, 1]                   # 0 at the bottom of the stroke, 1 at the top
up = {_loads(known, 0.45, 0.7, 0.65)}
down = {_loads(known, 0.45, 0.35, 0.3)}
counterbalance = "optimal"               # or the maximum moment of cranks and counterweights: "20 kN m"
"""


def _dimensions(unit: CatalogueUnit, hole: int) -> str:
    values = {name: getattr(unit, name) for name in _WORDS}
    lines = [_line(name, value, _WORDS[name]) for name, value in values.items()]
    others = ", ".join(f"{radius / INCH:.6g}" for radius in unit.holes)
    return "\n".join([*lines, _line("R", unit.holes[hole - 1], f"crank; holes at {others} in")])


def _line(name: str, value: float, words: str) -> str:
    entry = f'{name} = "{value / INCH:.6g} in"'
    return f"{entry:<40} # {words}"


def _loads(unit: CatalogueUnit, *shares: float) -> str:
    texts = (f'"{share * unit.rating.load / 1e3:.1f} kN"' for share in shares)
    return f"[{', '.join(texts)}]"
