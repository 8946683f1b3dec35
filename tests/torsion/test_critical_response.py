"""Where an order peaks: the maximum of its forced response in the shaft, not the peak of the mode alone.

The response is that of matrices put together here and solved by NumPy, at speeds close to each other.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.optimize import minimize_scalar
from scipy.sparse import csr_array
from scipy.sparse.csgraph import maximum_bipartite_matching
from sizes import cases, generator

import linkwright as lw
from linkwright.torsion import Survey, excited_train, study_tables, survey
from linkwright.torsion.limits.critical_response import CriticalResponse, _owned, critical_responses
from linkwright.torsion.tables.limits import critical_table

EXAMPLES = Path(__file__).parents[2] / "examples"
RPM = np.pi / 30


def responses(machine: lw.Machine) -> tuple[Survey, tuple[CriticalResponse, ...]]:
    """What the shafts carry at the critical speeds, without the rest of a study."""
    seen = survey(machine)
    ends = seen.at.torques.speeds.min(), seen.at.torques.speeds.max()
    return seen, critical_responses(seen, lw.campbell(machine, speed_range=ends))


def torques(machine: lw.Machine, order: float, shaft: str, speeds: np.ndarray) -> np.ndarray:
    """Torque of one order in a shaft: a dynamic stiffness matrix at each speed, solved by NumPy."""
    at = excited_train(machine, speeds)
    same = np.abs(at.torques.orders - order) < 1e-9 * order
    loads = at.torques.harmonics[same].sum(axis=0).T
    referred, k, ground = at.referred, at.operating.stiffness, at.operating.disc_damping
    assert np.all(referred.speed == 1)
    s = referred.shafts.index(shaft)
    first, second = referred.ends[s]
    torque = np.empty(len(speeds))
    for n, speed in enumerate(speeds):
        omega = order * speed
        springs = k[:, n] * (1 + 1j * referred.loss_factor) + 1j * omega * referred.damping
        matrix = np.diag(-(omega**2) * referred.inertia + 1j * omega * ground[:, n])
        for (a, b), spring in zip(referred.ends, springs, strict=True):
            matrix[a, a] += spring
            matrix[b, b] += spring
            matrix[a, b] -= spring
            matrix[b, a] -= spring
        q = np.linalg.solve(matrix, loads[n])
        torque[n] = abs(springs[s] * (q[first] - q[second]))
    return torque


def test_propeller_shaft_line() -> None:
    """Matrices from the numbers of the file; the mode alone would peak at 78.3 rpm, with 71.9 MPa."""
    machine = lw.read(EXAMPLES / "propeller_shaft_line" / "machine.toml")
    seen, found = responses(machine)
    (one,) = [one for one in found if one.order == 5]
    best = minimize_scalar(
        lambda x: -float(torques(machine, 5.0, "line", np.array([x * RPM]))[0]),
        bounds=(74, 79),
        options={"xatol": 1e-9},
    )
    modulus = math.pi * 0.43**3 / 16
    assert one.shaft == "line"
    assert one.is_peak
    assert one.speed / RPM == pytest.approx(best.x, abs=2e-5)
    assert one.speed / RPM == pytest.approx(76.7457, abs=1e-4)
    assert one.single == pytest.approx(-best.fun / modulus, rel=1e-10)
    assert one.total == pytest.approx(85.185e6, rel=1e-4)
    assert one.critical_speed / RPM == pytest.approx(78.526, abs=1e-3)
    alone = lw.campbell(machine, [5.0]).critical[0].peak_speed
    assert alone is not None
    assert alone / RPM == pytest.approx(78.299, abs=1e-3)
    assert seen.criteria


def test_v8() -> None:
    """Order 8 peaks at 1861 rpm; the undamped mode meets it at 1924 rpm, and alone would peak at 1906 rpm."""
    machine = lw.read(EXAMPLES / "v8_survey" / "machine.toml")
    _, found = responses(machine)
    (one,) = [one for one in found if one.order == 8]
    speeds = np.linspace(1840, 1930, 181) * RPM
    torque = torques(machine, 8.0, one.shaft, speeds)
    place = int(np.argmax(torque))
    assert one.speed == pytest.approx(speeds[place], abs=0.5 * RPM)
    # Torques between the speeds of the run are cubics.
    stress = lw.shaft_stress(machine)
    modulus = float(stress.section_modulus[stress.shafts.index(one.shaft)])
    assert one.single == pytest.approx(torque[place] / modulus, rel=1e-3)
    assert one.speed / RPM == pytest.approx(1861, abs=1)


def chain(seed: int) -> lw.Machine:
    """A random train in a row: strong dampers, close modes, torques that grow with the speed."""
    random = generator(seed)
    n = int(random.integers(3, 6))
    inertia = random.uniform(0.5, 2.0, n)
    if seed % 2:
        # Two nearly equal ends about a heavy middle have close modes.
        inertia[n // 2] = 40.0
    discs: dict[str, Any] = {f"d{j}": {"inertia": J} for j, J in enumerate(inertia.tolist())}
    strength = float(10 ** random.uniform(-1, 1.3))
    shafts = {
        f"s{j}": {"between": [f"d{j}", f"d{j + 1}"], "stiffness": k, "damping": c}
        for j, (k, c) in enumerate(
            zip(
                random.uniform(1e4, 4e4, n - 1).tolist(),
                random.uniform(0.2, 2.0, n - 1) * strength,
                strict=True,
            )
        )
    }
    ring = {
        "on": "d0",
        "kind": "viscous",
        "ring_inertia": 0.6,
        "damping": float(10 ** random.uniform(1, 3.5)),
    }
    waves = [{"order": float(order), "torque": 50.0, "phase": float(order)} for order in (1.5, 2.0, 4.0)]
    pulse = {"on": f"d{n - 1}", "harmonics": waves, "speed": 50.0, "exponent": float(seed % 3)}
    train = {
        "discs": discs,
        "shafts": shafts,
        "dampers": {"ring": ring},
        "excitations": {"pulse": pulse},
        "run": {"speed_min": 15.0, "speed_max": 120.0, "points": 40},
    }
    return lw.Machine.model_validate({"format": 1, "name": "A chain", "train": train})


def maxima(
    machine: lw.Machine, order: float, shaft: str, low: float, high: float
) -> list[tuple[float, float]]:
    speeds = np.linspace(low, high, 6001)
    torque = torques(machine, order, shaft, speeds)
    inside = 1 + np.flatnonzero((torque[1:-1] > torque[:-2]) & (torque[1:-1] >= torque[2:]))
    listed = []
    for n in inside.tolist():
        best = minimize_scalar(
            lambda x: -float(torques(machine, order, shaft, np.array([x]))[0]),
            bounds=(speeds[n - 1], speeds[n + 1]),
            options={"xatol": 1e-10},
        )
        listed.append((float(best.x), -float(best.fun)))
    return listed


def is_spare(machine: lw.Machine, one: CriticalResponse, peaks: list[float]) -> bool:
    """Whether as many critical speeds have a peak without this one as with it, by SciPy's matching."""
    critical = [each.speed for each in lw.campbell(machine, [one.order], (1.0, 1000.0)).critical]
    ends = [0.0, *critical, math.inf]
    fits = [[ends[n] < peak < ends[n + 2] for peak in peaks] for n in range(len(critical))]
    without = [
        row for row, speed in zip(fits, critical, strict=True) if abs(speed - one.critical_speed) > 1e-9
    ]
    matched = [
        int((maximum_bipartite_matching(csr_array(np.array(rows, int).reshape(len(rows), -1))) >= 0).sum())
        for rows in (fits, without)
    ]
    return matched[0] == matched[1]


