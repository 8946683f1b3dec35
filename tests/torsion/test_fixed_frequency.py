"""Torques of fixed electrical frequency, interharmonics of inverters and torque by slip."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import linkwright as lw
from linkwright import MachineError, campbell, forced_vibration, torsion_study, torsion_transient
from linkwright.torsion.figures.modes import campbell_figure

J = np.array([0.6, 2.5])
K, C = 3e4, 1.5


def machine(harmonics: list[dict[str, Any]], **train: Any) -> lw.Machine:
    excitation = train.pop("excitation", {})
    return lw.Machine.model_validate(
        {
            "format": 1,
            "name": "motor",
            "train": {
                "discs": {"motor": {"inertia": J[0]}, "fan": {"inertia": J[1]}},
                "shafts": {"shaft": {"between": ["motor", "fan"], "stiffness": K, "damping": C}},
                "excitations": {"air_gap": {"on": "motor", "harmonics": harmonics, **excitation}},
                **train,
            },
        }
    )


RUN = {"speed_min": 20.0, "speed_max": 160.0, "points": 71}
LINES = [
    {"frequency": 50.0, "torque": 8.0, "phase": 0.3},
    {"frequency": "100 Hz", "torque": 5.0},
    {"order": 12.0, "frequency": -100.0, "torque": 4.0, "phase": 0.7},
    {"order": 2.0, "torque": 3.0, "phase": 0.1},
]


def test_lines_beside_the_orders() -> None:
    """Each line is solved at |νΩ + ω₀|, exactly as the two discs have it; families of lines add up."""
    forced = forced_vibration(machine(LINES, run=RUN))
    given = {(wave.get("order", 0.0), wave.get("frequency", 0.0)): wave for wave in LINES}
    assert forced.lines == ("2", "50 Hz", "100 Hz", "12 − 100 Hz")
    stiffness = np.array([[1.0, -1.0], [-1.0, 1.0]])
    sizes, supply = np.zeros(len(forced.speeds)), np.zeros((len(forced.speeds), 2000))
    time = np.linspace(0.0, 0.02, 2000)
    for (order, frequency), wave in given.items():
        hertz = 100.0 if frequency == "100 Hz" else frequency
        same = (forced.orders == order) & np.isclose(forced.offsets, 2 * math.pi * hertz)
        n = np.flatnonzero(same)
        for s, speed in enumerate(forced.speeds.tolist()):
            omega = order * speed + 2 * math.pi * hertz
            matrix = (K + 1j * omega * C) * stiffness - omega**2 * np.diag(J)
            theta = np.linalg.solve(matrix, [wave["torque"] * np.exp(1j * wave.get("phase", 0.0)), 0.0])
            # A line whose frequency is negative turns back: its conjugate is the motion at |ω|.
            theta = theta.conj() if omega < 0 else theta
            assert forced.amplitudes[n[0], :, s] == pytest.approx(theta, rel=1e-8)
            torque = (K + 1j * abs(omega) * C) * (theta[0] - theta[1])
            if order:
                sizes[s] += abs(torque)
            else:
                supply[s] += (torque * np.exp(1j * omega * time)).real
    # 50 Hz and 100 Hz repeat together.
    sizes += 0.5 * np.ptp(supply, axis=1)
    assert forced.shaft_torque_vibratory[0] == pytest.approx(sizes, rel=1e-5)
    assert forced.power == pytest.approx(forced.shaft_heat.sum(axis=0), rel=1e-9)


def test_critical_speeds_of_interharmonics() -> None:
    """Lines meet the natural frequency where νΩ + ω₀ = ±ω; a fixed frequency alone has no critical speed."""
    diagram = campbell(machine(LINES, run=RUN))
    omega = math.sqrt(K * J.sum() / J.prod())
    expected = sorted([omega / 2, (omega + 200 * math.pi) / 12, (200 * math.pi - omega) / 12])
    expected = [speed for speed in expected if RUN["speed_min"] <= speed <= RUN["speed_max"]]
    assert [one.speed for one in diagram.critical] == pytest.approx(expected, rel=1e-12)
    study = torsion_study(machine(LINES, run=RUN))
    assert study.campbell is not None
    assert {one.line for one in study.campbell.critical} <= {"2", "12 − 100 Hz"}
    assert any("12 − 100 Hz" in warning for warning in study.warnings)


def test_amplitudes_over_the_slip_in_steady_running() -> None:
    """Factors over the speed count in forced vibration and in the severity of critical speeds."""
    law = {"speeds": [0.0, 60.0, 160.0], "factors": [1.5, 1.0, 0.2]}
    plain, scaled = (machine(LINES, run=RUN, excitation=one) for one in ({}, law))
    factor = np.interp(np.linspace(20.0, 160.0, 71), law["speeds"], law["factors"])
    forced, without = forced_vibration(scaled), forced_vibration(plain)
    assert forced.amplitudes == pytest.approx(factor * without.amplitudes, rel=1e-12)
    for one, other in zip(campbell(scaled).critical, campbell(plain).critical, strict=True):
        assert one.vector_sum == pytest.approx(
            np.interp(one.speed, law["speeds"], law["factors"]) * other.vector_sum, rel=1e-12
        )


def test_names_of_lines_in_the_campbell_diagram() -> None:
    """Lines at 1× and 2× supply and beside an order are drawn and named, critical speeds by their line."""
    study = torsion_study(machine(LINES, run=RUN))
    assert study.campbell is not None
    axes = campbell_figure(study.campbell).axes[0]
    words = [text.get_text() for text in axes.texts]
    assert {"50 Hz", "100 Hz", "12 − 100 Hz", "2"} <= {*words}
    assert any(word.endswith("(12 − 100 Hz)") for word in words)
    level = [line for line in axes.lines if np.ptp(line.get_ydata()) == 0]
    assert {round(float(line.get_ydata()[0]), 6) for line in level} >= {50.0, 100.0}


@pytest.mark.parametrize("wave", LINES)
def test_lines_in_time(wave: dict[str, Any]) -> None:
    """In time the same line, started in its steady vibration, keeps to the amplitude of forced vibration."""
    speed = 60.0
    train = machine([wave], run={"speed_min": speed, "speed_max": 160.0, "points": 2})
    forced = forced_vibration(train, np.array([speed]))
    moved = torsion_transient(
        machine([wave], transient={"duration": 0.5, "speed": speed, "settle": 20.0, "sample_time": 1e-4})
    )
    amplitude = abs(forced.shaft_torques[0, 0, 0])
    assert moved.torque_max[0] == pytest.approx(amplitude, rel=2e-3)
    order = wave.get("order", 0.0)
    hertz = 100.0 if wave.get("frequency") == "100 Hz" else wave.get("frequency", 0.0)
    phase = order * moved.angle[0] + 2 * math.pi * hertz * moved.time
    torque = forced.shaft_torques[0, 0, 0]
    if order * speed + 2 * math.pi * hertz < 0:
        torque = torque.conjugate()
    assert moved.torque[0] == pytest.approx((torque * np.exp(1j * phase)).real, abs=2e-2 * amplitude)


def test_synchronous_start() -> None:
    """A synchronous motor starts in 10 s: torque at twice the slip frequency by a law over the slip.

    Its equations are integrated in the test.
    """
    poles, mains, duration = 2, 50.0, 10.0
    synchronous = 2 * math.pi * mains / poles
    speeds = np.linspace(0.0, 1.2 * synchronous, 13)
    mean = 60.0 + 20.0 * np.sin(speeds / synchronous * 2.0)
    factors = 1.0 + 0.5 * (1 - speeds / synchronous) ** 2
    twice = {"order": 2.0 * poles, "frequency": -2 * mains, "torque": 30.0, "phase": 0.2}
    moved = torsion_transient(
        machine(
            [twice],
            excitation={"speeds": speeds.tolist(), "factors": factors.tolist()},
            transient={
                "duration": duration,
                "accuracy": 1e-9,
                "motors": {
                    "mean": {
                        "on": "motor",
                        "motor": {
                            "kind": "table",
                            "speed": speeds.tolist(),
                            "torque": mean.tolist(),
                            "inertia": 0.0,
                        },
                    }
                },
            },
        )
    )

    def rates(time: float, y: Any) -> list[float]:
        a, b, u, v = y
        shaft = K * (a - b) + C * (u - v)
        wave = 30.0 * np.cos(2 * poles * a - 4 * math.pi * mains * time + 0.2)
        drive = np.interp(u, speeds, mean) + np.interp(u, speeds, factors) * wave
        return [u, v, (drive - shaft) / J[0], shaft / J[1]]

    exact = solve_ivp(
        rates, (0, duration), np.zeros(4), method="DOP853", rtol=1e-9, atol=1e-9, dense_output=True
    )
    assert exact.sol is not None
    assert moved.speed[:, -1] == pytest.approx(exact.y[2:, -1], rel=1e-5)
    a, b, u, v = exact.sol(moved.time)
    torque = K * (a - b) + C * (u - v)
    assert moved.torque[0] == pytest.approx(torque, abs=1e-3 * torque.max())
    # It passes the resonance where 2 s f is the natural frequency.
    assert moved.torque_max[0] > 2 * 80.0


@pytest.mark.parametrize(
    ("harmonics", "excitation", "words"),
    [
        ([{"torque": 1.0}], {}, "an order, a frequency, or both"),
        ([{"frequency": 50.0, "torque": 1.0}] * 2, {}, "an order not yet in the list"),
        ([{"order": 1.0, "torque": 1.0}], {"speeds": [1.0, 2.0]}, "speeds and factors together"),
        (
            [{"order": 1.0, "torque": 1.0}],
            {"speeds": [1.0, 2.0], "factors": [1.0, 0.5], "speed": 2.0},
            "none beside speeds",
        ),
    ],
)
def test_what_is_wrong_is_told(
    harmonics: list[dict[str, Any]], excitation: dict[str, Any], words: str
) -> None:
    """A line without order and frequency, one given twice, half of a table."""
    with pytest.raises(MachineError, match=words):
        machine(harmonics, excitation=excitation)
