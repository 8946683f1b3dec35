"""The turning-moment diagram as tables, headline and formulas."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.kernel.page.formulas import Formula, formula
from linkwright.kernel.page.quantities import degrees, number
from linkwright.kernel.page.table import Row, Table, with_unit
from linkwright.turning.diagram import TurningMomentDiagram

_SOURCE = "Rattan, Theory of Machines, chapter 13"

FORMULAS = (
    formula("Energy that the shaft has taken up", "E = ∫ ( T − M ) d φ , Δ E = E_max − E_min", _SOURCE),
    formula("Coefficient of speed fluctuation", "δ = frac(ω_max − ω_min|ω) = frac(Δ E|J ω^2)", _SOURCE),
)


ASSUMPTIONS = (
    "Torques of driver and load depend on the shaft's angle alone, not on its speed.",
    "The moment of inertia of the shaft does not change with the angle; the shaft is rigid.",
    "The mean speed is the mean of the extreme speeds.",
)


def turning_formulas() -> list[Formula]:
    """Formulas of the diagram with their sources."""
    return list(FORMULAS)


def turning_headline(found: TurningMomentDiagram) -> Iterator[tuple[str, str, str]]:
    """Word, value and unit of what one looks for first."""
    yield "fluctuation of energy ΔE", number(found.energy_fluctuation, 4), "J"
    if found.unevenness is not None:
        yield "speed fluctuation δ", number(found.unevenness, 4), ""
    if found.flywheel_inertia is not None:
        yield "inertia of the flywheel", number(found.flywheel_inertia, 4), "kg m²"
    if found.flywheel_mass is not None:
        yield "mass of the flywheel", number(found.flywheel_mass, 4), "kg"
    if found.power_mean is not None:
        yield "mean power", number(found.power_mean, 4), "W"


def turning_tables(found: TurningMomentDiagram) -> Iterator[Table]:
    """The diagram, the flywheel, and the areas between driver and load."""
    heads = ("quantity", "", "value", "where")
    yield Table("turning_moment", "Turning-moment diagram", heads, list(_diagram(found)))
    evened = list(_evened(found))
    if evened:
        yield Table("flywheel", "Speed and flywheel", heads, evened)
    if found.areas:
        yield _areas(found)


def _diagram(found: TurningMomentDiagram) -> Iterator[Row]:
    if found.torque_mean is not None:
        yield "mean torque", "T_mean", with_unit(found.torque_mean, "N m"), ""
        yield from _extreme("maximum torque of the driver", "T_max", found, "torque_driver_max", "N m")
        yield from _extreme("minimum torque of the driver", "T_min", found, "torque_driver_min", "N m")
        yield "mean power", "P_mean", with_unit(found.power_mean, "W"), ""
        yield "work of the driver per cycle", "A", with_unit(found.energy_cycle, "J"), ""
    yield "maximum fluctuation of energy", "ΔE", with_unit(found.energy_fluctuation, "J"), ""
    if found.energy_coefficient is not None:
        yield "coefficient of fluctuation of energy", "C_E", number(found.energy_coefficient), ""


def _evened(found: TurningMomentDiagram) -> Iterator[Row]:
    if found.flywheel_inertia is not None:
        yield "moment of inertia of the flywheel", "J_f", with_unit(found.flywheel_inertia, "kg m²"), ""
    if found.flywheel_mass is not None:
        yield "mass of the flywheel", "m", with_unit(found.flywheel_mass, "kg"), ""
    if found.inertia is None:
        return
    yield "moment of inertia of the shaft", "J", with_unit(found.inertia, "kg m²"), ""
    yield "coefficient of speed fluctuation", "δ", number(found.unevenness), ""
    yield "mean speed", "ω", with_unit(found.speed_mean, "rad/s"), ""
    yield from _extreme("maximum speed", "ω_max", found, "speed_max", "rad/s")
    yield from _extreme("minimum speed", "ω_min", found, "speed_min", "rad/s")
    if found.acceleration_max is not None:
        yield "maximum acceleration", "ε_max", with_unit(found.acceleration_max, "rad/s²"), ""
        yield "minimum acceleration", "ε_min", with_unit(found.acceleration_min, "rad/s²"), ""


def _extreme(word: str, symbol: str, found: TurningMomentDiagram, name: str, unit: str) -> Iterator[Row]:
    angle = getattr(found, f"{name}_angle")
    where = "" if angle is None else f"at φ = {degrees(angle)}"
    yield word, symbol, with_unit(getattr(found, name), unit), where


def _areas(found: TurningMomentDiagram) -> Table:
    """Energies between the crossings, and the excess after each."""
    rows: list[Row] = []
    for n, area in enumerate(found.areas, start=1):
        start, end = area["start"], area["end"]
        place = "" if start is None or end is None else f", {degrees(start)} to {degrees(end)}"
        energies = (with_unit(area[name], "J") for name in ("energy", "energy_after"))
        rows.append((f"{n}{place}", "", *energies))
    return Table("areas", "Areas between driver and load", ("area", "", "energy", "excess after it"), rows)
