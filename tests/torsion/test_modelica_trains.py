"""Reference trains of Modelica's Rotational.Examples by their equations, integrated here by SciPy.

Parameters are those of the Modelica Standard Library, version 4, Modelica/Mechanics/Rotational/Examples.
Each phase between two kinks or changes of state is integrated by itself, up to its event.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

import linkwright as lw
from linkwright import torsion_transient

Floats = NDArray[np.float64]
Rates = Callable[[float, Floats], Sequence[float]]
Event = Callable[[float, Floats], float]

TIGHT = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-13}


def machine(**train: Any) -> lw.Machine:
    return lw.Machine.model_validate({"format": 1, "name": "reference", "train": train})


def discs(**inertia: float) -> dict[str, Any]:
    return {name: {"inertia": J} for name, J in inertia.items()}


def followed(
    phase: Callable[[Any, float, Floats], tuple[Rates, list[Event]]],
    after: Callable[[Any, int, float, Floats], tuple[Any, Floats]],
    state: Any,
    start: Floats,
    times: Floats,
) -> Floats:
    """A motion of several phases, sampled: the equations of each with its events, and the state after one."""
    samples = np.empty((len(start), len(times)))
    t, y, end = 0.0, np.array(start, dtype=float), float(times[-1])
    for _ in range(1000):
        rates, events = phase(state, t, y)
        # Each event falls through zero, so that one met at the start of a leg is over.
        for event in events:
            event.terminal, event.direction = True, -1  # type: ignore[attr-defined]
        for event in events:
            event.terminal = True  # type: ignore[attr-defined]
        leg = solve_ivp(rates, (t, end), y, events=events, dense_output=True, max_step=2e-3, **TIGHT)
        inside = (times >= t) & (times <= leg.t[-1])
        samples[:, inside] = leg.sol(times[inside])
        t, y = float(leg.t[-1]), leg.y[:, -1]
        if leg.status == 0:
            return samples
        state, y = after(state, next(n for n, met in enumerate(leg.t_events) if len(met)), t, y)
    raise AssertionError(f"no end at {t}")


def test_first() -> None:
    """First: motor and load behind an ideal gear and a spring, a damper to the ground, a torque of 5 Hz."""
    moved = torsion_transient(
        machine(
            discs=discs(motor=0.1, output=2.0, load=2.0),
            gears={"gear": {"between": ["motor", "output"], "ratio": 10.0, "kind": "internal"}},
            shafts={"spring": {"between": ["output", "load"], "stiffness": 1e4}},
            loads={"damper": {"on": "output", "torque": 10.0, "speed": 1.0, "exponent": 1.0}},
            excitations={
                "sine": {
                    "on": "motor",
                    "harmonics": [{"frequency": 5.0, "torque": 10.0, "phase": -np.pi / 2}],
                }
            },
            transient={"duration": 1.0, "sample_time": 1e-3, "accuracy": 1e-12},
        )
    )

    def rates(t: float, y: Floats) -> list[float]:
        twist = y[0] - y[1]
        drive = 100.0 * np.sin(10 * np.pi * t) - 10.0 * y[2]
        return [y[2], y[3], (drive - 1e4 * twist) / 12.0, 1e4 * twist / 2.0]

    wanted = solve_ivp(rates, (0, 1), np.zeros(4), t_eval=moved.time, **TIGHT).y
    for disc, row in (("output", 2), ("load", 3)):
        assert moved.speed[moved.discs.index(disc)] == pytest.approx(wanted[row], abs=1e-8)


def test_elastic_bearing() -> None:
    """ElasticBearing: a gear in a housing on an elastic seat; here with an elastic mesh and a wheel."""
    k, wheel = 2e5, 0.3
    moved = torsion_transient(
        machine(
            discs=discs(shaft=1.0, wheel=wheel, housing=5.0, load=50.0),
            gears={
                "gear": {
                    "between": ["shaft", "wheel"],
                    "ratio": 3.0,
                    "kind": "internal",
                    "stiffness": k,
                    "carrier": "housing",
                }
            },
            shafts={
                "spring": {"between": ["wheel", "load"], "stiffness": 1e3},
                "seat": {"between": ["housing", "ground"], "stiffness": 1e5, "damping": 5.0},
            },
            transient={
                "duration": 2.0,
                "sample_time": 2e-3,
                "accuracy": 1e-12,
                "events": [{"kind": "torque_course", "on": "shaft", "times": [0, 5], "torque": [0, 100]}],
            },
        )
    )
    J = np.array([1.0, wheel, 5.0, 50.0])
    mesh, spring, seat = np.array([1.0, -3, 2, 0]), np.array([0, 1.0, 0, -1]), np.array([0, 0, 1.0, 0])
    K = k * np.outer(mesh, mesh) + 1e3 * np.outer(spring, spring) + 1e5 * np.outer(seat, seat)
    C = 5.0 * np.outer(seat, seat)

    def rates(t: float, y: Floats) -> Floats:
        force = -K @ y[:4] - C @ y[4:]
        force[0] += 20.0 * t
        return np.concatenate([y[4:], force / J])

    wanted = solve_ivp(rates, (0, 2), np.zeros(8), t_eval=moved.time, **TIGHT).y
    # The load follows with a thousandth of the speed of the shaft.
    assert moved.speed == pytest.approx(wanted[4:], abs=1e-8)
    assert moved.torque[moved.shafts.index("seat")] == pytest.approx(
        1e5 * wanted[2] + 5 * wanted[6], abs=1e-5
    )


def test_backlash() -> None:
    """Backlash: an inertia released at 90° in a backlash of 45°; its damper stays within the spring.

    Two discs of 10 kg m² that turn freely against each other are one of 5 kg m² against the ground.
    """
    J, k, c, half = 5.0, 2e4, 50.0, np.pi / 8
    moved = torsion_transient(
        machine(
            discs=discs(a=2 * J, b=2 * J),
            gears={
                "mesh": {
                    "between": ["a", "b"],
                    "ratio": 1.0,
                    "kind": "internal",
                    "stiffness": k,
                    "damping": c,
                    "backlash": 2 * half,
                }
            },
            transient={
                "duration": 1.0,
                "sample_time": 1e-3,
                "accuracy": 1e-12,
                "twists": {"mesh": np.pi / 2},
            },
        )
    )

    def torque(y: Floats) -> float:
        """Of the mesh: spring, and damper within the torque of the spring."""
        beyond = y[0] - np.sign(y[0]) * half if abs(y[0]) > half else 0.0
        spring = k * beyond
        return float(spring + np.clip(c * y[1], -abs(spring), abs(spring)))

    # The torque is continuous; steps short beside the swing of 63 rad/s meet its kinks closely.
    wanted = solve_ivp(
        lambda t, y: [y[1], -torque(y) / J],
        (0, 1),
        [np.pi / 2, 0.0],
        t_eval=moved.time,
        max_step=2e-4,
        **TIGHT,
    ).y
    twist = moved.angle[0] - moved.angle[1]
    assert twist == pytest.approx(wanted[0], abs=1e-8)
    assert moved.torque[0] == pytest.approx([torque(y) for y in wanted.T], abs=1e-8 * k)
    assert abs(moved.energy_error) < 1e-9
    # No torque pulls: it has the sign of the twist beyond the flank, and none between both.
    assert (moved.torque[0] * twist >= 0).all()
    assert not moved.torque[0][np.abs(twist) < half - 1e-9].any()


RATIO = 2.0


def lossy(
    forward: float,
    reverse: float,
    drive: Callable[[float], float],
    load: Callable[[float], float],
    times: Floats,
    speed: float = 0.0,
) -> tuple[Floats, list[str]]:
    """Speed of the first disc of a rigid stage between 1 and 1.5 kg m², and its states in order."""
    J1, J2 = 1.0, 1.5
    passed: list[str] = []

    def factor(sense: float, positive: bool) -> float:
        return 1 / forward if positive == (sense > 0) else reverse

    def teeth(t: float, g: float) -> float:
        """Torque of the teeth at the first disc's speed, with g times it at the first disc."""
        return (J2 / RATIO**2 * drive(t) - J1 * load(t) / RATIO) / (J1 + g * J2 / RATIO**2)

    def moving(sense: float, positive: bool) -> tuple[Rates, list[Event]]:
        g = factor(sense, positive)
        inertia = J1 + g * J2 / RATIO**2
        return (
            lambda t, y: [(drive(t) + g * load(t) / RATIO) / inertia],
            [lambda t, y: sense * y[0], lambda t, y: teeth(t, 1.0) * (1 if positive else -1)],
        )

    def spare(t: float, side: int) -> float:
        """What is left to the bound of the torque at the first disc of a stage at rest."""
        T = -load(t) / RATIO
        bounds = sorted((T / forward, reverse * T))
        return bounds[1] - drive(t) if side > 0 else drive(t) - bounds[0]

    def phase(state: tuple[str, bool], t: float, y: Floats) -> tuple[Rates, list[Event]]:
        passed.append(state[0])
        if state[0] == "stuck":
            return lambda t, y: [0.0], [lambda t, y: spare(t, 1), lambda t, y: spare(t, -1)]
        return moving(1.0 if state[0] == "forward" else -1.0, state[1])

    def rolls(t: float, name: str) -> tuple[str, bool]:
        return name, teeth(t, 1.0) > 0

    def after(state: tuple[str, bool], event: int, t: float, y: Floats) -> tuple[tuple[str, bool], Floats]:
        if state[0] == "stuck":
            return rolls(t, "backward" if event else "forward"), y
        if event == 1:
            return (state[0], not state[1]), y
        for name, side in (("forward", 1), ("backward", -1)):
            if spare(t, side) < 0:
                return rolls(t, name), np.zeros(1)
        return ("stuck", True), np.zeros(1)

    start = after(("", True), 0, 0.0, np.zeros(1))[0] if not speed else rolls(0.0, "forward")
    found = followed(phase, after, start, np.array([speed]), times)[0]
    return found, passed


