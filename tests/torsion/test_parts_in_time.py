"""Planetary stages, pendulums, joints, speed controllers in time: laws, closed forms, SciPy."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

import linkwright as lw
from linkwright import free_vibration, torsion_transient
from linkwright.torsion import follow_train
from linkwright.torsion.in_time.moving_train import moving_train

Floats = NDArray[np.float64]

TIGHT = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-13}


def machine(**train: Any) -> lw.Machine:
    return lw.Machine.model_validate({"format": 1, "name": "parts", "train": train})


def discs(**inertia: float) -> dict[str, Any]:
    return {name: {"inertia": J} for name, J in inertia.items()}


PLANETARY: dict[str, Any] = {
    "teeth": [24, 84],
    "planet_inertia": 0.002,
    "sun_stiffness": 4e5,
    "ring_stiffness": 5e6,
}


def planetary(held: dict[str, Any], transient: dict[str, Any], **stage: Any) -> lw.Machine:
    return machine(
        discs=discs(motor=0.05, sun=0.01, carrier=0.6, ring=0.3, load=2.0),
        shafts={
            "input": {"between": ["motor", "sun"], "stiffness": 3e4},
            "output": {"between": ["carrier", "load"], "stiffness": 2e5},
            **held,
        },
        planetaries={"stage": {"sun": "sun", "ring": "ring", "carrier": "carrier", **PLANETARY, **stage}},
        transient={"accuracy": 1e-12, "sample_time": 2e-5, **transient},
    )


SEAT = {"seat": {"between": ["ring", "ground"], "stiffness": 1e6}}


@pytest.mark.parametrize("mode", [1, 2, 4])
@pytest.mark.parametrize("speed", [0.0, 80.0])
def test_a_mode_of_a_planetary_stage_vibrates_by_itself(mode: int, speed: float) -> None:
    """Twisted as a mode, the stage vibrates with that frequency alone, at rest and while it turns."""
    free = free_vibration(planetary(SEAT, {"duration": 0.01}))
    twists = {name: 1e-4 * float(twist) for name, twist in zip(free.shafts, free.twists[mode], strict=True)}
    moved = torsion_transient(planetary(SEAT, {"duration": 0.01, "twists": twists, "speed": speed}))
    omega = free.angular_frequencies[mode]
    for s, name in enumerate(moved.shafts):
        first = moved.torque[s, 0]
        assert moved.torque[s] == pytest.approx(
            first * np.cos(omega * moved.time), abs=1e-7 * abs(moved.torque).max()
        ), name
    assert abs(moved.energy_error) < 1e-10


def test_a_free_planetary_stage_keeps_energy_and_momentum() -> None:
    """Three free members under a torque: Willis' relation on the mean, energy, momentum."""
    events = [{"kind": "torque", "on": "motor", "torque": 30.0, "time": 0.0}]
    transient = {"duration": 0.1, "events": events, "sample_time": 1e-4}
    moved = torsion_transient(planetary({}, transient, carrier_speed=0.25))
    assert abs(moved.energy_error) < 1e-10
    place = moved.discs.index
    sun, ring, carrier = (moved.speed[place(name), -500:].mean() for name in ("sun", "ring", "carrier"))
    sense = np.sign(0.25 * (1 + 24 / 84) - 24 / 84)
    assert sun * 24 + sense * ring * 84 == pytest.approx(108 * carrier, rel=2e-3)
    # Two motions twist nothing; along each the momentum is the impulse of the torque on the motor.
    free = free_vibration(planetary({}, transient, carrier_speed=0.25))
    rigid = free.mode_shapes[np.abs(free.twists).max(axis=1) < 1e-9 * np.abs(free.twists).max()]
    assert len(rigid) == 2
    J = {"motor": 0.05, "sun": 0.01, "carrier": 0.6, "ring": 0.3, "load": 2.0}
    inertia = np.array([J.get(name, 0.002) for name in moved.discs])
    impulse = np.outer(rigid[:, place("motor")], 30.0 * moved.time)
    assert (rigid * inertia) @ moved.speed == pytest.approx(impulse, abs=1e-8)


def test_a_held_ring_rests() -> None:
    """A ring on its seat stands while the train runs, with three quarters of the torque of the output."""
    transient = {"duration": 0.2, "speed": 100.0, "settle": 0.0, "sample_time": 1e-4}
    entries = {"loads": {"load": {"on": "load", "torque": 90.0, "speed": 20.0, "exponent": 1.0}}}
    base = planetary(SEAT, transient)
    moved = torsion_transient(
        lw.Machine.model_validate(
            {
                "format": 1,
                "name": "held",
                "train": {**base.train.model_dump(exclude_unset=True), **entries},  # type: ignore[union-attr]
            }
        )
    )
    place = moved.discs.index
    output = 90.0 * (100.0 / 4.5) / 20.0
    assert moved.speed[place("load")] == pytest.approx(100.0 / 4.5, rel=1e-9)
    assert moved.speed[place("ring")] == pytest.approx(0.0, abs=1e-7)
    assert abs(moved.torque[moved.shafts.index("seat")]) == pytest.approx(output * 84 / 108, rel=1e-8)
    assert "motor is driven" in moved.balance