@pytest.mark.parametrize("seed", range(cases(4, 12)))
def test_random_trains(seed: int) -> None:
    """Each peak is a maximum of the response and counts once; a critical speed without one has none left."""
    machine = chain(seed)
    _, found = responses(machine)
    assert found
    for order in {one.order for one in found}:
        mine = [one for one in found if one.order == order]
        for shaft in {one.shaft for one in mine}:
            real = maxima(machine, order, shaft, 15.0, 120.0)
            told = [one for one in mine if one.shaft == shaft and one.is_peak]
            assert len({one.speed for one in told}) == len(told)
            for one in told:
                speed, height = min(real, key=lambda peak: abs(peak[0] - one.speed))
                assert one.speed == pytest.approx(speed, rel=1e-6)
                assert one.single == pytest.approx(height, rel=1e-9)
                # It lies between the critical speeds next to its own.
                others = [other.critical_speed for other in mine if other is not one]
                low = max((x for x in others if x < one.critical_speed), default=0.0)
                high = min((x for x in others if x > one.critical_speed), default=math.inf)
                assert low < one.speed < high
        for one in mine:
            if not one.is_peak:
                assert one.speed == one.critical_speed
                there = torques(machine, order, one.shaft, np.array([one.speed]))[0]
                assert one.single == pytest.approx(there, rel=1e-9)
                real = maxima(machine, order, one.shaft, 15.0, 120.0)
                assert is_spare(machine, one, [speed for speed, _ in real])


