"""Tables of gear stages: torque, application factor K_A, tooth contact."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from linkwright.kernel.page.numbers import quantity
from linkwright.kernel.page.table import Row, Table, columns_csv
from linkwright.torsion.limits.misfire import MisfireVerdict
from linkwright.torsion.response.mesh_torque import MeshTorque
from linkwright.torsion.tables.limits import per_minute, rpm


def gear_tables(meshes: MeshTorque, place: int) -> Iterator[Table]:
    """Each stage in service, and where its vibratory torque is largest. `place`: of the service speed."""
    rows: list[Row] = []
    for stage, name in enumerate(meshes.stages):
        vibratory = meshes.vibratory[stage]
        if np.isnan(vibratory).all():
            rows.append((name, "", *("–",) * 6, "statically indeterminate"))
            continue
        worst = int(np.nan_to_num(vibratory, nan=-1.0).argmax())
        rows.append(
            (
                name,
                "",
                quantity(float(abs(meshes.mean[stage, place])), "N m", 4),
                quantity(float(vibratory[place]), "N m", 4),
                _factor(float(meshes.application_factor[stage, place])),
                quantity(float(vibratory[worst]), "N m", 4),
                rpm(float(meshes.speeds[worst])),
                _factor(float(meshes.application_factor[stage].max())),
                _contact(meshes, stage),
            )
        )
    heads = (
        "stage",
        "",
        "mean",
        "vibratory",
        "K_A",
        "largest vibratory",
        f"at {per_minute()}",
        "largest K_A",
        "teeth",
    )
    service = rpm(float(meshes.speeds[place]))
    title = f"Gear stages: torque at the first wheel, at {service} {per_minute()} and over the speeds"
    yield Table("gears", title, heads, rows)


def misfire_gear_table(verdict: MisfireVerdict, service: float) -> Table:
    """Each stage with the cylinders whose misfire is worst for it. `service`: speed [rad/s]."""
    rows: list[Row] = [
        (
            gear.stage,
            "",
            quantity(gear.vibratory, "N m", 4),
            _factor(gear.application_factor),
            gear.cylinder,
            _factor(gear.application_factor_max),
            rpm(gear.speed),
            gear.cylinder_max,
        )
        for gear in verdict.gears
    ]
    at = f"at {per_minute()}"
    heads = ("stage", "", "vibratory", "K_A", "cylinder", "largest K_A", at, "cylinder")
    where = f"at {rpm(service)} {per_minute()} and over the speeds"
    return Table("misfire_gears", f"Gear stages with one cylinder misfiring, {where}", heads, rows)


def _factor(value: float) -> str:
    """K_A; none where a stage carries no mean torque."""
    return f"{value:.3f}" if np.isfinite(value) else "–"


def _contact(meshes: MeshTorque, stage: int) -> str:
    """Whether teeth stay in contact."""
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
