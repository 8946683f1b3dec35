"""One printed statement beside what comes out, in words."""

from __future__ import annotations

from dataclasses import dataclass

from linkwright.papers.cell import Cell

# Share of the largest value by which two ways of computing it may differ for rounding: a hundred roundings of
# 1e-16, as in sums of polynomials whose derivatives grow with each order, and ten times as much for room.
ROUNDING = 1e-13


@dataclass(frozen=True)
class Row:
    """One printed number or statement, and what comes out.

    Attributes
    ----------
    name, printed, computed, verdict : str
        In words, with units.
    kind : str
        ``"reproduced"``, ``"near"``, ``"far"`` or ``"none"``.
    """

    name: str
    printed: str
    computed: str
    verdict: str
    kind: str

    @classmethod
    def taken(cls, name: str, printed: str) -> Row:
        """A value that the computation takes as printed."""
        return cls(name, printed, printed, "taken from the paper", "none")

    @classmethod
    def number(cls, name: str, unit: str, cell: Cell, computed: str = "") -> Row:
        """A printed number with its deviation.

        Parameters
        ----------
        name, unit : str
            What it is.
        cell : Cell
            Printed and computed.
        computed : str
            What comes out, in words; without it, the computed number.
        """
        shown = computed or f"{cell.computed:.6g} {unit}"
        return cls(name, f"{cell.published:.10g} {unit}", shown, cell.verdict, cell.kind)

    @classmethod
    def agreement(cls, name: str, printed: str, difference: float, because: str) -> Row:
        """A printed formula against another way of computing the same.

        Parameters
        ----------
        name, printed : str
            What it is, and as printed.
        difference : float
            The largest, as a share of the largest value [–].
        because : str
            Why it differs, if it does.
        """
        shown = f"the same to {difference:.0e}" if difference else "the same"
        if difference <= ROUNDING:
            return cls(name, printed, shown, "reproduced to rounding", "reproduced")
        return cls(name, printed, shown, f"not reproduced because {because}", "far")
