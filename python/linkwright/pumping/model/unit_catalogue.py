"""Published pumping units: dimensions by the letters of API Spec 11E, from `pumping_units.json`.

The file has inches and pounds as its source has them; here everything is SI.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import InputError, MachineError, Problem
from linkwright.kernel.units import show
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

    def unit(self, hole: int = 1) -> PumpingUnit:
        """The unit with its crank pin in one of the holes.

        Parameters
        ----------
        hole : int
            1 for the outermost.

        Returns
        -------
        PumpingUnit
            Of conventional geometry.

        Raises
        ------
        InputError
            There is no such hole.
        """
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
    """One unit of the catalogue.

    Parameters
    ----------
    designation : str
        Such as ``"C-114D-133-54"``; capitals do not matter.

    Returns
    -------
    CatalogueUnit
        In SI.

    Raises
    ------
    MachineError
        There is no such unit; the remedy names close ones.

    Examples
    --------
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
    """The catalogue by designation."""
    import json
    import pkgutil

    data = pkgutil.get_data("linkwright.pumping.model", "pumping_units.json")
    assert data is not None, "pumping_units.json is part of the package"
    return {row["designation"]: _unit(row) for row in json.loads(data)["units"]}


def _unit(row: dict[str, Any]) -> CatalogueUnit:
    """One row in SI."""
    return CatalogueUnit(
        designation=row["designation"],
        **{name: row[name] * INCH for name in _LETTERS},
        holes=tuple(radius * INCH for radius in row["R_holes"]),
        structural_unbalance=row["structural_unbalance_lbf"] * POUND_FORCE,
    )
