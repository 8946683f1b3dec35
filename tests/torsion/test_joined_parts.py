"""Trains with clutch, brake, freewheel, lossy stage, backlash, joint, pendulum, controller, planetary stage.

The equations are written here with the angles of the parts themselves: the pendulum as a point mass by
Lagrange, the planetary stage by Willis, friction of the teeth as a brake whose capacity grows with their
torque. SciPy integrates from event to event, in those states that agree.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import product
from typing import Any

import numpy as np
import pytest
from tests.samples.sizes import cases
from tests.torsion.friction_reference import STUCK, Element, Reference

import linkwright as lw
from linkwright import torsion_transient
from linkwright.kernel.arrays import Floats


@dataclass
class Stage:
    """Gears with friction of the teeth: masses, ratio, η, η′; torque of an elastic mesh, None if rigid."""

    ends: tuple[int, int]
    ratio: float
    forward: float
    reverse: float
    teeth: Callable[[Floats, Floats], float] | None = None


@dataclass
class Joined(Reference):
    """J(q) ω′ = M − B T − C λ: elements first, then the friction of each stage at its first mass."""

    stages: Sequence[Stage] = ()
    mass: Callable[[Floats], Floats] = field(default=np.diag)
    known: Floats = field(default_factory=lambda: np.zeros(0))

    def __post_init__(self) -> None:
        self.own = len(self.elements)
        friction = [Element((stage.ends[0], -1), lambda _: 0.0, 0.0, 0.0) for stage in self.stages]
        self.elements = [*self.elements, *friction]
        super().__post_init__()

    def factor(self, stage: Stage, torque: float, sense: float) -> float:
        return 1 / stage.forward if torque * sense > 0 else stage.reverse

    def motion(self, t: float, y: Floats, states: Sequence[int]) -> tuple[Floats, Floats]:
        """With directions of power in rigid stages that agree with their torques."""
        rigid = [k for k, stage in enumerate(self.stages) if stage.teeth is None]
        n = len(self.inertia)
        J, net = self.mass(y[:n]), self.torque(t, y[:n], y[n:])
        best: tuple[float, Floats, Floats, Floats] | None = None
        for signs in product((1.0, -1.0), repeat=len(rigid)):
            a, T, teeth = self.solved(t, y, states, (J, net), dict(zip(rigid, signs, strict=True)))
            wrong = max((-sign * teeth[k] for k, sign in zip(rigid, signs, strict=True)), default=0.0)
            if best is None or wrong < best[0]:
                best = (wrong, a, T, teeth)
        assert best is not None
        self.known = best[3]
        return best[1], best[2]

    def solved(
        self, t: float, y: Floats, states: Sequence[int], left: tuple[Floats, Floats], signs: dict[int, float]
    ) -> tuple[Floats, Floats, Floats]:
        n, m, r = len(self.inertia), len(self.elements), len(self.stages)
        slip = self.B.T @ y[n:]
        A, b = np.zeros((n + m + r, n + m + r)), np.zeros(n + m + r)
        A[:n, :n], b[:n] = left
        A[:n, n : n + m] = self.B
        for e, (element, state) in enumerate(zip(self.elements, states, strict=True)):
            row = n + e
            if state == STUCK:
                A[row, :n] = self.B[:, e]
                continue
            A[row, row] = 1.0
            if e < self.own:
                b[row] = state * element.engaged(t) * element.sliding(max(state * slip[e], 0.0))
            else:
                # What friction adds at the first mass: (g − 1) T.
                k = e - self.own
                stage = self.stages[k]
                torque = signs[k] if stage.teeth is None else stage.teeth(y[:n], y[n:])
                A[row, n + m + k] = 1 - self.factor(stage, torque, state)
        for k, stage in enumerate(self.stages):
            (i, j), row = stage.ends, n + m + k
            A[i, row], A[j, row] = 1.0, -stage.ratio
            if stage.teeth is None:
                A[row, i], A[row, j] = 1.0, -stage.ratio
            else:
                A[row, row], b[row] = 1.0, stage.teeth(y[:n], y[n:])
        found = np.linalg.solve(A, b)
        return found[:n], found[n : n + m], found[n + m :]

    def bounds(self, e: int, t: float, torques: Floats) -> tuple[float, float]:
        if e < self.own:
            return super().bounds(e, t, torques)
        stage, T = self.stages[e - self.own], float(self.known[e - self.own])
        low, high = sorted((T / stage.forward - T, stage.reverse * T - T))
        return low, high


R, LENGTH, BOB = 0.1, 0.03, 0.5
TEETH = (24, 84)


@dataclass
class RandomTrain:
    """A chain of masses: a connection of each kind in random order, a planetary stage at the end."""

    entries: dict[str, Any]
    reference: Joined
    names: list[str]


def random_train(seed: int) -> RandomTrain:
    """A train of a seed; some turn slowly and are turned back."""
    random = np.random.default_rng(seed)

    def size(low: float, high: float) -> float:
        return float(np.exp(random.uniform(np.log(low), np.log(high))))

    kinds = ["clutch", "freewheel", "lossy", "backlash", "joint", "shaft"]
    random.shuffle(kinds)
    n = len(kinds) + 1
    names = [*(f"d{i}" for i in range(n)), "carrier", "ring", "stage_planet_1", "bob", "control"]
    sun, carrier, ring, planet, bob, control = n - 1, n, n + 1, n + 2, n + 3, n + 4
    J = np.array([*(size(0.05, 0.5) for _ in range(n)), 1.0, 0.3, 0.002, BOB * LENGTH**2, 1.0])
    entries: dict[str, Any] = {name: {} for name in ("clutches", "freewheels", "gears", "shafts")}
    springs: list[Callable[[Floats, Floats, Floats], None]] = []
    elements: list[Element] = []
    stages: list[Stage] = []
    scale = [1.0]  # speed of each mass of the chain over that of the motor

    def spring(i: int, j: int, ratio: float, torque: Callable[[float, float], float]) -> None:
        def push(phi: Floats, w: Floats, net: Floats) -> None:
            T = torque(phi[i] - ratio * phi[j], w[i] - ratio * w[j])
            net[i] -= T
            net[j] += ratio * T

        springs.append(push)

    for i, kind in enumerate(kinds):
        pair, ratio = [names[i], names[i + 1]], 1.0
        if kind == "clutch":
            sliding, static = size(20, 60), float(random.choice([1.0, 1.2]))
            closed = bool(random.integers(2))
            static *= sliding
            on = 0.0 if closed else 0.015
            elements.append(
                Element(
                    (i, i + 1),
                    lambda _, T=sliding: T,
                    -static,
                    static,
                    lambda t, on=on: float(t > on or not on),
                )
            )
            entries["clutches"]["clutch"] = {
                "between": pair,
                "sliding": sliding,
                "static": static,
                "closed": closed,
            }
        elif kind == "freewheel":
            drag = size(0.1, 2)
            elements.append(Element((i, i + 1), lambda _, T=drag: T, -drag, np.inf))
            entries["freewheels"]["freewheel"] = {"between": pair, "drag": drag}
        elif kind in ("lossy", "backlash"):
            ratio, eta = size(0.5, 2.5), float(random.uniform(0.7, 0.98))
            back = float(random.choice([0.0, 0.5, 0.9]))
            gear: dict[str, Any] = {"between": pair, "ratio": ratio, "kind": "internal"}
            gear |= {"efficiency": eta, "efficiency_reverse": back} if kind == "lossy" else {}
            elastic = kind == "backlash" or bool(random.integers(2))
            k, c = size(3e3, 3e4), size(0.5, 5)
            gap = size(1e-3, 1e-2) if kind == "backlash" else 0.0
            if elastic:
                gear |= {"stiffness": k, "damping": c} | ({"backlash": gap} if gap else {})

            def mesh(twist: float, rate: float, k: float = k, c: float = c, half: float = gap / 2) -> float:
                spring = k * (twist - math.copysign(min(abs(twist), half), twist))
                # The damper acts in contact and never pulls.
                return spring + max(-abs(spring), min(abs(spring), c * rate)) if half else spring + c * rate

            def teeth(
                phi: Floats, w: Floats, i: int = i, n: float = ratio, mesh: Callable[..., float] = mesh
            ) -> float:
                return mesh(phi[i] - n * phi[i + 1], w[i] - n * w[i + 1])

            if kind == "lossy":
                stages.append(Stage((i, i + 1), ratio, eta, back, teeth if elastic else None))
            else:
                spring(i, i + 1, ratio, mesh)
            entries["gears"][kind] = gear
        else:
            k, c = size(2e3, 2e4), size(0.2, 3)
            shaft: dict[str, Any] = {"between": pair, "stiffness": k, "damping": c}
            if kind == "joint":
                alpha, beta = float(random.uniform(0.1, 0.5)), float(random.uniform(0, 3))
                shaft |= {"joint_angle": alpha, "joint_phase": beta}

                def behind(
                    phi: Floats,
                    w: Floats,
                    net: Floats,
                    i: int = i,
                    k: float = k,
                    c: float = c,
                    alpha: float = alpha,
                    beta: float = beta,
                ) -> None:
                    angle = phi[i] + beta
                    psi = math.atan2(math.sin(angle), math.cos(angle) * math.cos(alpha))
                    psi += 2 * math.pi * round((angle - psi) / (2 * math.pi))
                    slope = math.cos(alpha) / (1 - (math.sin(alpha) * math.cos(angle)) ** 2)
                    T = k * (psi - beta - phi[i + 1]) + c * (slope * w[i] - w[i + 1])
                    net[i] -= slope * T
                    net[i + 1] += T

                springs.append(behind)
            else:
                spring(i, i + 1, 1.0, lambda twist, rate, k=k, c=c: k * twist + c * rate)
            entries["shafts"][kind] = shaft
        scale.append(scale[-1] / ratio)
    # Planetary stage: sun with the last mass, ring on its seat, load on the carrier.
    of_planet, k_sun, k_ring, k_seat, c_seat = 30, size(1e4, 1e5), size(1e5, 5e5), size(1e5, 5e5), 20.0
    entries["planetaries"] = {
        "stage": {
            "sun": names[sun],
            "ring": "ring",
            "carrier": "carrier",
            "teeth": TEETH,
            "planets": 1,
            "planet_inertia": float(J[planet]),
            "sun_stiffness": k_sun,
            "ring_stiffness": k_ring,
        }
    }
    entries["shafts"]["seat"] = {"between": ["ring", "ground"], "stiffness": k_seat, "damping": c_seat}
    host, braked, speed = int(random.integers(n)), int(random.integers(n)), float(random.choice([60.0, 4.0]))
    swing_damping, brake = 0.01, size(10, 40)
    elements.append(Element((braked, -1), lambda _: brake, -brake, brake, lambda t: float(0.04 < t <= 0.1)))
    entries["brakes"] = {"brake": {"on": names[braked], "sliding": brake, "closed": False}}
    entries["pendulums"] = {
        "bob": {"on": names[host], "mass": BOB, "radius": R, "length": LENGTH, "damping": swing_damping}
    }
    load = size(20, 150)
    entries["loads"] = {"load": {"on": "carrier", "torque": load, "speed": 20.0, "exponent": 1.0}}
    gain, integral, most = size(1, 5), size(5, 30), 200.0
    entries["drivers"] = {
        "motor": {
            "on": names[0],
            "control": {"proportional": gain, "integral": integral, "torque_max": most, "speed": speed},
        }
    }
    entries["discs"] = {
        name: {"inertia": float(value)}
        for name, value in zip(names, J, strict=True)
        if name not in names[planet:]
    }
    shock = -size(100, 500)

    def mass(phi: Floats) -> Floats:
        M = np.diag(J)
        M[host, host] += BOB * R**2
        M[host, bob] = M[bob, host] = BOB * R * LENGTH * math.cos(phi[bob] - phi[host])
        return M

    def torque(t: float, phi: Floats, w: Floats) -> Floats:
        net = np.zeros(len(J))
        for push in springs:
            push(phi, w, net)
        for wheel, teeth, sign, k in ((sun, TEETH[0], 1, k_sun), (ring, TEETH[1], -1, k_ring)):
            share = sign * of_planet / teeth
            T = k * (phi[wheel] - phi[carrier] + share * (phi[planet] - phi[carrier]))
            net[wheel] -= T
            net[planet] -= share * T
            net[carrier] += (1 + share) * T
        net[ring] -= k_seat * phi[ring] + c_seat * w[ring]
        both = BOB * R * LENGTH * math.sin(phi[bob] - phi[host])
        drag = swing_damping * (LENGTH / (R + LENGTH)) ** 2 * (w[bob] - w[host])
        net[host] += both * w[bob] ** 2 + drag
        net[bob] -= both * w[host] ** 2 + drag
        net[carrier] -= load * w[carrier] / 20.0
        error = speed - w[0]
        wanted = gain * (error + w[control])
        given = min(max(wanted, -most), most)
        net[0] += given + (shock if 0.02 < t <= 0.08 else 0.0)
        net[control] += (error + (given - wanted) / gain) * integral / gain
        return net

    start = speed / 2
    entries["transient"] = {
        "duration": 0.12,
        "speed": start,
        "settle": 0.0,
        "loaded": False,
        "balanced": False,
        "accuracy": 1e-10,
        "sample_time": 5e-4,
        "events": [
            {"kind": "torque", "on": names[0], "torque": shock, "time": 0.02, "until": 0.08},
            {"kind": "brake_on", "brake": "brake", "time": 0.04},
            {"kind": "brake_off", "brake": "brake", "time": 0.1},
        ],
    }
    if not entries["clutches"]["clutch"]["closed"]:
        entries["transient"]["events"].append({"kind": "clutch_on", "clutch": "clutch", "time": 0.015})
    reference = Joined(J, torque, elements, stages=stages, mass=mass)
    return RandomTrain(entries, reference, names)


# Times at which something switches.
MARKS = [0.015, 0.02, 0.04, 0.08, 0.1]

# The planet turns against the sun; results have no sense.
SENSE = {"stage_planet_1": -1}


@pytest.mark.parametrize("seed", range(4, 4 + cases(1, 40)))
def test_random_trains_with_all_parts(seed: int) -> None:
    """Random trains with all parts move as SciPy has it from event to event; energy balances to 1e-9."""
    train = random_train(seed)
    moved = torsion_transient(
        lw.Machine.model_validate({"format": 1, "name": "joined", "train": train.entries})
    )
    assert abs(moved.energy_error) < 1e-9
    rows = [moved.discs.index(name) for name in train.names if name in moved.discs]
    n = len(train.names)
    host = train.entries["pendulums"]["bob"]["on"]
    at = moved.discs.index(host)
    start = np.zeros(2 * n)
    for half, state in ((0, moved.angle), (n, moved.speed)):
        for k, name in enumerate(train.names[:-1]):
            start[half + k] = SENSE.get(name, 1) * state[at if name == "bob" else moved.discs.index(name), 0]
    found, events = train.reference.follow(start, MARKS, moved.time)
    off = max(
        float(np.abs(moved.speed[moved.discs.index(name)] - SENSE.get(name, 1) * found[n + k]).max())
        for k, name in enumerate(train.names)
        if name in moved.discs and name != "bob"
    )
    assert off < 1e-6 * np.abs(moved.speed[rows]).max(), off
    assert moved.swing[0] == pytest.approx(
        found[train.names.index("bob")] - found[train.names.index(host)], abs=1e-6
    )
    assert events


def test_a_clutch_before_a_stage_that_loses_power() -> None:
    """Under a ramp of torque a stage leaves rest at M = T/η, and the clutch slips where M − Ja exceeds it."""
    ramp, capacity, load, eta, ratio = 20.0, 10.0, 4.0, 0.8, 2.0
    Ja, Jb, Jc = 1.0, 0.5, 2.0
    moved = torsion_transient(
        lw.Machine.model_validate(
            {
                "format": 1,
                "name": "clutch and stage",
                "train": {
                    "discs": {"a": {"inertia": Ja}, "b": {"inertia": Jb}, "c": {"inertia": Jc}},
                    "clutches": {"clutch": {"between": ["a", "b"], "sliding": capacity}},
                    "gears": {
                        "stage": {
                            "between": ["b", "c"],
                            "ratio": ratio,
                            "efficiency": eta,
                            "efficiency_reverse": 0.0,
                        }
                    },
                    "transient": {
                        "duration": 1.5,
                        "sample_time": 1e-3,
                        "events": [
                            {"kind": "torque_course", "on": "a", "times": [0, 2], "torque": [0, 2 * ramp]},
                            {"kind": "torque", "on": "c", "torque": -load, "time": 0.0},
                        ],
                    },
                },
            }
        )
    )
    needed, behind = load / ratio / eta, Jb + Jc / (ratio**2 * eta)
    starts = needed / ramp
    # M − Ja (M − needed)/(Ja + behind) = capacity
    slips = (capacity * (Ja + behind) - Ja * needed) / behind / ramp
    together = np.clip(moved.time, starts, slips)
    common = 0.5 * ramp * (together - starts) ** 2 / (Ja + behind)
    beyond = np.maximum(moved.time - slips, 0.0)
    a = common + 0.5 * ramp * beyond**2 + (ramp * slips - capacity) / Ja * beyond
    b = common + (capacity - needed) / behind * beyond
    assert moved.speed == pytest.approx(np.array([a, b, b / ratio]), abs=1e-8)
    assert moved.stuck_time[0] == pytest.approx(slips, abs=1e-9)
    assert moved.slip_time[0] == pytest.approx(1.5 - slips, abs=1e-9)
    assert moved.friction_heat[0] == pytest.approx(capacity * np.trapezoid(a - b, moved.time), rel=1e-5)
    assert abs(moved.energy_error) < 1e-9


@pytest.mark.parametrize("method", ["explicit", "implicit"])
@pytest.mark.parametrize("capacity", [0.05, 2.0, 50.0])
def test_a_worm_held_by_brake_and_teeth_stands(capacity: float, method: str) -> None:
    """A load on a locked stage stands whatever the brake beside it carries, and stands again after a pull."""
    pull = {"kind": "torque", "on": "worm", "torque": 12.0, "time": 0.3, "until": 0.4}
    load = {"kind": "torque", "on": "wheel", "torque": -30.0, "time": 0.0}
    stage = {"between": ["worm", "wheel"], "ratio": 10.0, "efficiency": 0.4, "efficiency_reverse": 0.0}
    moved = torsion_transient(
        lw.Machine.model_validate(
            {
                "format": 1,
                "name": "worm",
                "train": {
                    "discs": {"worm": {"inertia": 0.1}, "wheel": {"inertia": 2.0}},
                    "gears": {"stage": stage},
                    "brakes": {
                        "bearing": {"on": "worm", "sliding": capacity},
                        "guide": {"on": "wheel", "sliding": 5.0},
                    },
                    "transient": {
                        "duration": 1.0,
                        "sample_time": 1e-2,
                        "events": [load, pull],
                        "method": method,
                    },
                },
            }
        )
    )
    stands = (moved.time <= 0.3) | (moved.time > 0.8)
    assert np.abs(moved.speed[:, stands]).max() < 1e-12
    # The pull overcomes (30 + 5)/(10 · 0.4) = 8.75 N m and the weaker brakes.
    assert (np.abs(moved.speed).max() > 0.1) == (capacity < 12.0 - 8.75)
    assert abs(moved.energy_error) < 1e-9


def test_a_brake_stops_the_ring_of_a_planetary_stage() -> None:
    """Braked slowly, the ring comes to rest and stays; sun and carrier then turn by Willis, 1 + 84/24."""
    stage = {"sun": "sun", "ring": "ring", "carrier": "carrier", "teeth": TEETH, "planet_inertia": 0.002}
    moved = torsion_transient(
        lw.Machine.model_validate(
            {
                "format": 1,
                "name": "ring brake",
                "train": {
                    "discs": {"sun": {"inertia": 0.1}, "ring": {"inertia": 0.2}, "carrier": {"inertia": 0.5}},
                    "planetaries": {
                        "stage": {
                            **stage,
                            "sun_stiffness": 4e4,
                            "ring_stiffness": 4e5,
                            "loss_factor": 0.05,
                            "carrier_speed": 0.25,
                        }
                    },
                    "brakes": {
                        "brake": {
                            "on": "ring",
                            "sliding": 30.0,
                            "times": [0.0, 0.1, 0.3],
                            "engagement": [0, 0, 1],
                        }
                    },
                    "transient": {
                        "duration": 0.5,
                        "sample_time": 1e-4,
                        "accuracy": 1e-10,
                        "events": [{"kind": "torque", "on": "sun", "torque": 6.0, "time": 0.0}],
                    },
                },
            }
        )
    )
    place = moved.discs.index
    late = moved.time > 0.4
    assert moved.engagements[0] >= 1
    assert np.abs(moved.speed[place("ring"), late]).max() < 1e-9
    sun, carrier = (moved.speed[place(name), late].mean() for name in ("sun", "carrier"))
    assert sun / carrier == pytest.approx(1 + 84 / 24, rel=1e-3)
    assert abs(moved.energy_error) < 1e-9
