"""Tables of the torsional system as forms of classification societies ask for it, and of its gear stages.

Masses and stiffnesses; of each stage torque, application factor K_A, tooth contact.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from linkwright.kernel.page.table import (
    Row,
    Table,
    columns_csv,
    part_table,
    parts_of,
)
from linkwright.kernel.reader.numbers import number, quantity
from linkwright.torsion.limits.misfire import MisfireVerdict
from linkwright.torsion.model.shaft_limit import ShaftLimit, StressedSection
from linkwright.torsion.modes.scheme import Connection, Scheme
from linkwright.torsion.response.mesh_torque import MeshTorque
from linkwright.torsion.tables.limits import per_minute, rpm


def gear_tables(meshes: MeshTorque, place: int) -> Iterator[Table]:
    """Each stage in service, and where its vibratory torque is largest. `place`: of the service speed."""
    # A stage without vibratory torque is statically indeterminate.
    vibratory = meshes.vibratory
    worst = [int(np.nan_to_num(row, nan=-1.0).argmax()) for row in vibratory]
    known = [bool(np.isfinite(row).any()) for row in vibratory]
    at = per_minute()
    heads = ("stage", "", "mean", "vibratory", "K_A", "largest vibratory", f"at {at}", "largest K_A", "teeth")
    service = rpm(float(meshes.speeds[place]))
    yield part_table(
        "gears",
        f"Gear stages: torque at the first wheel, at {service} {at} and over the speeds",
        range(len(meshes.stages)),
        heads,
        lambda n: meshes.stages[n],
        "",
        lambda n: quantity(float(abs(meshes.mean[n, place])) if known[n] else None, "N m"),
        lambda n: quantity(float(vibratory[n, place]), "N m"),
        lambda n: _factor(float(meshes.application_factor[n, place])),
        lambda n: quantity(float(vibratory[n, worst[n]]), "N m"),
        lambda n: rpm(float(meshes.speeds[worst[n]]) if known[n] else None),
        lambda n: _factor(float(meshes.application_factor[n].max())),
        lambda n: _contact(meshes, n) if known[n] else "statically indeterminate",
    )


def misfire_gear_table(verdict: MisfireVerdict, service: float) -> Table:
    """Each stage with the cylinders whose misfire is worst for it. `service`: speed [rad/s]."""
    where = f"at {rpm(service)} {per_minute()} and over the speeds"
    return part_table(
        "misfire_gears",
        f"Gear stages with one cylinder misfiring, {where}",
        verdict.gears,
        ("stage", "", "vibratory", "K_A", "cylinder", "largest K_A", "at {rpm}", "cylinder"),
        *("stage", "", "vibratory [N m]", lambda gear: _factor(gear.application_factor), "cylinder"),
        *(lambda gear: _factor(gear.application_factor_max), "speed [rad/s]", "cylinder_max"),
    )


def _factor(value: float) -> str:
    """K_A; none where a stage carries no mean torque."""
    return f"{value:.3f}" if np.isfinite(value) else "–"


def _contact(meshes: MeshTorque, stage: int) -> str:
    if not meshes.toothed[stage]:
        return "belt"
    parted = meshes.separation[stage]
    if not parted:
        return "in contact"
    listed = ", ".join(f"{rpm(low)} to {rpm(high)}" for low, high in parted)
    return f"part at {listed} {per_minute()}"


def gear_csv(meshes: MeshTorque) -> str:
    """Torque and K_A of every stage over the speed."""
    columns = {"speed [rad/s]": meshes.speeds}
    for stage, name in enumerate(meshes.stages):
        columns |= {
            f"{name} mean [N m]": meshes.mean[stage],
            f"{name} vibratory [N m]": meshes.vibratory[stage],
            f"{name} minimum [N m]": meshes.least[stage],
            f"{name} maximum [N m]": meshes.greatest[stage],
            f"{name} K_A": meshes.application_factor[stage],
        }
    return columns_csv(columns)


_PREFIXES = ((1e6, "M"), (1e3, "k"))

_KINDS = {
    "shaft": "shaft",
    "coupling": "coupling",
    "mesh": "elastic gear stage",
    "gears": "gear stage",
    "bearing": "bearing on a carrier",
    "clutch": "clutch",
    "damper": "damper",
    "pendulum": "pendulum",
}


def system_tables(
    scheme: Scheme, sections: Mapping[str, tuple[StressedSection, ShaftLimit]]
) -> Iterator[Table]:
    """Masses, then what joins them. `sections`: where stresses count, by shaft."""
    heads = ("mass", "", "moment of inertia", "speed ratio n", "referred n² J")
    cells = (lambda disc: f"{disc.place[0] + 1} {disc.name}", "", "inertia", "speed", "inertia_referred")
    title = f"Masses, referred to {scheme.discs[0]}"
    yield part_table("masses", title, parts_of(scheme, "discs"), heads, *cells)
    if not scheme.connections:
        return
    place = {name: str(n + 1) for n, name in enumerate(scheme.discs)}
    joined: list[Row] = [_joined(one, place, sections) for one in scheme.connections]
    columns: Row = ("connection", "", "between", "kind", "stiffness", "referred n² k", "diameter", "W_p")
    yield Table("stiffnesses", "Stiffnesses, with the sections whose stress counts", columns, joined)


def _joined(
    one: Connection, place: Mapping[str, str], sections: Mapping[str, tuple[StressedSection, ShaftLimit]]
) -> Row:
    between = f"{place.get(one.first, one.first)} – {place.get(one.second, one.second)}"
    section = sections[one.name][0] if one.name in sections else None
    ratio = f"{number(one.ratio)} : 1" if one.kind == "gears" else None
    return (
        one.name,
        "",
        between,
        _KINDS[one.kind],
        ratio or _stiffness(one.stiffness),
        _stiffness(one.stiffness_referred),
        "–" if section is None else quantity(section.diameter, "m", usual="mm"),
        "–" if section is None else quantity(section.section_modulus, "m³", usual="cm³"),
    )


def _stiffness(value: float | None) -> str:
    """A stiffness with the prefix of its size, unless another unit is wanted."""
    prefix = next((prefix for size, prefix in _PREFIXES if value and value >= size), "")
    return quantity(value, "N m/rad", usual=f"{prefix}N m/rad")
