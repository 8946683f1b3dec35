"""Laws of steady motion on hard machines, on random machines, and in batches.

`drive` in `tests/fuzz/drive_laws.py` integrates the motion of such machines by SciPy, too.
"""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import kinds
import numpy as np
import pytest
from found_machines import found_machine
from numpy.typing import NDArray
from random_drives import random_drive
from scipy.optimize import brentq
from sizes import cases, generator
from steady_laws import violations

import linkwright as lw
from linkwright import FindingError, Machine, read, steady_state
from linkwright.drive import SteadyState
from linkwright.machine import compile_machine

Floats = NDArray[np.float64]

HERE = Path(__file__).parent
MACHINES = sorted((HERE / "machines").glob("*.toml"))
SHIPPED = HERE.parent.parent / "machines"

# What results are to be right to, as a share of the peaks, at the default accuracy.
AGREES = 1e-6


@pytest.mark.parametrize("path", MACHINES, ids=lambda path: path.stem)
def test_hard_machines(path: Path) -> None:
    """Every law holds at the default accuracy, and a finer one moves no measure by more than was promised."""
    machine = read(path)
    steady = steady_state(machine)
    assert not violations(machine, steady, AGREES)
    finer = steady_state(machine, accuracy=1e-11)
    _agree(steady, finer, max(1e-8, 3 * steady.accuracy))


def random_machine(seed: int) -> Machine:
    return Machine.model_validate(random_drive(generator(seed)))


def _agree(a: SteadyState, b: SteadyState, accuracy: float) -> None:
    peak = max(abs(b.acceleration_min), abs(b.acceleration_max), 1e-4 * b.speed_max**2)
    torque = float(np.abs(b.torque_drive).max()) + float(np.abs(b.torque_load).max())
    assert a.speed == pytest.approx(b.speed, rel=accuracy)
    assert a.acceleration == pytest.approx(b.acceleration, abs=accuracy * peak)
    for name in ("speed_min", "speed_max", "period"):
        assert getattr(a, name) == pytest.approx(getattr(b, name), rel=accuracy), name
    for name in ("acceleration_min", "acceleration_max"):
        assert getattr(a, name) == pytest.approx(getattr(b, name), abs=accuracy * peak), name
    for name in ("energy_drive", "energy_load"):
        allowed = 10 * accuracy * 2 * np.pi * torque
        assert getattr(a, name) == pytest.approx(getattr(b, name), abs=allowed), name


def test_laws_hold_on_random_machines() -> None:
    """Laws on every random machine that runs; few do not, and those say where they come to rest."""
    runs = 0
    for seed in range(cases(50, 150)):
        machine = random_machine(seed)
        try:
            steady = steady_state(machine)
        except FindingError:
            continue
        assert not violations(machine, steady, max(AGREES, 3 * steady.accuracy)), seed
        assert 0 <= steady.multiplier < 1, seed
        runs += 1
    assert runs > cases(30, 90)


def _slider_crank(**motor: object) -> Machine:
    """A crank of 0.2 m on a rod of 0.8 m with a heavy dry load."""
    return Machine.model_validate(
        {
            "format": 1,
            "name": "slider-crank",
            "mechanism": {
                "cranks": {"A": {"radius": 0.2}},
                "sliders": {"S": {"crank": "A", "rod": 0.8}},
            },
            "bodies": {"A": {"mass": 0.1}, "S": {"mass": 10.0}},
            "loads": {"rolling": {"kind": "dry", "on": "S", "force": 3562.0}},
            "drive": {"motor": motor, "gearbox": {"ratio": 9.8, "efficiency": 0.9}},
        }
    )


def test_a_motor_whose_inertia_was_left_out() -> None:
    """A crank of 0.1 kg alone: the speed is that of the motor's curve under the load, at every angle."""
    machine = _slider_crank(
        kind="induction",
        speed_synchronous=1000 * np.pi / 30,
        speed_rated=970 * np.pi / 30,
        power_rated=11e3,
        torque_breakdown=2 * 11e3 / (970 * np.pi / 30),
    )
    steady = steady_state(machine)
    assert steady.speed_max == pytest.approx(10.686, abs=5e-4)
    assert steady.unevenness == pytest.approx(0.0230, abs=5e-4)
    # Without inertia the load torque, F |s'|/(i η) at its peak, decides the slip.
    compiled = compile_machine(machine)
    torque = float(steady.torque_load.max()) / (9.8 * 0.9)
    slow = brentq(lambda w: compiled.motor_torques(w).motor[0] - torque, 10.0, 10.68)
    assert steady.speed_min == pytest.approx(slow, rel=1e-3)
    assert not violations(machine, steady, AGREES)


