"""How many elastic drivelines does a study go through in a second, and what does one take?"""

from __future__ import annotations

from typing import Any

import machines
import numpy as np
from common import Row, is_installed, seconds

import linkwright as lw
from linkwright.driveline.batch import elastic_motions

N, N_QUICK = 10_000, 1_000

# Machines that SciPy does, to extrapolate from; what results may differ by.
N_PEER, AGREE = 2, 1e-4

COUPLING = {"stiffness": 2e4, "damping": 50.0}


def rows(quick: bool) -> list[Row]:
    """Machines a second, one machine, and SciPy's boundary value solver on the same equations."""
    machine = lw.replace(
        machines.two_carts(), {"drive.crankshaft": COUPLING, "drive.motor.torque_start": None}
    )
    n = N_QUICK if quick else N
    entries = variants(n)
    motions = elastic_motions(machine, entries)
    lost = int(np.isnan(motions.numbers["period"]).sum())
    time = seconds([lambda: elastic_motions(machine, entries)], repeats=3)[0]
    note = f"{n} couplings ±10 %, phase ±3°, masses ±5 %; {lost} of them are left to be solved alone"
    many = Row("elastic drivelines, batch", "machines/s", n / time, target=2000.0, aim="at least", note=note)
    one = seconds([lambda: lw.elastic_motion(machine)], repeats=20)[0]
    single = Row("elastic driveline, one machine", "ms", 1e3 * one, target=2.0, aim="at most")
    peer = (
        by_scipy(machine, entries, motions.number("torque_max", "crankshaft"))
        if is_installed("scipy")
        else []
    )
    return [many, single, *peer]


def variants(n: int) -> dict[str, Any]:
    """Values of the entries that vary, drawn with a fixed seed."""
    draw = np.random.default_rng(48)
    return {
        "drive.crankshaft.stiffness": 2e4 * draw.uniform(0.9, 1.1, n),
        "drive.crankshaft.damping": 50.0 * draw.uniform(0.9, 1.1, n),
        "mechanism.cranks.A2.phase": np.pi / 2 + np.radians(3.0) * draw.uniform(-1, 1, n),
        "bodies.cart1.mass": 1000 * draw.uniform(0.95, 1.05, n),
    }


def by_scipy(machine: lw.Machine, entries: dict[str, Any], expected: np.ndarray) -> list[Row]:
    """What a user would write: `solve_bvp` over φ on splines of J and M, from the motion at one speed."""
    from scipy.integrate import solve_bvp
    from scipy.interpolate import CubicSpline

    drive: Any = machine.drive
    motor, i = drive.motor, drive.gearbox.ratio
    J_motor = (motor.inertia + drive.gearbox.inertia) * i**2
    s_k = 1 - motor.speed_breakdown / motor.speed_synchronous

    def torque(row: int) -> float:
        one = lw.replace(machine, {place: float(column[row]) for place, column in entries.items()})
        reduced = lw.reduction(one, n=720)
        phi = reduced.crank_angle
        J, M = CubicSpline(phi, reduced.inertia_reduced - J_motor), CubicSpline(phi, reduced.torque_load)
        k, c = (float(entries[f"drive.crankshaft.{name}"][row]) for name in ("stiffness", "damping"))

        def rates(at: np.ndarray, y: np.ndarray) -> np.ndarray:
            twist, speed, omega = y
            T = k * twist + c * (speed - omega)
            slip = 1 - speed * i / motor.speed_synchronous
            driving = 2 * motor.torque_breakdown / (slip / s_k + s_k / slip) * i * drive.gearbox.efficiency
            a = (T - M(at) - 0.5 * J(at, 1) * omega**2) / J(at)
            return np.stack([(speed - omega) / omega, (driving - T) / J_motor / omega, a / omega])

        start = np.array([[0.05], [10.3], [10.3]]) * np.ones((1, 181))
        solved = solve_bvp(rates, lambda a, b: a - b, phi[::4], start, tol=1e-6, max_nodes=20_000)
        y = solved.sol(np.linspace(0, 2 * np.pi, 4001))
        return float((k * y[0] + c * (y[1] - y[2])).max())

    for row in range(N_PEER):
        off = abs(torque(row) / expected[row] - 1)
        assert off < AGREE, f"SciPy's peak torque differs by {off:g}"
    time = seconds([lambda: torque(0)], repeats=3)[0]
    return [Row("elastic driveline, solve_bvp", "machines/s", 1 / time, note="SciPy on splines of J and M")]
