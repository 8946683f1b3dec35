"""Results of rod strings as tables of text."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from linkwright.kernel.page.table import (
    Row,
    Table,
    columns_csv,
    few,
    known_rows,
    part_table,
    parts_of,
    rows_of,
)
from linkwright.kernel.reader.numbers import measured, number
from linkwright.kernel.units.kinds import VOLUME_FLOW
from linkwright.kernel.units.reading import parse
from linkwright.pumping.gear_torque import GearTorque
from linkwright.rods.diagnosis import CardDiagnosis
from linkwright.rods.prediction import RodStringMotion
from linkwright.rods.stress import RodStress

_HEADS = ("quantity", "", "value", "")


def string_tables(motion: RodStringMotion) -> Iterator[Table]:
    """Loads, strokes and powers; stresses of the sections; the gearbox; terms of API RP 11L."""
    beside = {"production": barrels(motion.production), "period": f"{number(60 / motion.period)} strokes/min"}
    yield Table("rod_string", "Rod string", _HEADS, known_rows(motion, "rod_string", beside))
    yield sections_table(motion.stress)
    if motion.gear is not None and motion.gear_best is not None:
        yield _gear(motion.gear, motion.gear_best)
    if motion.drive is not None:
        rows = [*rows_of(motion.drive, "speed_min", "speed_max"), *known_rows(motion.drive, "drive")]
        yield Table("rod_drive", "Drive under the rod string", _HEADS, rows)
    yield Table("rod_numbers", "Terms of API RP 11L", _HEADS, known_rows(motion.numbers, "rod_numbers"))


def string_headline(motion: RodStringMotion) -> Iterator[tuple[str, str, str]]:
    """Peak loads, plunger stroke, production by the day, loading of rods and gearbox."""
    yield from few(motion, ("load_max", "load_min", "plunger_stroke", "production", "power_rod"))
    if motion.stress.loading_max is not None:
        yield "maximum Goodman loading", number(100 * motion.stress.loading_max), "%"
    if motion.gear is not None and motion.gear.gear_load is not None:
        yield "maximum torque over the rating", number(100 * motion.gear.gear_load), "%"


def diagnosis_headline(found: CardDiagnosis) -> Iterator[tuple[str, str, str]]:
    """Pump stroke, fluid load and fillage of a measured card, production by the day."""
    yield from few(found, ("plunger_stroke", "fluid_load"), "measured card: ")
    yield "measured card: fillage", number(100 * found.fillage), "%"
    yield from few(found, ("production",), "measured card: ")


def diagnosis_tables(found: CardDiagnosis) -> Iterator[Table]:
    """What the card tells of the pump; stresses of the sections."""
    beside = {"production": barrels(found.production), "damping": "fitted" if found.is_fitted else ""}
    yield Table("diagnosis", "Diagnosis of the card", _HEADS, known_rows(found, "diagnosis", beside))
    yield sections_table(found.stress)


def barrels(flow: float) -> str:
    """A flow in barrels of 42 US gallons by the day."""
    # Beside the flow in the reader's unit, always in barrels.
    return f"{number(flow / parse('1 bbl/d', VOLUME_FLOW))} bbl/d"


def sections_table(stress: RodStress) -> Table:
    """A row a section: loads, stresses, Goodman loading."""
    return part_table(
        "rod_sections",
        "Sections of the rod string",
        parts_of(stress, "sections"),
        (
            "section",
            "length",
            "maximum load",
            "minimum load",
            "maximum stress",
            "minimum stress",
            "Goodman loading",
        ),
        _name,
        "length",
        "load_max",
        "load_min",
        "stress_max",
        "stress_min",
        _loading,
    )


def _name(section: Any) -> str:
    return str(section.name)


def _loading(section: Any) -> str:
    loading = section.loading
    return "–" if np.isnan(loading) else f"{number(100 * loading)} %"


def _gear(gear: GearTorque, best: GearTorque) -> Table:
    """Torques with the given counterbalance, and with the best one where it is another."""
    rated = {"torque_net_up": f"rated {measured(gear.torque_rated, 'N m')}"} if gear.torque_rated else {}
    # Work and maximum load are those of the string, not those of the straight lines between angles.
    rows, of_best = (
        known_rows(each, "gear_torque", rated, without=("load_max", "work")) for each in (gear, best)
    )
    heads: Row = ("quantity", "", "value", "rating")
    if best is not gear:
        heads = ("quantity", "", "value", "best counterbalance", "rating")
        beside = {row[0]: row[2] for row in of_best}
        rows = [(*row[:3], beside.get(row[0], "–"), row[3]) for row in rows]
    return Table("rod_gear", "Torque of the gearbox under the rod string", heads, rows)


def cards_csv(result: RodStringMotion | CardDiagnosis) -> str:
    """Position and load at every station over time."""
    columns = {"time [s]": result.time}
    for station, position, load in zip(result.stations, result.position, result.load, strict=True):
        name = station.replace(" ", "_")
        columns |= {f"{name}_position [m]": position, f"{name}_load [N]": load}
    return columns_csv(columns | {"rod_load [N]": result.rod_load})