@pytest.mark.parametrize("motor", ["4A250M6U3", "4A250S6U3"])
def test_large_catalogue_motors_on_a_small_machine(motor: str) -> None:
    """All measures at the default accuracy are those at the finest."""
    sets = (f"drive.motor.catalogue={motor}", "drive.motor.inertia=0.3")
    machine = read(SHIPPED / "roller_one_cart.toml", sets)
    steady, finer = steady_state(machine), steady_state(machine, accuracy=1e-12)
    for name in ("unevenness", "dynamism", "motion_coefficient", "torque_motor_rms", "period"):
        assert getattr(steady, name) == pytest.approx(getattr(finer, name), rel=1e-7), name
    assert not violations(machine, steady, AGREES)


def test_of_several_motions_the_stable_one_is_found_at_every_accuracy() -> None:
    """Speeds of 7.39 to 86.9 rad/s are stable; there is an unstable motion below."""
    machine = read(HERE / "machines" / "two_motions.toml")
    for accuracy in (1e-4, 1e-6, 1e-9, 1e-10, 1e-12):
        steady = steady_state(machine, accuracy=accuracy)
        assert steady.speed_min == pytest.approx(7.39, abs=0.01), accuracy
        assert steady.speed_max == pytest.approx(86.9, abs=0.05), accuracy
        assert steady.is_stable, accuracy
        assert [other.is_stable for other in steady.others] == [False], accuracy


@pytest.mark.parametrize("name", ["three_motions", "narrow_window", "two_motions"])
@pytest.mark.parametrize("accuracy", [1e-6, 1e-9, 1e-11])
def test_stable_and_unstable_motions_take_turns(name: str, accuracy: float) -> None:
    """The return map increases: between two stable motions lies an unstable one that parts them."""
    machine = read(HERE / "machines" / f"{name}.toml")
    steady = steady_state(machine, accuracy=accuracy)
    assert steady.others
    motions = [steady, *steady.others]
    assert [each.is_stable for each in motions] == [n % 2 == 0 for n in range(len(motions))]
    for faster, slower in pairwise(motions):
        assert faster.speed_min > slower.speed_min
        assert faster.speed_max > slower.speed_max
        assert faster.period < slower.period


@pytest.mark.parametrize("name", ["three_motions", "narrow_window"])
def test_starts_part_at_the_unstable_motion(name: str) -> None:
    """Motion in time from above an unstable motion settles to the next faster one, from below it does not."""
    machine = read(HERE / "machines" / f"{name}.toml")
    steady = steady_state(machine)
    parting = steady.others[0]
    # The phase of the crank is that of the analysis, so whole revolutions end at φ = 0.
    up = lw.transient(machine, speed=1.01 * parting.speed_max, turns=300.0, accuracy=1e-9)
    assert up.speed[-1] == pytest.approx(steady.speed[0], rel=1e-6)
    down = lw.transient(machine, speed=0.99 * parting.speed_min, turns=300.0, accuracy=1e-9)
    assert down.speed[-1] < parting.speed_min


def test_every_other_motion_is_a_warning_and_is_written_out() -> None:
    """Text and JSON tell the stable and the unstable motion."""
    machine = read(HERE / "machines" / "three_motions.toml")
    study = lw.study(machine)
    assert study.steady_state is not None
    told = " ".join(study.warnings)
    for other in study.steady_state.others:
        assert f"from {other.speed_min:.4g} to {other.speed_max:.4g} rad/s" in told
    written = study.steady_state.to_dict()["others"]
    assert [row["speed_max"] for row in written] == [each.speed_max for each in study.steady_state.others]


@pytest.mark.parametrize("free_length", [0.19279829159075335, 0.1994])
def test_a_row_that_does_not_converge_is_refused(free_length: float) -> None:
    """Newton in lanes ends at 90 to 913 rad/s with a motor of 13 rad/s: no step in halves bears that out."""
    machine = found_machine("stiff_spring")
    rows = lw.steady_states(machine, {"loads.spring.free_length": np.array([free_length])})
    assert rows.status[0] != 0
    with pytest.raises(FindingError):
        steady_state(lw.replace(machine, {"loads.spring.free_length": free_length}))


@pytest.mark.parametrize("half_width", np.radians([3.0, 1.0, 0.3, 0.05]))
@pytest.mark.parametrize("phase", np.linspace(0.0, 0.4, 7))
def test_a_switch_that_closes_and_opens_within_degrees_is_seen(half_width: float, phase: float) -> None:
    """A force that acts within some degrees of the outer dead centre has its kinks there."""
    r, rod = 0.2, 0.8
    reach = r * np.cos(half_width) + np.sqrt(rod**2 - (r * np.sin(half_width)) ** 2)
    machine = Machine.model_validate(
        {
            "format": 1,
            "name": "latch",
            "mechanism": {
                "cranks": {"A": {"radius": r, "phase": phase}},
                "sliders": {"S": {"crank": "A", "rod": rod}},
            },
            "bodies": {"A": {"inertia": 2.0}, "S": {"mass": 10.0}},
            "loads": {"latch": {"kind": "formula", "on": "S", "force": f"-5000*step(s - {float(reach)!r})"}},
            "drive": {"motor": {"kind": "dc", "speed_no_load": 20.0, "torque_stall": 400.0}},
        }
    )
    kinks = compile_machine(machine).kinks()
    for side in (-half_width, half_width):
        at = (side - phase) % (2 * np.pi)
        assert np.abs(kinks - at).min() < 1e-9
    assert not violations(machine, steady_state(machine), AGREES)


