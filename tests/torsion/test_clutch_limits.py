"""Permitted torque and friction work of clutches, brakes and freewheels against closed forms."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from command_line import invoke
from scipy.integrate import solve_ivp

import linkwright as lw
from linkwright import torsion_transient

ENGAGING = """
format = 1
name = "engaging clutch"
[train.discs]
a = {{ inertia = 1.0 }}
b = {{ inertia = 3.0 }}
[train.clutches]
k = {{ between = ["a", "b"], sliding = {sliding}, torque_permitted = "25 N m", heat_permitted = "650 J" }}
[train.transient]
duration = 6.0
sample_time = 0.01
speeds = {{ a = 40.0, b = 0.0 }}
"""


def test_an_engaging_clutch_turns_half_of_m_dw_squared_into_heat() -> None:
    """Q = ½ J₁J₂/(J₁+J₂) Δω² = 600 J whatever the torque; the torque is the sliding one."""
    for sliding, is_kept in ((20.0, True), (30.0, False)):
        moved = torsion_transient(lw.loads(ENGAGING.format(sliding=sliding)))
        torque, heat = moved.judgements
        assert (torque.part, torque.what, torque.is_kept) == ("k", "torque", is_kept)
        assert torque.found == pytest.approx(sliding, rel=1e-9)
        assert (heat.what, heat.is_kept) == ("friction work", True)
        assert heat.found == pytest.approx(0.5 * 1.0 * 3.0 / 4.0 * 40.0**2, rel=1e-8)
        assert len(moved.findings) == (not is_kept)


def test_an_exceeded_limit_of_a_clutch_ends_the_command_with_one(tmp_path: Path) -> None:
    """The finding names the clutch, what it bears, and what is permitted."""
    file = tmp_path / "clutch.toml"
    file.write_text(ENGAGING.format(sliding=20.0).replace("650 J", "500 J"))
    ended = invoke("torsion", file)
    assert ended.exit_code == 1
    assert "k: friction work 600 J in the manoeuvre at 6 s, permitted 500 J: limit exceeded" in " ".join(
        ended.output.split()
    )


def test_a_locked_freewheel_is_judged_by_its_torque() -> None:
    """Two locked discs under 30 N m on the first one: the freewheel carries J₂/(J₁+J₂) of it."""
    text = ENGAGING.split("[train.clutches]")[0].format() + (
        '[train.freewheels]\nf = { between = ["a", "b"], torque_permitted = 20.0 }\n'
        "[train.transient]\nduration = 0.5\nspeeds = { a = 1.0, b = 1.0 }\n"
        '[[train.transient.events]]\nkind = "torque_course"\non = "a"\ntimes = [0, 1]\ntorque = [30, 30]\n'
    )
    (judgement,) = torsion_transient(lw.loads(text)).judgements
    assert judgement.found == pytest.approx(22.5, rel=1e-9)
    assert not judgement.is_kept


def test_lossy_gear_demo_2() -> None:
    """LossyGearDemo2: efficiency 0.5 and a bearing with 0.5 N m + 0.5 N m s ω on the first disc.

    Both friction parts stick together; what is left over the bounds of both decides about breaking away.
    """
    moved = torsion_transient(
        lw.loads(
            """
format = 1
name = "LossyGearDemo2"
[train.discs]
a = { inertia = 1.0 }
b = { inertia = 1.5 }
[train.gears]
gear = { between = ["a", "b"], ratio = 2.0, kind = "internal", efficiency = 0.5 }
[train.brakes]
bearing = { on = "a", slip = [0.0, 200.0], torque = [0.5, 100.5] }
[train.excitations]
sine = { on = "a", harmonics = [{ frequency = 1.0, torque = 10.0, phase = -1.5707963267948966 }] }
[train.transient]
duration = 0.5
sample_time = 1e-3
accuracy = 1e-12
[[train.transient.events]]
kind = "torque_course"
on = "b"
times = [0, 2]
torque = [-10, -5]
"""
        )
    )

    def drive(t: float) -> float:
        return 10 * np.sin(2 * np.pi * t)

    def load(t: float) -> float:
        return -10 + 2.5 * t

    def rate(sense: float, t: float, w: float) -> float:
        """With the torque T of the teeth at b: J_a ẇ = M − sense·D − g T/2, J_b ẇ/2 = T + load."""
        net = drive(t) - sense * (0.5 + 0.5 * abs(w))

        def by(g: float) -> tuple[float, float]:
            acceleration = (net + g * load(t) / 2) / (1 + g * 1.5 / 4)
            return acceleration, 1.5 * acceleration / 2 - load(t)

        # The teeth lose: what drives gives twice as much as arrives.
        drives, driven = (2.0, 0.5) if sense > 0 else (0.5, 2.0)
        acceleration, torque = by(drives)
        return acceleration if torque >= 0 else by(driven)[0]

    w, t, found, sticks = 0.0, 0.0, np.zeros(len(moved.time)), 0
    while t < 0.5:
        spare = {s: s * rate(s, t + 1e-12, 0.0) for s in (1.0, -1.0)}
        sense = next((s for s in spare if spare[s] > 0), 0.0)
        if sense:
            leg = solve_ivp(
                lambda t, y, sense: [rate(sense, t, y[0])], (t, 0.5), [w], "DOP853", rtol=1e-12, atol=1e-13,
                events=_stops, args=(sense,), dense_output=True, max_step=2e-3, first_step=1e-9,
            )  # fmt: skip
            inside = (moved.time >= t) & (moved.time <= leg.t[-1])
            found[inside] = leg.sol(moved.time[inside])[0]
            t, w = float(leg.t[-1]), 0.0
        else:
            sticks += 1
            t = min(_breaks_away(rate, 1.0, t), _breaks_away(rate, -1.0, t))
    assert sticks
    assert found.max() > 0 > found.min()
    assert moved.speed[0] == pytest.approx(found, abs=1e-7)
    assert abs(moved.energy_error) < 1e-9


def _stops(t: float, y: np.ndarray, sense: float) -> float:
    return sense * y[0]


_stops.terminal, _stops.direction = True, -1  # type: ignore[attr-defined]


def _breaks_away(rate: Callable[[float, float, float], float], sense: float, start: float) -> float:
    """When a stuck train starts to turn in a sense, by bisection; else 0.5 s."""
    times = np.linspace(start, 0.5, 2001)
    moving = [t for t in times if sense * rate(sense, t, 0.0) > 0]
    if not moving:
        return 0.5
    low, high = moving[0] - (times[1] - times[0]), moving[0]
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if sense * rate(sense, middle, 0.0) > 0 else (middle, high)
    return high
