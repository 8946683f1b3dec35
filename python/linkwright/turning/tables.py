"""The turning-moment diagram as tables, headline and formulas."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from linkwright.kernel.page.formulas import Formula
from linkwright.kernel.page.table import Row, Table, known_rows
from linkwright.kernel.reader.numbers import degrees, measured, number, parted
from linkwright.turning.diagram import TurningMomentDiagram
from linkwright.turning.model import TurningMoment

_SOURCE = "Rattan, Theory of Machines, chapter 13"
_RIM_SOURCE = "Khurmi, Gupta, Theory of Machines, chapter 16"

# Of the diagram, with their sources.
FORMULAS = (
    Formula("Energy absorbed by the shaft", "E = ∫ ( T − M ) d φ , Δ E = E_max − E_min", _SOURCE),
    Formula("Coefficient of speed fluctuation", "δ = frac(ω_max − ω_min|ω) = frac(Δ E|J ω^2)", _SOURCE),
)

# Of a rim, with its source.
RIM_FORMULAS = (
    Formula("Hoop stress of the rim", "σ = ρ v^2 , v = ω R", _RIM_SOURCE),
    Formula(
        "Mass and cross-section of the rim", "m_r = frac(k J_f|R^2) , A_r = frac(m_r|2 π R ρ)", _RIM_SOURCE
    ),
)


def turning_formulas(diagram: TurningMomentDiagram) -> list[Formula]:
    """Formulas of what was computed."""
    return [*FORMULAS, *(RIM_FORMULAS if diagram.rim_radius is not None else ())]


def turning_assumptions(described: TurningMoment) -> Iterator[str]:
    """What is taken for granted."""
    yield "Torques of driver and load depend only on the angle of the shaft, not on its speed."
    yield "The moment of inertia of the shaft is constant; the shaft is rigid."
    yield "The mean speed is the mean of the extreme speeds."


def turning_headline(diagram: TurningMomentDiagram) -> Iterator[tuple[str, str, str]]:
    """Word, value and unit of what one looks for first."""
    yield "fluctuation of energy ΔE", *parted(diagram.energy_fluctuation, "J")
    if diagram.unevenness is not None:
        yield "speed fluctuation δ", number(diagram.unevenness), ""
    if diagram.flywheel_inertia is not None:
        yield "inertia of the flywheel", *parted(diagram.flywheel_inertia, "kg m²")
    if diagram.flywheel_mass is not None:
        yield "mass of the flywheel", *parted(diagram.flywheel_mass, "kg")
    if diagram.power_mean is not None:
        yield "mean power", *parted(diagram.power_mean, "W")


def turning_tables(diagram: TurningMomentDiagram) -> Iterator[Table]:
    """The diagram, the flywheel, and the areas between driver and load."""
    heads = ("quantity", "", "value", "where")
    yield Table("turning_moment", "Turning-moment diagram", heads, _rows(diagram, "turning_moment"))
    # Without a moment of inertia, the mean speed alone says nothing of the motion.
    evened = _rows(diagram, "flywheel", without=() if diagram.inertia is not None else ("speed_mean",))
    if evened:
        yield Table("flywheel", "Speed and flywheel", heads, evened)
    if diagram.rim_radius is not None:
        yield Table("rim", "Rim of the flywheel", heads, _rows(diagram, "rim"))
    if diagram.areas:
        yield _areas(diagram)


def _rows(diagram: TurningMomentDiagram, table: str, *, without: Collection[str] = ()) -> list[Row]:
    # A constant torque has its extremes everywhere.
    is_constant = diagram.torque_driver_max == diagram.torque_driver_min
    beside = {"torque_driver_max": "", "torque_driver_min": ""} if is_constant else {}
    return known_rows(diagram, table, beside, at=lambda angle: f"at φ = {degrees(angle)}", without=without)


def _areas(diagram: TurningMomentDiagram) -> Table:
    rows: list[Row] = []
    # What is left after the last area is rounding.
    scale = max(abs(area["energy"] or 0.0) for area in diagram.areas)
    for n, area in enumerate(diagram.areas, start=1):
        start, end = area["start"], area["end"]
        place = "" if start is None or end is None else f", {degrees(start)} to {degrees(end)}"
        energies = (measured(area[name], "J", scale) for name in ("energy", "energy_after"))
        rows.append((f"{n}{place}", "", *energies))
    return Table("areas", "Areas between driver and load", ("area", "", "energy", "excess after it"), rows)