MASS, RADIUS, LENGTH = 0.8, 0.12, 0.03


def pendulum(transient: dict[str, Any], torque: float, J: float = 0.4, damping: float = 0.0) -> lw.Machine:
    return machine(
        discs=discs(wheel=J),
        pendulums={
            "bob": {"on": "wheel", "mass": MASS, "radius": RADIUS, "length": LENGTH, "damping": damping}
        },
        excitations={"gas": {"on": "wheel", "harmonics": [{"order": 2, "torque": torque, "phase": 0.3}]}},
        run={"speed_min": 40.0, "speed_max": 400.0},
        transient={"accuracy": 1e-12, "settle": 0.0, "loaded": False, "balanced": False, **transient},
    )


def swinging(t: float, y: Floats, torque: float, J: float, c: float) -> Floats:
    """Disc and point mass in the absolute angle α = θ + ψ: T = ½Jθ̇² + ½m(R²θ̇² + l²α̇² + 2Rlθ̇α̇ cos(α − θ))."""
    theta, alpha, omega, rate = y
    psi, both = alpha - theta, MASS * RADIUS * LENGTH
    share = LENGTH / (RADIUS + LENGTH)
    drag = c * share**2 * (rate - omega)
    M = [[J + MASS * RADIUS**2, both * math.cos(psi)], [both * math.cos(psi), MASS * LENGTH**2]]
    f = [
        torque * math.cos(2 * theta + 0.3) + both * math.sin(psi) * rate**2 + drag,
        -both * math.sin(psi) * omega**2 - drag,
    ]
    return np.concatenate([[omega, rate], np.linalg.solve(M, f)])


def test_a_pendulum_swings_far_by_lagrange() -> None:
    """Swings of half a right angle and more: the equations in other coordinates, and the energy."""
    J, c, torque = 0.05, 0.002, 60.0
    moved = torsion_transient(pendulum({"duration": 0.3, "speed": 100.0, "sample_time": 1e-3}, torque, J, c))
    wanted = solve_ivp(
        swinging, (0, 0.3), [0.0, 0.0, 100.0, 100.0], t_eval=moved.time, args=(torque, J, c), **TIGHT
    ).y
    assert np.abs(moved.swing).max() > 0.8
    assert moved.swing[0] == pytest.approx(wanted[1] - wanted[0], abs=1e-8)
    assert moved.speed[0] == pytest.approx(wanted[2], abs=1e-7)
    assert abs(moved.energy_error) < 1e-10


@pytest.mark.parametrize("speed", [60.0, 250.0])
def test_small_swings_have_the_order_of_the_pendulum(speed: float) -> None:
    """On a heavy disc a pendulum swings freely at √(R/l) times the speed, at every speed."""
    order = math.sqrt(RADIUS / LENGTH)
    duration = 10 * math.pi / (order * speed)
    moving = moving_train(
        pendulum({"duration": duration}, 0.0, 1e9).train,  # type: ignore[arg-type]
        pendulum({"duration": duration}, 0.0, 1e9).train.transient,  # type: ignore[arg-type,union-attr]
    )
    lead = 1e-3 * LENGTH / (RADIUS + LENGTH)
    moved = follow_train(
        moving, duration=duration, speed=speed, angle=[0.0, lead], accuracy=1e-12, sample_time=duration / 4000
    )
    # The frequency of a swing ψ falls by a part of ψ²/16.
    assert moved.swing[0] == pytest.approx(1e-3 * np.cos(order * speed * moved.time), abs=3e-8)


@pytest.mark.parametrize("speed", [60.0, 250.0])
def test_den_hartog_at_order_two_in_time(speed: float) -> None:
    """Tuned to order 2, the pendulum balances the torque of that order, at two speeds."""
    torque = 1e-4 * MASS * RADIUS * (RADIUS + LENGTH) * speed**2
    # Steady: the torque on the disc, mR(R + l)Ω² ψ, is that from outside, reversed.
    psi = -torque / (MASS * RADIUS * (RADIUS + LENGTH) * speed**2)
    entries = pendulum({"duration": 0.5}, torque).train
    assert entries is not None
    assert entries.transient is not None
    share = LENGTH / (RADIUS + LENGTH)
    lead, rate = psi * share * math.cos(0.3), -2 * speed * psi * share * math.sin(0.3)
    moved = follow_train(
        moving_train(entries, entries.transient),
        duration=0.5,
        speed=[speed, speed + rate],
        angle=[0.0, lead],
        accuracy=1e-12,
    )
    bare = torque / (2 * speed) / (0.4 + MASS * (RADIUS + LENGTH) ** 2)
    assert np.ptp(moved.speed[0]) < 1e-3 * bare
    assert np.abs(moved.swing).max() == pytest.approx(abs(psi), rel=1e-3)