def two_discs(damping: float = 0.0, speed_min: float = 20.0) -> lw.Machine:
    """Two discs on a shaft, an order 2 that meets their mode at ω/2 = 72.5 rad/s."""
    shaft = {"between": ["a", "b"], "stiffness": 3e4, "damping": damping}
    pulse = {"on": "a", "harmonics": [{"order": 2.0, "torque": 50.0}]}
    train = {
        "discs": {"a": {"inertia": 2.0}, "b": {"inertia": 5.0}},
        "shafts": {"s": shaft},
        "excitations": {"pulse": pulse},
        "run": {"speed_min": speed_min, "speed_max": 200.0, "points": 30},
    }
    return lw.Machine.model_validate({"format": 1, "name": "Two discs", "train": train})


def test_nothing_damps() -> None:
    """The response is infinite at the critical speed; the table says so."""
    _, (one,) = responses(two_discs())
    assert one.is_peak
    assert (one.speed, one.single, one.total) == (one.critical_speed, math.inf, math.inf)
    assert critical_table([one]).rows[0][5] == "unbounded"


def test_peak_beyond_the_speeds() -> None:
    """A damper in the shaft has the peak below the critical speed; a run that begins above it has none."""
    ((peak, height),) = maxima(two_discs(damping=150.0), 2.0, "s", 20.0, 200.0)
    _, (one,) = responses(two_discs(damping=150.0))
    assert one.speed == pytest.approx(peak, rel=1e-6)
    assert one.single == pytest.approx(height, rel=1e-9)
    assert peak < 0.95 * one.critical_speed
    _, (late,) = responses(two_discs(damping=150.0, speed_min=0.98 * one.critical_speed))
    assert not late.is_peak
    assert late.speed == late.critical_speed == pytest.approx(one.critical_speed, rel=1e-12)
    assert late.single == pytest.approx(
        torques(two_discs(150.0), 2.0, "s", np.array([late.speed]))[0], rel=1e-9
    )
    assert critical_table([late]).rows[0][3] == "–"


def test_two_criticals_with_one_peak() -> None:
    """A merged peak belongs to one of two critical speeds, the nearer one; the other has none of its own."""
    assert _owned([10.0, 12.0], [(11.5, 3.0)]) == [None, 0]
    assert _owned([10.0, 12.0], [(10.5, 3.0)]) == [0, None]
    # Held rings have each peak below its critical speed, nearer to that of the mode below.
    assert _owned([10.0, 20.0], [(7.0, 3.0), (12.0, 5.0)]) == [0, 1]
    # Of more peaks than critical speeds the highest.
    assert _owned([10.0], [(9.0, 3.0), (9.5, 1.0), (11.0, 2.0)]) == [0]
    assert _owned([10.0, 20.0], []) == [None, None]


def test_tables_tell_both() -> None:
    """The peak of the mode alone says so; "peaks at" is the forced response."""
    study = lw.torsion_study(lw.read(EXAMPLES / "propeller_shaft_line" / "machine.toml"))
    tables = {table.name: table for table in study_tables(study)}
    alone, real = tables["critical_speeds"], tables["synthesis"]
    assert not any("peaks at" in head for head in alone.heads)
    assert "mode alone: peak [rpm]" in alone.heads
    row = next(row for row in real.rows if row[0] == "mode 3, order 5")
    assert row[2:5] == ("78.53", "76.75", "line")