def test_lossy_gear_demo_1() -> None:
    """LossyGearDemo1: with an efficiency of 0.5 the stage rolls forward, sticks, and rolls backward."""
    moved = torsion_transient(
        machine(
            discs=discs(a=1.0, b=1.5),
            gears={"gear": {"between": ["a", "b"], "ratio": RATIO, "kind": "internal", "efficiency": 0.5}},
            excitations={
                "sine": {"on": "a", "harmonics": [{"frequency": 1.0, "torque": 10.0, "phase": -np.pi / 2}]}
            },
            transient={
                "duration": 2.0,
                "sample_time": 1e-3,
                "accuracy": 1e-12,
                "events": [{"kind": "torque_course", "on": "b", "times": [0, 2], "torque": [-10, -5]}],
            },
        )
    )
    wanted, states = lossy(
        0.5, 0.5, lambda t: 10 * np.sin(2 * np.pi * t), lambda t: -10 + 2.5 * t, moved.time
    )
    assert {"forward", "stuck", "backward"} == set(states)
    assert moved.speed[0] == pytest.approx(wanted, abs=1e-8)
    assert moved.speed[1] == pytest.approx(wanted / RATIO, abs=1e-8)
    assert abs(moved.energy_error) < 1e-9
    assert moved.loss["gear"] > 1