ALPHA, PHASE = math.radians(25), 0.4


def joint(stiffness: float, J: float, transient: dict[str, Any], damping: float = 0.02) -> lw.Machine:
    return machine(
        discs=discs(wheel=50.0, behind=J, end=J),
        shafts={
            "joint": {
                "between": ["wheel", "behind"],
                "stiffness": stiffness,
                "damping": damping,
                "joint_angle": ALPHA,
                "joint_phase": PHASE,
            },
            "shaft": {"between": ["behind", "end"], "stiffness": 400.0},
        },
        transient={"accuracy": 1e-12, "loaded": False, "balanced": False, **transient},
    )


def test_a_joint_turns_by_its_equation() -> None:
    """Shafts behind a Hooke's joint by virtual work with tan ψ = tan φ/cos α, from rest under a torque."""
    J, k, c = 0.02, 900.0, 0.02
    events = [{"kind": "torque", "on": "wheel", "torque": 4000.0, "time": 0.0}]
    moved = torsion_transient(joint(k, J, {"duration": 0.8, "sample_time": 1e-3, "events": events}))

    def behind(phi: float) -> tuple[float, float]:
        psi = math.atan2(math.sin(phi), math.cos(phi) * math.cos(ALPHA))
        psi += 2 * math.pi * round((phi - psi) / (2 * math.pi))
        return psi, math.cos(ALPHA) / (1 - (math.sin(ALPHA) * math.cos(phi)) ** 2)

    def rates(t: float, y: Floats) -> list[float]:
        psi, slope = behind(y[0] + PHASE)
        T = k * (psi - PHASE - y[1]) + c * (slope * y[3] - y[4])
        S = 400.0 * (y[1] - y[2])
        return [y[3], y[4], y[5], (4000.0 - slope * T) / 50.0, (T - S) / J, S / J]

    start = behind(PHASE)[0] - PHASE
    wanted = solve_ivp(
        rates, (0, 0.8), [0.0, start, start, 0, 0, 0], t_eval=moved.time, max_step=1e-3, **TIGHT
    ).y
    assert moved.torque[0, 0] == pytest.approx(0.0, abs=1e-9)
    assert moved.speed == pytest.approx(wanted[3:], abs=1e-7)
    assert abs(moved.energy_error) < 1e-10


def test_a_stiff_joint_gives_its_speed_ratio() -> None:
    """Behind a stiff joint the speed is cos α/(1 − sin²α cos²φ) times that before it."""
    moved = torsion_transient(joint(1e7, 1e-3, {"duration": 0.2, "speed": 60.0, "sample_time": 1e-4}, 50.0))
    phi = moved.angle[0] + PHASE
    ratio = math.cos(ALPHA) / (1 - (math.sin(ALPHA) * np.cos(phi)) ** 2)
    late = moved.time > 0.05
    assert (moved.speed[1] / moved.speed[0])[late] == pytest.approx(ratio[late], abs=1e-4)


def controlled(control: dict[str, Any], **transient: Any) -> lw.Machine:
    return machine(
        discs=discs(motor=0.5, load=3.0),
        shafts={"shaft": {"between": ["motor", "load"], "stiffness": 5e3, "damping": 2.0}},
        loads={"pump": {"on": "load", "torque": 40.0, "speed": 100.0, "exponent": 1.0}},
        drivers={"inverter": {"on": "motor", "control": control}},
        transient={"sample_time": 1e-3, "accuracy": 1e-12, **transient},
    )


def test_a_controller_by_its_equations() -> None:
    """A run-up along a set-point with a limit of the torque: back-calculation by SciPy."""
    kp, ki, most = 8.0, 30.0, 90.0
    control = {
        "times": [0.0, 1.0, 3.0],
        "speeds": [0.0, 100.0, 60.0],
        "proportional": kp,
        "integral": ki,
        "torque_max": most,
    }
    moved = torsion_transient(controlled(control, duration=4.0))

    def rates(t: float, y: Floats) -> list[float]:
        e = float(np.interp(t, [0, 1, 3], [0, 100, 60])) - y[2]
        u = kp * (e + y[4])
        M = min(max(u, -most), most)
        T = 5e3 * (y[0] - y[1]) + 2.0 * (y[2] - y[3])
        return [y[2], y[3], (M - T) / 0.5, (T - 0.4 * y[3]) / 3.0, (e + (M - u) / kp) * ki / kp]

    wanted = solve_ivp(rates, (0, 4), np.zeros(5), t_eval=moved.time, max_step=2e-3, **TIGHT).y
    assert moved.speed == pytest.approx(wanted[2:4], abs=1e-7)
    assert moved.torque_max[0] > 60
    assert abs(moved.energy_error) < 1e-9


