"""Motors with a PI speed controller: forced vibration, modes, Campbell diagram, gear stages."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import eig, eigh

import linkwright as lw
from linkwright import torsion_study

J, K, C = np.array([0.4, 0.15]), 900.0, 0.6
GAIN, INTEGRAL = 3.5, 260.0
PULSE = {"order": 2, "torque": 11.0, "phase": "30 deg"}


def machine(integral: float = INTEGRAL, limit: float | None = None, **train: Any) -> lw.Machine:
    """A motor with its controller on a shaft that drives a fan."""
    control = {"proportional": GAIN, "integral": integral}
    if limit is not None:
        control["torque_max"] = limit
    parts: dict[str, Any] = {
        "discs": {"motor": {"inertia": J[0]}, "fan": {"inertia": J[1], "damping": 0.2}},
        "shafts": {"shaft": {"between": ["motor", "fan"], "stiffness": K, "damping": C}},
        "drivers": {"drive": {"on": "motor", "control": control}},
        "loads": {"fan": {"on": "fan", "torque": 40.0, "speed": 60.0}},
        "excitations": {"pulse": {"on": "fan", "harmonics": [PULSE]}},
        "run": {"speed_min": 5.0, "speed_max": 60.0, "points": 12},
    }
    return lw.Machine.model_validate({"format": 1, "name": "controlled", "train": parts | train})


def matrices(speed: float, integral: float = INTEGRAL) -> tuple[Any, Any]:
    """C and K of the two discs, with the slope of the fan's law, 2 M/ω."""
    twist = np.array([[1.0, -1.0], [-1.0, 1.0]])
    load = 2 * 40.0 * (speed / 60.0) ** 2 / speed
    return C * twist + np.diag([GAIN, 0.2 + load]), K * twist + np.diag([integral, 0.0])


def test_forced_vibration_has_the_controller() -> None:
    """The controller acts as −(k_p + k_i/(iω)) on the vibratory speed of its disc."""
    forced = lw.forced_vibration(machine())
    for n, speed in enumerate(forced.speeds.tolist()):
        ω, (damping, stiffness) = 2 * speed, matrices(speed)
        dynamic = stiffness - ω**2 * np.diag(J) + 1j * ω * damping
        θ = np.linalg.solve(dynamic, [0.0, 11.0 * np.exp(1j * np.pi / 6)])
        assert forced.amplitudes[0, :, n] == pytest.approx(θ, rel=1e-12)
        torque = (K + 1j * ω * C) * (θ[0] - θ[1])
        assert forced.shaft_torques[0, 0, n] == pytest.approx(torque, rel=1e-10)
    assert forced.mean_torques[0] == pytest.approx(40.0 * (forced.speeds / 60.0) ** 2, rel=1e-12)
    assert forced.power == pytest.approx(forced.disc_heat.sum(axis=0) + forced.shaft_heat.sum(axis=0))


def test_motion_in_time_with_the_integral() -> None:
    """Equations of motion with the integral of the controller: the steady swing is the linear one."""
    speed = 12.0
    load = 2 * 40.0 * (speed / 60.0) ** 2 / speed

    def rates(t: float, y: Any) -> list[float]:
        θ, v, w = y[:2], y[2:4], y[4]
        flow = K * (θ[0] - θ[1]) + C * (v[0] - v[1])
        pulse = 11.0 * np.cos(2 * speed * t + np.pi / 6)
        control = -GAIN * v[0] - INTEGRAL * w
        return [*v, (control - flow) / J[0], (flow - (0.2 + load) * v[1] + pulse) / J[1], v[0]]

    period, cycles = np.pi / speed, 60
    times = np.linspace(cycles - 1, cycles, 65)[:-1] * period
    y = solve_ivp(
        rates, (0.0, cycles * period), np.zeros(5), t_eval=times, rtol=1e-11, atol=1e-13, method="DOP853"
    ).y
    measured = 2 * np.mean(y[:2] * np.exp(-2j * speed * times), axis=1)
    forced = lw.forced_vibration(machine(), np.array([speed]))
    assert measured == pytest.approx(forced.amplitudes[0, :, 0], rel=1e-6)


