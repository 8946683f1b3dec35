"""A reciprocating compressor: driven, with a driver that balances the work of its diagram."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import linkwright as lw
from linkwright import MachineError, torsion_study, torsion_transient
from linkwright.machine import machine_parts
from linkwright.torsion.tables.torsion import study_tables

BORE, R, L, DEAD, N = 0.2, 0.06, 0.24, 0.1, 1.3
LOW, HIGH = 1e5, 4e5


def diagram() -> tuple[list[float], list[float]]:
    """Angles and pressures of an ideal compressor: re-expansion, suction, compression, delivery."""
    phi = np.radians(np.arange(0.0, 360.0, 2.0))
    stroke = 1 - np.cos(phi) + (1 - np.sqrt(1 - (R / L * np.sin(phi)) ** 2)) * L / R
    volume = DEAD + stroke / 2
    out = np.maximum(LOW, HIGH * (DEAD / volume) ** N)
    back = np.minimum(HIGH, LOW * ((1 + DEAD) / volume) ** N)
    pressure = np.where(phi < np.pi, out, back)
    return phi.tolist(), pressure.tolist()


def machine(**train: Any) -> lw.Machine:
    angle, pressure = diagram()
    engine = {
        "machine": "compressor",
        "strokes": 2,
        "bore": BORE,
        "crank_radius": R,
        "throws": [0.0, math.pi],
        "firing_order": [1, 2],
        "piston_mass": 8.0,
        "throw_inertia": 0.2,
        "stiffness": 2e6,
        "loss_factor": 0.01,
        "rod": {"length": L, "mass": 6.0, "centre": 0.08, "inertia": 0.05},
        "gas": {
            "kind": "table",
            "compression_ratio": 1 + 1 / DEAD,
            "polytropic_exponent": N,
            "combustion_start": math.radians(-55.0),
            "angle": angle,
            "pressure": pressure,
        },
    }
    entries = {
        "engine": engine,
        "discs": {"flywheel": {"inertia": 8.0}, "motor": {"inertia": 1.0}},
        "shafts": {"crank": {"between": ["throw_2", "flywheel"], "stiffness": 3e6, "loss_factor": 0.01}},
        "couplings": {"rubber": {"between": ["flywheel", "motor"], "stiffness": 5e4, "loss_factor": 0.1}},
        "run": {"speed_min": 60.0, "speed_max": 80.0, "points": 5},
    }
    return lw.Machine.model_validate({"format": 1, "name": "compressor", "train": {**entries, **train}})


def test_the_driver_balances_the_work_of_the_diagram() -> None:
    """The mean torque of the driver is the work of both cylinders over a revolution, with no rest."""
    study = torsion_study(machine(drivers={"motor": {"on": "motor"}}))
    assert study.forced is not None
    assert study.excited is not None
    mean = dict(zip(study.forced.shafts, study.forced.mean_torques[:, 0].tolist(), strict=True))
    phi, pressure = diagram()
    angle = np.linspace(0.0, 2 * np.pi, 36001)
    beta = R / L * np.sin(angle)
    lever = R * (np.sin(angle) + np.cos(angle) * beta / np.sqrt(1 - beta**2))
    p = np.interp(angle, [*phi, 2 * np.pi], [*pressure, pressure[0]])
    work = -math.pi / 4 * BORE**2 * float(((p * lever)[1:] + (p * lever)[:-1]).sum()) * np.pi / 36000
    assert mean["rubber"] == pytest.approx(-2 * work / (2 * np.pi), rel=2e-3)
    assert mean["crank"] == pytest.approx(mean["rubber"], rel=1e-9)
    assert np.abs(study.excited.torques.surplus).max() < 1e-9 * abs(mean["rubber"])
    assert not any("engine" in warning for warning in study.warnings)


def test_without_drivers_the_first_disc_drives() -> None:
    """The first disc of the file drives it, and `driver` names another one."""
    forced = torsion_study(machine()).forced
    other = torsion_study(machine(driver="motor")).forced
    assert forced is not None
    assert other is not None
    rubber = forced.shafts.index("rubber")
    assert forced.mean_torques[rubber] == pytest.approx(0.0, abs=1e-6)
    assert np.abs(other.mean_torques[rubber]).min() > 50.0


def test_it_is_called_a_compressor() -> None:
    """Its data stand under its name; an engine beside drivers with shares is refused as before."""
    assert any(part.group == "Compressor" or part.name == "Compressor" for part in machine_parts(machine()))
    tables = {table.title: [row[0] for row in table.rows] for table in study_tables(torsion_study(machine()))}
    (rows,) = (rows for title, rows in tables.items() if title.startswith("Compressor, gas at"))
    assert {"working order", "working intervals"} <= {*rows}
    assert not any("firing" in row for row in rows)
    entries = machine().model_dump(exclude_unset=True)["train"]
    engine = {**entries["engine"], "machine": "engine"}
    with pytest.raises(MachineError, match="the torque that it gives beside the engine"):
        machine(engine=engine, drivers={"motor": {"on": "motor"}})


def test_in_time_the_driver_holds_the_speed() -> None:
    """A manoeuvre starts with the torque of the driver that balances the compressor."""
    moved = torsion_transient(
        machine(
            drivers={"motor": {"on": "motor"}}, transient={"duration": 0.5, "speed": 70.0, "gas_speed": 70.0}
        )
    )
    assert moved.speed[-1].mean() == pytest.approx(70.0, rel=0.02)
    assert "motor is driven by a constant" in moved.balance