def test_a_controller_holds_its_speed_after_a_load_step() -> None:
    """The integral leaves no deviation: after a step the speed returns, and work is that of the load."""
    step = {"kind": "load_step", "load": "pump", "time": 0.5, "factor": 1.6}
    control = {"proportional": 20.0, "integral": 100.0}
    moved = torsion_transient(controlled(control, duration=8.0, speed=100.0, settle=0.0, events=[step]))
    assert moved.speed[0, moved.time < 0.5] == pytest.approx(100.0, abs=1e-8)
    assert moved.speed[0].min() < 99.5
    assert moved.speed[0, -1] == pytest.approx(100.0, abs=1e-5)
    assert moved.torque[0, [0, -1]] == pytest.approx([40.0, 64.0], abs=1e-4)
    assert moved.work["inverter"] > 0
    proportional = controlled({"proportional": 20.0}, duration=8.0, speed=100.0, settle=0.0, events=[step])
    left = torsion_transient(proportional)
    # Without an integral the deviation is that of the gain: 24 N m (less what the slower load saves)/20.
    assert left.speed[0, -1] == pytest.approx(100.0 - 24.0 / 20.64, abs=1e-6)


@pytest.mark.parametrize("seed", range(12))
def test_energy_of_random_trains(seed: int) -> None:
    """All parts together, with stages that lose power and backlash: the energy balances to 1e-9."""
    rng = np.random.default_rng(seed)

    def size(least: float, most: float) -> float:
        return float(np.exp(rng.uniform(np.log(least), np.log(most))))

    elastic = {"stiffness": size(1e4, 1e5), "damping": size(0.1, 10), "backlash": size(1e-4, 3e-3)}
    moved = torsion_transient(
        machine(
            discs=discs(**{name: size(0.05, 0.6) for name in ("a", "b", "c", "d", "sun", "carrier", "ring")}),
            gears={
                "lossy": {
                    "between": ["a", "b"],
                    "ratio": size(0.5, 3),
                    "efficiency": float(rng.uniform(0.7, 1)),
                    "efficiency_reverse": float(rng.choice([0.0, 0.5, 0.9])),
                },
                "mesh": {
                    "between": ["c", "d"],
                    "ratio": size(0.5, 3),
                    "efficiency": float(rng.uniform(0.7, 1)),
                    **elastic,
                },
            },
            shafts={
                "bc": {"between": ["b", "c"], "stiffness": size(5e3, 5e4), "damping": size(0.1, 3)},
                "joint": {
                    "between": ["d", "sun"],
                    "stiffness": size(5e3, 5e4),
                    "damping": 1.0,
                    "joint_angle": float(rng.uniform(0.1, 0.5)),
                    "joint_phase": float(rng.uniform(0, 3)),
                },
                "seat": {"between": ["ring", "ground"], "stiffness": size(1e5, 1e6), "damping": 20.0},
            },
            planetaries={"stage": {"sun": "sun", "ring": "ring", "carrier": "carrier", **PLANETARY}},
            pendulums={"bob": {"on": "c", "mass": 0.5, "radius": 0.1, "length": 0.03, "damping": 0.01}},
            loads={"load": {"on": "carrier", "torque": size(50, 400), "speed": 20.0}},
            drivers={
                "motor": {
                    "on": "a",
                    "control": {"proportional": size(0.5, 5), "integral": size(1, 20), "torque_max": 200.0},
                }
            },
            run={"speed_min": 20.0, "speed_max": 100.0},
            transient={
                "duration": 0.3,
                "speed": 60.0,
                "settle": 0.0,
                "loaded": bool(rng.integers(2)),
                "balanced": False,
                "accuracy": 1e-8,
                "method": "explicit",
                "sample_time": 1e-3,
                "events": [
                    {"kind": "torque", "on": "a", "torque": -120.0, "time": 0.05, "until": 0.2},
                    {"kind": "load_step", "load": "load", "factor": 0.2, "time": 0.1},
                ],
            },
        )
    )
    assert abs(moved.energy_error) < 1e-9, moved.energy_error
    assert all(loss >= -1e-9 for loss in moved.loss.values())