@pytest.mark.parametrize("reverse", [0.0, 0.3, 1.0])
def test_a_load_drives_back_or_not(reverse: float) -> None:
    """A stage of any efficiency in reverse under a load that turns back and forth; 0 locks itself."""
    moved = torsion_transient(
        machine(
            discs=discs(a=1.0, b=1.5),
            gears={
                "gear": {
                    "between": ["a", "b"],
                    "ratio": RATIO,
                    "kind": "internal",
                    "efficiency": 0.8,
                    "efficiency_reverse": reverse,
                }
            },
            excitations={
                "sine": {"on": "b", "harmonics": [{"frequency": 1.0, "torque": 12.0, "phase": -np.pi / 2}]}
            },
            transient={
                "duration": 3.0,
                "sample_time": 1e-3,
                "accuracy": 1e-12,
                "events": [{"kind": "torque_course", "on": "a", "times": [0, 3], "torque": [2, -3]}],
            },
        )
    )
    wanted, states = lossy(
        0.8, reverse, lambda t: 2 - 5 * t / 3, lambda t: 12 * np.sin(2 * np.pi * t), moved.time
    )
    assert moved.speed[0] == pytest.approx(wanted, abs=1e-8)
    assert abs(moved.energy_error) < 1e-9
    # The lower the efficiency in reverse, the more holds the stage at rest.
    assert ("stuck" in states) == (reverse < 1)
