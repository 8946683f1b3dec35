"""A force of a formula that rises and falls back within a small angle is not passed over."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from scipy.special import i0e
from sizes import cases

import linkwright as lw
from linkwright import ConvergenceError

FILE = """format = 1
name = "Press"
mechanism.cranks.A.radius = {radius}
mechanism.sliders.S = {{ crank = "A", rod = {rod} }}
bodies.S.mass = {mass}
[drive]
motor = {{ kind = "dc", speed_no_load = {speed}, torque_stall = {torque} }}
flywheel.inertia = {inertia}
[loads.friction]
kind = "formula"
on = "S"
force = "-{damping}*v"
[loads.pulse]
kind = "formula"
on = "S"
force = "{force}"
"""

# Over ξ, the distance from the place in widths.
SHAPES = {
    "Gauss": "{size}*exp(-({xi})^2)",
    "pair of tanh": "{size}*(tanh({xi}) - tanh({xi} - 3))",
    "power": "{size}/(1 + ({xi})^2)^4",
}


@dataclass(frozen=True)
class Press:
    """A crank drive with a pulse; its motion by SciPy, which is given the place of the pulse."""

    shape: str
    over: str
    seed: int
    wide: float

    @cached_property
    def numbers(self) -> dict[str, float]:
        draw = np.random.default_rng([self.seed, len(self.shape), ord(self.over[0])])
        radius = draw.uniform(0.1, 0.5)
        ranges = {"mass": (2, 40), "speed": (10, 80), "torque": (200, 1500), "inertia": (1, 10)}
        numbers = {"radius": radius, "rod": radius * draw.uniform(1.7, 5), "damping": 1 / radius**2}
        numbers |= {name: draw.uniform(*ends) for name, ends in ranges.items()}
        phi = draw.uniform(0.1, 6.1)
        s, ds, dds = self.way(phi, numbers)
        omega = 0.9 * numbers["speed"]
        at, per_radian = {"phi": (phi, 1.0), "x": (s, ds), "v": (ds * omega, dds * omega)}[self.over]
        size = draw.choice([-1, 1]) * draw.uniform(100, 1000)
        return numbers | {"place": at, "width": self.wide * abs(per_radian), "size": size}

    @property
    def machine(self) -> lw.Machine:
        numbers = {name: float(number) for name, number in self.numbers.items()}
        xi = f"({self.over} - ({numbers['place']!r}))/{numbers['width']!r}"
        return lw.loads(FILE.format(**numbers, force=SHAPES[self.shape].format(size=numbers["size"], xi=xi)))

    @staticmethod
    def way(phi: float, numbers: dict[str, float]) -> tuple[float, float, float]:
        """Way of the slider and its derivatives by φ."""
        r, rod, sin, cos = numbers["radius"], numbers["rod"], np.sin(phi), np.cos(phi)
        leg = np.sqrt(rod**2 - (r * sin) ** 2)
        d = -(r**2) * sin * cos / leg
        return r * cos + leg, -r * sin + d, -r * cos - (r**2 * (cos**2 - sin**2) + d**2) / leg

    def xi(self, phi: float, omega: float) -> float:
        s, ds, _ = self.way(phi, self.numbers)
        value = {"phi": phi, "x": s, "v": ds * omega}[self.over]
        return (value - self.numbers["place"]) / self.numbers["width"]

    def pulse(self, xi: float) -> float:
        shape = {
            "Gauss": lambda: np.exp(-xi * xi),
            "pair of tanh": lambda: np.tanh(xi) - np.tanh(xi - 3),
            "power": lambda: (1 + xi * xi) ** -4,
        }
        return float(self.numbers["size"] * shape[self.shape]())

    def rate(self, phi: float, y: np.ndarray) -> list[float]:
        """Derivatives of u = ½ω² and of the work against the loads, by φ."""
        n, omega = self.numbers, np.sqrt(2 * y[0])
        _, ds, dds = self.way(phi, n)
        force = -n["damping"] * ds * omega + self.pulse(self.xi(phi, omega))
        torque = n["torque"] * (1 - omega / n["speed"]) + force * ds
        mass = n["mass"]
        return [(torque - 2 * mass * ds * dds * y[0]) / (n["inertia"] + mass * ds**2), -force * ds]

    def ends(self, omega: np.ndarray, phi: np.ndarray) -> np.ndarray:
        """Angles that get closer to each other towards where the pulse is."""
        xi, found = self.xi(phi, omega), [np.linspace(0, 2 * np.pi, 25)]
        for level in (0.0, 3.0):
            for i in np.nonzero((xi[:-1] - level) * (xi[1:] - level) <= 0)[0]:
                slope = (xi[i + 1] - xi[i]) / (phi[1] - phi[0])
                off = 1.5 ** np.arange(-3, 40) / max(abs(slope), 2.0)
                at = phi[i] + (level - xi[i]) / slope
                found += [[at], at - off[off < 0.5], at + off[off < 0.5]]
        ends = np.unique(np.concatenate(found))
        ends = ends[(ends >= 0) & (ends <= 2 * np.pi)]
        return ends[np.append(np.diff(ends) > 1e-9, True)]

    def revolution(self, u: float, ends: np.ndarray) -> tuple[np.ndarray, float]:
        y, along = np.array([u, 0.0]), [u]
        for part in pairwise(ends):
            y = solve_ivp(self.rate, part, y, method="DOP853", rtol=1e-12, atol=1e-13 * u).y[:, -1]
            along.append(y[0])
        return np.array(along), float(y[1])

    def steady(self) -> tuple[float, float]:
        """Work against the loads and speed at φ = 0 of the motion that repeats."""
        phi = np.linspace(0, 2 * np.pi, 20_001)
        omega = np.full_like(phi, 0.9 * self.numbers["speed"])
        u = 0.5 * omega[0] ** 2
        for _ in range(12):
            ends = self.ends(omega, phi)
            along, work = self.revolution(u, ends)
            beside = self.revolution((1 + 1e-6) * u, ends)[0]
            growth = (beside[-1] - along[-1]) / (1e-6 * u)
            change = (along[-1] - u) / (1 - growth)
            omega = np.sqrt(2 * CubicSpline(ends, along)(phi))
            if abs(change) < 1e-12 * u:
                break
            u += change
        return work, float(np.sqrt(2 * u))


@pytest.mark.parametrize("wide", [1.3e-4, 1.1e-3, 7e-3, 0.04])
@pytest.mark.parametrize("over", ["phi", "x", "v"])
@pytest.mark.parametrize("shape", SHAPES)
def test_pulses_are_not_passed_over(shape: str, over: str, wide: float) -> None:
    press = Press(shape, over, seed=round(1e5 * wide), wide=wide)
    work, speed = press.steady()
    motion = lw.steady_state(press.machine, angles=[0.0])
    # Rounding of the speed limits what is reached where a pulse over it is very steep.
    promised = max(3e-9, motion.accuracy)
    assert promised < 1e-5
    assert motion.speed[0] == pytest.approx(speed, rel=promised)
    assert motion.energy_load == pytest.approx(work, rel=promised)
    rows = lw.steady_states(press.machine, {"bodies.S.mass": [float(press.numbers["mass"])] * 2})
    # A row is promised to 1e-7, or has no answer.
    if motion.accuracy < 1e-7:
        assert rows.energy_load == pytest.approx(work, rel=1e-7)
    else:
        assert np.all(np.isnan(rows.energy_load) | (np.abs(rows.energy_load / work - 1) < 1e-6))


@pytest.mark.parametrize("steep", [5, 200])
@pytest.mark.parametrize("wide", [0.003, 0.01, 0.03])
def test_both_flanks_of_a_plateau_are_seen(wide: float, steep: float) -> None:
    """Each flank alone would be seen; two in one step come back, wherever pieces of the search end."""
    text = _plain(force="{force}")
    edge = wide / steep
    with_flanks = f"-400*(tanh((v - 7 + {wide})/{edge}) - tanh((v - 7 - {wide})/{edge}))"
    smooth, sharp, none = (
        lw.steady_state(lw.loads(text.replace("{force}", force))).energy_load
        for force in (with_flanks, f"where(abs(v - 7) < {wide}, -800, 0)", "0*v")
    )
    # Flanks that are as wide on both sides of the same places leave the work to the square of their share.
    assert smooth - none == pytest.approx(sharp - none, rel=1e-3)


@pytest.mark.parametrize("wide", [2e-4, 3e-3])
@pytest.mark.parametrize("over", ["phi", "x"])
def test_a_motion_in_time_does_not_pass_over_pulses(over: str, wide: float) -> None:
    press = Press("Gauss", over, seed=7, wide=wide)
    start = 0.5 * press.numbers["speed"]
    phi, u = np.linspace(0, 2 * np.pi, 20_001), 0.5 * start**2
    for _ in range(3):
        u = press.revolution(u, press.ends(np.full_like(phi, start), phi))[0][-1]
    motion = lw.transient(press.machine, speed=start, turns=3.0)
    assert motion.speed[-1] == pytest.approx(np.sqrt(2 * u), rel=3e-8)


PLAIN = {"radius": 0.4, "rod": 1.1, "mass": 6, "speed": 60, "torque": 900, "inertia": 5, "damping": 10}


def _plain(force: str) -> str:
    return FILE.format(**PLAIN, force=force)


def _speed_in_time(force: Callable[[float, float, float], float], ends: list[float], longest: float) -> float:
    """Speed after 0.6 s from 20 rad/s with a force over time and speeds of slider and crank, by SciPy."""
    n = PLAIN

    def rate(t: float, y: np.ndarray) -> list[float]:
        _, ds, dds = Press.way(y[0], n)
        v, omega = ds * y[1], y[1]
        torque = n["torque"] * (1 - omega / n["speed"]) + (force(t, v, omega) - n["damping"] * v) * ds
        return [omega, (torque - n["mass"] * ds * dds * omega**2) / (n["inertia"] + n["mass"] * ds**2)]

    y = np.array([0.0, 20.0])
    for part in pairwise([0.0, *ends, 0.6]):
        y = solve_ivp(rate, part, y, method="DOP853", rtol=1e-11, atol=1e-12, max_step=longest).y[:, -1]
    return float(y[1])


@pytest.mark.parametrize("wide", [1e-4, 1e-3])
@pytest.mark.parametrize("accuracy", [1e-6, 1e-8])
def test_a_motion_in_time_does_not_pass_over_a_blow(wide: float, accuracy: float) -> None:
    ends = [0.3 + k * wide for k in (-8, -4, -1, 0, 1, 4, 8)]
    for text, force in (
        ("exp(-((t - 0.3)/{w})^2)", lambda t: np.exp(-(((t - 0.3) / wide) ** 2))),
        ("where(abs(t - 0.3) < {w}, 1, 0)", lambda t: float(abs(t - 0.3) < wide)),
        ("max(0, 1 - abs(t - 0.3)/{w})", lambda t: max(0.0, 1 - abs(t - 0.3) / wide)),
        ("step(t - 0.3)*step(0.3 + {w} - t)", lambda t: float(0.3 < t < 0.3 + wide)),
    ):
        machine = lw.loads(_plain("2e4*" + text.format(w=wide)))
        motion = lw.transient(machine, speed=20.0, duration=0.6, turns=1000.0, accuracy=accuracy)
        speed = _speed_in_time(lambda t, v, omega, force=force: 2e4 * force(t), ends, 0.01)
        assert motion.speed[-1] == pytest.approx(speed, rel=2 * accuracy)


@pytest.mark.parametrize(
    ("text", "force"),
    [
        ("exp(-((v - 7)/0.03)^2)", lambda t, v, omega: np.exp(-(((v - 7) / 0.03) ** 2))),
        ("where(abs(v - 7) < 0.03, 1, 0)", lambda t, v, omega: float(abs(v - 7) < 0.03)),
        ("where(abs(omega - 40) < 0.03, 0.5, 0)", lambda t, v, omega: 0.5 * (abs(omega - 40) < 0.03)),
        ("exp(-((omega - 40)/0.03)^2)", lambda t, v, omega: np.exp(-(((omega - 40) / 0.03) ** 2))),
    ],
)
def test_a_motion_in_time_does_not_pass_over_pulses_over_speeds(
    text: str, force: Callable[[float, float, float], float]
) -> None:
    motion = lw.transient(lw.loads(_plain("-800*" + text)), speed=20.0, duration=0.6, turns=1000.0)
    speed = _speed_in_time(lambda *now: -800 * force(*now), [], 5e-5)
    # SciPy's steps pass jumps by up to their length.
    assert motion.speed[-1] == pytest.approx(speed, rel=1e-7)


@pytest.mark.parametrize("force", ["-800*exp(-((v - 7)/0.03)^2)", "2e4*exp(-((t - 0.3)/1e-4)^2)"])
def test_a_clockwise_motion_meets_the_same_pulses(force: str) -> None:
    """The press is its own mirror image: its slider moves alike."""
    machine = lw.loads(_plain(force))
    forward, back = (
        lw.transient(machine, speed=speed, duration=0.6, turns=1000.0, clockwise=speed < 0).speed[-1]
        for speed in (20.0, -20.0)
    )
    assert back == pytest.approx(-forward, rel=1e-9)


def test_two_kinks_close_to_each_other_are_seen() -> None:
    """Between two angles of the scan for kinks the argument of the switch has the same sign at both."""
    text = _plain("{force}")
    for force, of_one in (
        ("where(abs(phi - 2) < 0.002, 500, 0)", 2.0),
        ("max(0, 1 - abs(phi - 2)/0.002)*500", 1.0),
    ):
        machine = lw.loads(text.replace("{force}", force))
        motion = lw.steady_state(machine)
        way = [Press.way(phi, {"radius": 0.4, "rod": 1.1})[0] for phi in (1.998, 2.002)]
        plain = lw.steady_state(lw.loads(text.replace("{force}", "0*v")))
        # The speed hardly changes: what the friction takes changes with its square.
        taken = plain.energy_load - motion.energy_load
        assert taken == pytest.approx(0.5 * of_one * 500 * (way[1] - way[0]), rel=0.1)


FAST_LINK = """format = 1
name = "Step-up gear"
mechanism.cranks.A.radius = 0.1
mechanism.points.O2.x = 0.5
mechanism.gears.W = {{ kind = "belt", pivot = "O2", meshes = "A", size = 1, size_other = {ratio} }}
[bodies]
A.inertia = 20
[drive]
motor = {{ kind = "dc", speed_no_load = 20, torque_stall = 3000 }}
[loads.pulse]
kind = "formula"
on = "W"
torque = "-1*exp(-(sin((psi - 1)/2)/0.002)^2)"
"""


@pytest.mark.parametrize("ratio", [24, 96, 100])
def test_a_link_that_goes_round_many_times_meets_its_pulse_each_time(ratio: int) -> None:
    """Where it turns as often as the revolution is looked at, it seems to stand still."""
    state = lw.steady_state(lw.loads(FAST_LINK.format(ratio=ratio)))
    # ∫ exp(−(sin(x/2)/w)²) dx = 2 w √π, but for w² of it, in each revolution of the link.
    work = ratio * 2 * 0.002 * np.sqrt(np.pi)
    assert abs(abs(state.energy_load) - work) < 1e-5 * work


# Of the work: the accuracy asked for is 1e-9, and rounding of the angle moves a pulse by 1e-9 of its width.
WORK = 1e-8


@pytest.mark.parametrize(("count", "wide"), [(100, 1e-3), (1200, 1e-4), (800, 1e-3)][: cases(2, 3)])
def test_more_pulses_than_a_revolution_can_have_are_refused_and_not_passed_over(
    count: int, wide: float
) -> None:
    """M exp(−(sin nφ/w)²) does the work 2π M e^(−x) I₀(x) with x = 1/(2w²)."""
    machine = lw.loads(
        'format = 1\nname = "pulses"\nmechanism.cranks.A.radius = 0.1\nbodies.A.mass = 1\n'
        "[drive.motor]\nkind = 'dc'\ntorque_stall = 400\nspeed_no_load = 30\ninertia = 1\n"
        f"[loads.f]\nkind = 'formula'\non = 'A'\ntorque = '-100*exp(-(sin({count}*phi + 0.1)/{wide})^2)'\n"
    )
    try:
        work = lw.steady_state(machine).energy_load
    except ConvergenceError:
        assert count > 100
    else:
        assert work == pytest.approx(100 * 2 * np.pi * i0e(0.5 / wide**2), rel=WORK)