@pytest.mark.parametrize("speed", [None, 40.0])
def test_damped_modes_have_the_speed_loop(speed: float | None) -> None:
    """Eigenvalues are those of J s² + (C + k_p) s + K + k_i, the speed loop among them."""
    damped = lw.damped_vibration(machine(), speed)
    damping, stiffness = matrices(40.0 if speed is None else speed)
    if speed is None:
        damping[1, 1] = C + 0.2
    state = np.block(
        [[np.zeros((2, 2)), np.eye(2)], [-np.diag(1 / J) @ stiffness, -np.diag(1 / J) @ damping]]
    )
    expected = eig(state)[0]
    expected = np.sort_complex(expected[expected.imag >= 0])
    assert np.sort_complex(damped.eigenvalues) == pytest.approx(expected, rel=1e-10)
    assert damped.disc_shares.sum(axis=1) + damped.shaft_shares.sum(axis=1) == pytest.approx(1.0)


def test_campbell_has_the_integral_gain() -> None:
    """Frequencies over the speed are those with k_i; free vibration is that of the train alone."""
    one = machine()
    diagram = lw.campbell(one)
    square = eigh(matrices(1.0)[1], np.diag(J))[0]
    assert diagram.frequencies[:, 0] == pytest.approx(np.sqrt(square) / (2 * np.pi), rel=1e-10)
    assert {round(2 * crossing.speed, 6) for crossing in diagram.critical} == {
        round(value, 6) for value in np.sqrt(square).tolist() if 10 <= value <= 120
    }
    assert lw.free_vibration(one).natural_frequencies[0] == 0


def test_controlled_stages_and_carriers() -> None:
    """Behind a rigid stage the torque of the teeth balances the controlled motor; on a carrier too."""
    stage = {"stage": {"between": ["motor", "pinion"], "ratio": 2.5}}
    fan = {"inertia": 0.15, "damping": 0.2}
    discs = {"motor": {"inertia": 0.4}, "pinion": {"inertia": 0.05}, "fan": fan}
    shafts = {"shaft": {"between": ["pinion", "fan"], "stiffness": K, "damping": C}}
    one = machine(discs=discs, shafts=shafts, gears=stage)
    forced, meshes = lw.forced_vibration(one), lw.mesh_torques(one)
    ω = 2 / 2.5 * forced.speeds
    θ = forced.amplitudes[:, 0]
    motor = -(-(ω**2) * 0.4 + 1j * ω * GAIN + INTEGRAL) * θ
    assert np.abs(forced.orders) == pytest.approx([2 / 2.5])
    assert meshes.torques[:, 0] == pytest.approx(motor, rel=1e-9)
    seat = {
        "stage": {
            "between": ["motor", "fan"],
            "ratio": 1.0,
            "kind": "internal",
            "stiffness": K,
            "damping": C,
            "carrier": "box",
        }
    }
    box = {"box": {"inertia": 5.0}}
    held = {"seat": {"between": ["box", "ground"], "stiffness": 1e5}}
    on_carrier = machine(
        discs={"motor": {"inertia": J[0]}, "fan": {"inertia": J[1], "damping": 0.2}} | box,
        gears=seat,
        shafts=held,
    )
    plain = lw.forced_vibration(machine())
    # With a ratio of one the carrier takes nothing, and the mesh is a shaft.
    assert lw.forced_vibration(on_carrier).amplitudes[:, :2] == pytest.approx(plain.amplitudes, rel=1e-9)


def test_limit_of_the_torque_is_a_warning() -> None:
    """The linear answer has no limit of the controller: where it would act, the study says so."""
    notes = [note for note in torsion_study(machine(limit=12.0)).warnings if "controller" in note]
    assert len(notes) == 1
    assert "drive" in notes[0]
    assert "12 N m" in notes[0]
    assert not [note for note in torsion_study(machine(limit=900.0)).warnings if "controller" in note]
