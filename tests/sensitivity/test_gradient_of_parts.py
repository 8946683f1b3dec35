"""Derivatives of pumping units and of loaded cams against extrapolated differences of their analyses."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from differences import sixth_order

import linkwright as lw
from linkwright.cam import cam_force
from linkwright.machine import exchanged
from linkwright.sensitivity.sources import source

# A roller in line with the cam, pressed by a spring or held in a groove, on which inertia prevails.
CAM = """
format = 1
name = "Follower"
[drive]
speed = {speed}
[mechanism.points]
G = {{ x = 0.25, y = 0 }}
[mechanism.cams.F]
base_radius = 0.03
roller_radius = 0.008
width = 0.012
closure = "{closure}"
sections = [
  {{ angle = "100 deg", lift = "9 mm", law = "cycloidal" }},
  {{ angle = "80 deg", lift = "-9 mm", law = "cycloidal" }},
  {{ angle = "180 deg" }},
]
[bodies]
F = {{ mass = 0.6 }}
[loads]
spring = {{ kind = "spring", between = ["F", "G"], stiffness = 4000, free_length = 0.222 }}
"""

Measure = Callable[[lw.Machine], list[float]]


def differences(machine: lw.Machine, entry: str, measure: Measure, step: float = 1e-3) -> np.ndarray:
    """Central differences over h, 2h and 4h, extrapolated to sixth order."""
    value = float(lw.get(machine, entry))
    h = step * (abs(value) or 1.0)
    return sixth_order(lambda by: np.array(measure(exchanged(machine, {entry: value + by}))), h)


def errors(
    machine: lw.Machine, analysis: str, entries: list[str], measure: Callable[..., list[float]]
) -> float:
    """The largest error of a derivative, as a share of the largest change of its response."""
    derived = source(machine, analysis, entries)
    names = list(derived.tangents)
    sizes = np.array([abs(float(lw.get(machine, entry))) or 1.0 for entry in derived.variables])
    exact = np.array([derived.tangents[name].d for name in names]) * sizes
    rough = [differences(machine, entry, lambda made: measure(made, names)) for entry in derived.variables]
    scale = np.nanmax(np.abs(exact), axis=1, keepdims=True)
    off: np.ndarray = np.abs(np.array(rough).T * sizes - exact) / scale
    assert np.isfinite(off).sum() > 0.5 * off.size
    return float(np.nanmax(off))


def scalars(analyse: Callable[[lw.Machine], object]) -> Callable[[lw.Machine, list[str]], list[float]]:
    def measure(machine: lw.Machine, names: list[str]) -> list[float]:
        found = analyse(machine)
        return [getattr(found, name.rpartition(".")[2]) for name in names]

    return measure


# Conventional, by API's example; Mark II and air-balanced with sizes of their kind.
UNITS = {
    "conventional": {"A": 1.83, "C": 1.63, "I": 1.63, "P": 1.89, "H": 2.95, "G": 1.04, "R": 0.6},
    "mark_ii": {"A": 6.1, "C": 4.4, "I": 3.6, "P": 3.0, "H": 5.6, "G": 1.6, "R": 1.0},
    "air_balanced": {"A": 6.1, "C": 4.4, "I": 3.6, "P": 3.0, "H": 5.6, "G": 1.6, "R": 0.9},
}


@pytest.mark.parametrize("geometry", UNITS)
def test_pumping_units(geometry: str) -> None:
    sizes = "\n".join(f"{letter} = {value}" for letter, value in UNITS[geometry].items())
    unit = f'[pumping_unit]\ngeometry = "{geometry}"\n{sizes}\n'
    machine = lw.loads(f'format = 1\nname = "Unit"\n[drive]\nspeed = "10 rpm"\n{unit}')
    entries = [name for name in lw.addresses(machine) if name.startswith(("pumping_unit.", "drive.speed"))]
    # Rounding over the step, and its sixth power.
    assert errors(machine, "pumping_unit", entries, scalars(lw.pumping_unit)) < 1e-9


@pytest.mark.parametrize(("closure", "speed"), [("spring", 25.0), ("groove", 80.0)])
def test_loaded_cams(closure: str, speed: float) -> None:
    machine = lw.loads(CAM.format(closure=closure, speed=speed))
    entries = [name for name in lw.addresses(machine) if ".sections." not in name]
    # The angle of an extreme is known to 1e-8 rad.
    assert errors(machine, "cam_force", entries, scalars(cam_force)) < 1e-7


def test_entries_that_move_a_joint_under_the_extreme_have_none() -> None:
    machine = lw.loads(CAM.format(closure="spring", speed=25.0))
    found = lw.gradient(machine, ["cam_force.F.force_max"])
    assert "mechanism.cams.F.phase" in found.ties["cam_force.F.force_max"]
    assert np.isnan(found.of("cam_force.F.force_max")["mechanism.cams.F.phase"])
    # Lifts do not move it.
    lifts = [f"mechanism.cams.F.sections.{i}.lift" for i in (0, 1)]
    slopes = lw.gradient(machine, ["cam_force.F.force_max"], lifts).derivatives[0]
    exact = slopes @ [1.0, -1.0]
    h, here = 1e-6, [lw.get(machine, lift) for lift in lifts]
    up, down = (
        cam_force(lw.replace(machine, {lifts[0]: here[0] + by, lifts[1]: here[1] - by}), "F").force_max
        for by in (h, -h)
    )
    assert (up - down) / (2 * h) == pytest.approx(exact, rel=1e-7)


def test_forces_of_a_follower_that_leaves_have_derivatives() -> None:
    """The message about it is worked out from arrays with derivatives, too."""
    machine = lw.loads(CAM.format(closure="spring", speed=80.0))
    found = lw.gradient(machine, ["cam_force.F.force_min"], ["bodies.F.mass"])
    assert found.values[0] < 0
    assert np.isfinite(found.derivatives).all()


LOAD = "position = [0, 0.3, 1]\nup = [30e3, 41e3, 37e3]\ndown = [30e3, 22e3, 18e3]\nefficiency = 0.95"


def geared(counterbalance: str) -> lw.Machine:
    sizes = "\n".join(f"{letter} = {value}" for letter, value in UNITS["conventional"].items())
    unit = f'[pumping_unit]\ngeometry = "conventional"\n{sizes}\n[pumping_unit.load]\n{LOAD}\n'
    return lw.loads(f'format = 1\nname = "Unit"\n[drive]\nspeed = "10 rpm"\n{unit}{counterbalance}\n')


def torques(machine: lw.Machine, names: list[str]) -> list[float]:
    gear = lw.pumping_unit(machine, n=8).gear
    return [getattr(gear, name.rpartition(".")[2]) for name in names]


# Peaks at a corner of the table over the position; over the angle, with a balance that the gears change by.
GEARS = {
    "conventional": f"{LOAD}\ncounterbalance = 20e3",
    "air_balanced": "angle = [0, 0.9, 2.1, 3.3, 4.4, 5.5]\nforce = [20e3, 41e3, 37e3, 30e3, 15e3, 18e3]\n"
    "efficiency = 0.93",
}
ENTRIES = ("R", "load.efficiency", "load.position.1", "load.up.1", "load.angle.1", "load.force.1")


@pytest.mark.parametrize("geometry", GEARS)
def test_gear_of_a_pumping_unit(geometry: str) -> None:
    """Peaks, means and work, also where a peak is reached at a corner of the table that moves."""
    sizes = "\n".join(f"{letter} = {value}" for letter, value in UNITS[geometry].items())
    load = f'designation = "C-114D-133-54"\n[pumping_unit.load]\n{GEARS[geometry]}'
    machine = lw.loads(
        f'format = 1\nname = "Unit"\n[pumping_unit]\ngeometry = "{geometry}"\n{sizes}\n{load}\n'
    )
    known = lw.addresses(machine)
    entries = [name for entry in ENTRIES if (name := f"pumping_unit.{entry}") in known]
    derived = source(machine, "pumping_unit", entries)
    names = [name for name in derived.tangents if ".gear." in name]
    assert {name.rpartition(".")[2] for name in names} > {
        "torque_net_mean",
        "torque_net_rms",
        "work",
        "gear_load",
    }
    assert not derived.ties
    assert set(derived.missing) == {f"pumping_unit.gear.{name}_rated" for name in ("torque", "load")}
    exact = np.array([derived.tangents[name].d for name in names]).T
    # Over so short a step differences are good to 1e-9 of a response.
    rough = [differences(machine, entry, lambda made: torques(made, names), 1e-5) for entry in entries]
    sizes_of = np.array([abs(float(lw.get(machine, entry))) for entry in entries])[:, None]
    scale = np.abs(exact * sizes_of).max(axis=0) + np.array(
        [abs(derived.tangents[name].value) for name in names]
    )
    assert np.abs((np.array(rough) - exact) * sizes_of / scale).max() < 1e-8


def test_counterbalance_of_equal_peaks() -> None:
    """It moves so that both peaks stay equal."""
    machine = geared("")
    derived = source(machine, "pumping_unit", ["pumping_unit.R"])
    names = [f"pumping_unit.gear.{name}" for name in ("torque_net_up", "torque_net_down", "counterbalance")]
    up, down, balance = (float(derived.tangents[name].d[0]) for name in names)
    assert up == pytest.approx(down, rel=1e-9)
    value, h = UNITS["conventional"]["R"], 1e-3
    near = [torques(lw.replace(machine, {"pumping_unit.R": value + way * h}), names) for way in (-1, 1)]
    # Central differences miss by h² of a third derivative.
    rough = (np.array(near[1]) - near[0]) / (2 * h)
    np.testing.assert_allclose([up, down, balance], rough, rtol=1e-4)


def _limited(jerk: str) -> str:
    limits = f'{{ kind = "limited", velocity_max = 0.02, acceleration_max = 0.2{jerk} }}'
    return CAM.format(closure="groove", speed=25.0).replace('"cycloidal"', limits, 1)


@pytest.mark.parametrize("analysis", ["cam_force", "forces"])
def test_forces_follow_the_limits_of_a_law(analysis: str) -> None:
    """One that the law does not reach changes nothing; one that it reaches moves jumps of the force."""
    limit = "mechanism.cams.F.sections.0.law"
    far = lw.gradient(lw.loads(_limited(", jerk_max = 1")), [analysis])
    assert not far.refused
    slopes = far.derivatives[:, far.variables.index(f"{limit}.velocity_max")]
    np.testing.assert_array_equal(slopes, 0.0)
    near = lw.gradient(lw.loads(_limited("")), [analysis])
    assert any(f"{limit}.acceleration_max" in tie for tie in near.ties.values()) == (analysis == "cam_force")


def test_a_law_without_a_limit_of_the_jerk_has_derivatives() -> None:
    """An infinite limit times no derivative is none."""
    found = lw.gradient(lw.loads(_limited("")), ["cam"])
    limit = found.variables.index("mechanism.cams.F.sections.0.law.acceleration_max")
    assert np.isfinite(found.derivatives[:, limit]).any()