@pytest.mark.parametrize("stiffness", [1e5, 1e6])
def test_stiff_springs_at_fine_accuracy(stiffness: float) -> None:
    """No point of the curves lies outside the extremes, and the laws hold."""
    machine = read(SHIPPED / "roller_one_cart.toml")
    tables = machine.model_dump(by_alias=True, exclude_unset=True)
    cart = next(iter(tables["mechanism"]["sliders"]))
    tables["mechanism"].setdefault("points", {})["F"] = {"x": 0.7, "y": 0.9}
    tables["loads"]["spring"] = {
        "kind": "spring",
        "between": [cart, "F"],
        "stiffness": stiffness,
        "free_length": 0.9,
    }
    tables["drive"]["flywheel"] = {"inertia": 2000.0}
    machine = Machine.model_validate(tables)
    steady = steady_state(machine, accuracy=1e-8)
    assert not violations(machine, steady, AGREES)


def test_an_idling_drive_runs() -> None:
    """A motor, a gearbox that tells the directions apart, a crank and no load: the no-load speed, evenly."""
    machine = lw.loads(
        """
        format = 1
        name = "idle"
        [drive.motor]
        kind = "dc"
        speed_no_load = "1000 rpm"
        torque_stall = "100 N m"
        inertia = 0.1
        [drive.gearbox]
        ratio = 10
        efficiency = 0.9
        [mechanism.cranks.A]
        radius = 0.1
        """
    )
    steady = steady_state(machine)
    assert steady.speed_mean_time == pytest.approx(1000 * 2 * np.pi / 60 / 10, rel=1e-9)
    assert steady.unevenness < 1e-9


def test_an_eccentric_crank_that_all_but_stops_runs() -> None:
    """Gravity and dry friction on 13.38 kg: a run-up settles to the same speeds."""
    tables = {
        "format": 1,
        "name": "eccentric crank",
        "mechanism": {"cranks": {"A": {"radius": 0.2}}},
        "bodies": {"A": {"mass": 13.38, "along": 0.1, "inertia": 0.0}},
        "loads": {"gravity": {"kind": "gravity"}, "rub": {"kind": "dry", "on": "A", "torque": 2.0}},
        "drive": {"motor": {"kind": "dc", "speed_no_load": 1.5, "torque_stall": 24.0}},
    }
    machine = Machine.model_validate(tables)
    steady = steady_state(machine)
    assert not violations(machine, steady, AGREES)
    path = lw.transient(machine, duration=60.0, accuracy=1e-9)
    last = path.crank_angle > path.crank_angle[-1] - 2 * np.pi
    assert path.speed[last].min() == pytest.approx(steady.speed_min, rel=1e-3)
    assert path.speed[last].max() == pytest.approx(steady.speed_max, rel=1e-3)


@pytest.mark.parametrize("machine", [*MACHINES[::4], *range(300, 310)], ids=str)
def test_rows_of_a_batch_are_the_single_answer(machine: Path | int) -> None:
    """A row is the single answer to 1e-7, or has a status where the single analysis refuses."""
    base = random_machine(machine) if isinstance(machine, int) else read(machine)
    assert base.drive is not None
    ratios = base.drive.gearbox.ratio * np.array([0.9, 1.0, 1.1])
    rows = lw.steady_states(base, {"drive.gearbox.ratio": ratios})
    for row, ratio in enumerate(ratios):
        try:
            steady = steady_state(lw.replace(base, {"drive.gearbox.ratio": float(ratio)}), accuracy=1e-10)
        except FindingError:
            assert rows.status[row] != 0, row
            continue
        assert rows.status[row] == 0, row
        allowed = max(3e-7, 3 * steady.accuracy)
        peak = max(abs(steady.acceleration_min), abs(steady.acceleration_max), 1e-4 * steady.speed_max**2)
        for name in ("speed_min", "speed_max", "period"):
            assert getattr(rows, name)[row] == pytest.approx(getattr(steady, name), rel=allowed), name
        for name in ("acceleration_min", "acceleration_max"):
            assert getattr(rows, name)[row] == pytest.approx(getattr(steady, name), abs=allowed * peak), name


@pytest.mark.parametrize(
    "seed",
    [1341495221215199450, 2238092810187960231, 4104776332472527687, 4285566245240791735, 1251784259052218246],
)
def test_rows_of_a_batch_are_the_machines_alone(seed: int) -> None:
    """Errors lie in steps that look no coarser than others: dead centres under tanh(20 v), narrow dips."""
    kinds.run("batch", seed)


@pytest.mark.parametrize("seed", [1130947188539268203, 2669891020757566098, 2862354225198245094])
def test_laws_know_what_rounding_is(seed: int) -> None:
    """Two drives that idle, and one so steep that SciPy has to march more finely than it does as a rule."""
    kinds.run("drive", seed)
