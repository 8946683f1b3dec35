"""Random drives over twelve decades of stiffness against SciPy on an equation of its own (`drive_by_hand`).

Stiffness is ∂ε/∂u, the slope of the motor's curve against the inertia [1/rad]: a disturbance of the speed
falls to 1/e within 1/stiffness. ``python tests/fuzz/stiff_drives.py --cases 1000`` compares measures and
curves of steady motions and run-ups, and prints how many, how far off, and what was refused.
"""

from __future__ import annotations

import argparse
import re
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from itertools import pairwise

import numpy as np
from broken import LONGEST, PromiseError, watched
from drive_by_hand import ByHand
from numpy.random import Generator
from numpy.typing import NDArray
from random_drives import Table, bodies, linkage, load
from random_parts import log_uniform
from scipy.integrate import solve_ivp
from sizes import generator

import linkwright as lw
from linkwright import FindingError, MachineError
from linkwright.drive import SteadyState, Transient

Floats = NDArray[np.float64]

# What every number and curve must keep, as a share of its peak.
WITHIN = 1e-6

# Stiffnesses [1/rad], as powers of ten.
STIFF = (-4.0, 8.0)

# Above this stiffness the reference is implicit.
_IMPLICIT = 30.0

# Relative tolerances of the reference, and the share of the peak acceleration that they count against: where
# the product is off by more than `WITHIN` of the first, the second tells who is.
_TOLERANCES = ((1e-9, 1.0), (1e-12, 1e-3))

# As the product says: accelerations count at least against these shares of ω², and of what the drive alone
# would give.
_EVEN, _BALANCED = 1e-4, 1e-6

# Rounding of a speed, which a steep motor makes torque of.
_ROUNDING = 4e-15

# Evaluations after which SciPy is taken for giving up: some seconds.
_EVALUATIONS = 50_000

# Accuracy of a run-up.
_RUN_UP = 1e-8

# Revolutions of a run-up that are compared.
_TURNS = 1.5


def stiff_drive(random: Generator) -> Table:
    """A drive that closes all round, of a stiffness drawn evenly over its decades."""
    mechanism, carriers, slides = linkage(random)
    r = mechanism["cranks"]["A"]["radius"]
    ratio, speed = float(random.choice([1.0, 3.0, 9.8, 40.0])), log_uniform(random, 1.0, 60.0)
    description: Table = {
        "format": 1,
        "name": "Stiff drive",
        "drive": {"motor": {"kind": "dc"}, "gearbox": {"ratio": ratio}},
        "mechanism": mechanism,
        "bodies": bodies(random, carriers),
        "loads": {},
    }
    drive = description["drive"]
    drive["gearbox"]["efficiency"] = float(random.choice([1.0, 0.9, 0.7]))
    if random.random() < 0.3:
        drive["gearbox"]["reverse"] = ("same", 1.2)[random.integers(2)]
    turning = inertia(description)
    if random.random() < 0.6:
        drive["motor"]["inertia"] = turning * log_uniform(random, 1e-3, 3.0) / ratio**2
    if random.random() < 0.3:
        drive["flywheel"] = {"inertia": turning * log_uniform(random, 0.1, 10.0)}
    energy = inertia(description) * speed**2
    rated = _set_motor(random, drive["motor"], 10 ** random.uniform(*STIFF) * energy / ratio, speed * ratio)
    size = rated * ratio * log_uniform(random, 0.01, 1.0) / r
    for k in range(random.integers(1, 4)):
        one = load(random, str(random.choice(slides)), r, size)
        if one["kind"] == "spring":
            one["stiffness"] = max(size * r, 0.3 * energy) * log_uniform(random, 1e-3, 1.0) / r**2
        description["loads"][f"l{k}"] = one
    weight = 9.81 * r * sum(body["mass"] for body in description["bodies"].values())
    if weight < max(rated * ratio, 0.1 * energy):
        description["loads"]["gravity"] = {"kind": "gravity"}
    return description


def inertia(description: Table) -> float:
    """Mean inertia at the crank [kg m²]."""
    machine = ByHand(description)
    return float(np.mean([machine.instant(phi).inertia.real for phi in np.linspace(0, 2 * np.pi, 24)]))


def _set_motor(random: Generator, motor: Table, slope: float, speed: float) -> float:
    """A motor of any kind whose torque falls as if by `slope` over its whole speed; what it is good for."""
    kind = str(random.choice(["dc", "induction", "table"]))
    motor["kind"] = kind
    if kind == "dc":
        motor |= {"speed_no_load": speed, "torque_stall": slope}
        return 0.5 * slope
    if kind == "table":
        motor["speed"] = [0.0, 0.4 * speed, 0.8 * speed, 1.2 * speed]
        motor["torque"] = [slope / 3 * share for share in (0.8, 1.0, 0.4, -0.8)]
        return 0.2 * slope
    slip = log_uniform(random, 0.005, 0.08)
    motor |= {"speed_synchronous": speed, "speed_rated": speed * (1 - slip), "torque_rated": slope * slip}
    motor["torque_breakdown"] = slope * slip * random.uniform(1.8, 3.5)
    return slope * slip


class GivesUpError(Exception):
    """SciPy takes too many evaluations."""


@dataclass
class Budget:
    """Evaluations that are left."""

    left: int = _EVALUATIONS

    def count(self) -> None:
        """One more evaluation; raises `GivesUpError` where these are too many."""
        self.left -= 1
        if self.left < 0:
            raise GivesUpError


@dataclass
class Reference:
    """One cycle by SciPy: at the ends of its steps crank angle, u = ω²/2, J ε, time; and its integrals."""

    phi: Floats
    u: Floats
    net: Floats
    time: Floats
    inertia: Floats
    drive: Floats
    load: Floats
    motor: Floats
    # Works of drive and loads, ∫M dt, ∫M² dt of the motor, and the logarithm of the growth.
    totals: Floats


def integrate(
    machine: ByHand, u: float, ends: list[float], stiff: float, peak: float, tolerance: tuple[float, float]
) -> Reference | None:
    """A cycle from u at φ = 0 on; None where SciPy gives up.

    With u goes N = J ε, by its own equation dN/dφ = ∂N/∂φ + ∂N/∂u N/J: where the motor is steep, the
    difference of its torque and that of the loads would have no digits left.
    """
    net, _, _, at = machine.net_with_slope(0.0, float(np.sqrt(2 * u)))
    scale = at.inertia.real * peak * tolerance[1]
    state = np.array([u, net, 0, 0, 0, 0, 0, 0])
    size = at.inertia.real * u

    evaluations = Budget()

    def slope(phi: float, y: Floats) -> list[float]:
        evaluations.count()
        omega = float(np.sqrt(2 * max(y[0], 1e-300)))
        _, by_angle, by_u, at = machine.net_with_slope(phi, omega)
        J = at.inertia.real
        load = machine.resisting(at, omega)[0].real
        drive = load + y[1] + 2 * at.half_slope.real * y[0]
        motor = drive / machine.ratio / machine.factors[int(drive < 0)]
        rates = [y[1] / J, by_angle + by_u * y[1] / J, 1 / omega]
        return [*rates, drive, load, motor / omega, motor**2 / omega, by_u / J]

    def jacobian(phi: float, y: Floats) -> Floats:
        omega = float(np.sqrt(2 * max(y[0], 1e-300)))
        _, _, by_u, at = machine.net_with_slope(phi, omega)
        found = np.zeros((8, 8))
        found[0, 1], found[1, 1], found[2, 0] = 1 / at.inertia.real, by_u / at.inertia.real, -1 / omega**3
        return found

    torque = scale + abs(machine.resisting(at, float(np.sqrt(2 * u)))[0].real)
    slow = 2 * np.pi / np.sqrt(2 * u)
    absolute = tolerance[0] * np.array(
        [u, scale, slow, torque + size, torque + size, torque * slow, torque**2 * slow, max(stiff, 1.0)]
    )
    method = "Radau" if stiff > _IMPLICIT else "DOP853"
    parts: list[Floats] = []
    options = {"jac": jacobian} if method == "Radau" else {}
    for low, high in pairwise(ends):
        with machine.keeping_senses(0.5 * (low + high)), np.errstate(all="ignore"):
            found = solve_ivp(
                slope, (low, high), state, method, rtol=tolerance[0], atol=absolute, max_step=0.1, **options
            )
        if not found.success:
            return None
        parts.append(np.vstack([found.t, found.y]))
        state = found.y[:, -1]
    return _reference(machine, np.hstack(parts), state[3:])


def _reference(machine: ByHand, table: Floats, totals: Floats) -> Reference:
    phi, order = np.unique(table[0], return_index=True)
    u, net, duration = table[1:4, order]
    at = [machine.instant(x) for x in phi.tolist()]
    load = np.array([machine.resisting(a, float(w))[0].real for a, w in zip(at, np.sqrt(2 * u), strict=True)])
    J = np.array([a.inertia.real for a in at])
    drive = load + net + 2 * np.array([a.half_slope.real for a in at]) * u
    motor = drive / machine.ratio / np.where(drive < 0, machine.factors[1], machine.factors[0])
    return Reference(phi, u, net, duration, J, drive, load, motor, totals)


def deviations(
    machine: lw.Machine, by_hand: ByHand, found: SteadyState, tolerance: tuple[float, float]
) -> dict[str, float]:
    """How far measures and curves are from the reference, as shares of their peaks."""
    stiff = stiffness(by_hand, found)
    extremes = [found.speed_min_angle, found.speed_max_angle]
    extremes += [found.acceleration_min_angle, found.acceleration_max_angle]
    inner = {x % (2 * np.pi) for x in [*extremes, *by_hand.dead_centres()]}
    ends = [0.0, *sorted(x for x in inner if 1e-9 < x < 2 * np.pi - 1e-9), 2 * np.pi]
    peak = max(abs(found.acceleration_min), abs(found.acceleration_max), _EVEN * found.speed_max**2)
    known = integrate(by_hand, 0.5 * float(found.speed[0]) ** 2, ends, stiff, peak, tolerance)
    if known is None:
        return {}
    curves = lw.steady_state(machine, angles=known.phi)
    return {**_curves(known, curves), **_measures(known, found, by_hand.ratio)}


def _curves(known: Reference, curves: SteadyState) -> dict[str, float]:
    omega, epsilon = np.sqrt(2 * known.u), known.net / known.inertia
    peak = _acceleration_scale(epsilon, omega, known.drive / known.inertia)
    torque = max(
        float(np.abs(known.drive).max()), float(np.abs(known.load).max()), peak * float(known.inertia.max())
    )
    return {
        "speed": float(np.abs(curves.speed / omega - 1).max()),
        "acceleration": float(np.abs(curves.acceleration - epsilon).max()) / peak,
        "time": float(np.abs(curves.time - known.time).max()) / float(known.time[-1]),
        "driving torque": float(np.abs(curves.torque_drive - known.drive).max()) / torque,
        "load torque": float(np.abs(curves.torque_load - known.load).max()) / torque,
        "extreme speeds": max(omega.max() / curves.speed_max - 1, 1 - omega.min() / curves.speed_min, 0.0)
        + _apart(omega.max(), curves.speed_max, omega.max())
        + _apart(omega.min(), curves.speed_min, omega.max()),
        "extreme accelerations": _apart(epsilon.max(), curves.acceleration_max, peak)
        + _apart(epsilon.min(), curves.acceleration_min, peak),
    }


def _acceleration_scale(epsilon: Floats, omega: Floats, driven: Floats) -> float:
    """Peak of accelerations, but at least shares of ω² and of what the drive alone would give."""
    even, balanced = _EVEN * float(omega.max()) ** 2, _BALANCED * float(np.abs(driven).max())
    return max(float(np.abs(epsilon).max()), even, balanced)


def _apart(a: float, b: float, size: float) -> float:
    return abs(float(a) - float(b)) / float(size)


def _measures(known: Reference, found: SteadyState, ratio: float) -> dict[str, float]:
    growth = float(np.exp(min(known.totals[4], 1.0)))
    # Of a drive that idles, rounding is all the torque that there is.
    least = _EVEN * float((known.inertia * 2 * known.u).max())
    work = np.trapezoid(np.abs(known.drive) + np.abs(known.load), known.phi)
    work = max(float(work), 2 * np.pi * least)
    period = float(known.time[-1])
    rms = max(float(np.sqrt(max(known.totals[3], 0.0) / period)), least / ratio)
    return {
        # How far the start is from that of the periodic motion.
        "closure": 0.5 * _apart(known.u[-1], known.u[0], known.u[0]) / max(1 - growth, 1e-3),
        "period": _apart(period, found.period, period),
        "work of the drive": _apart(known.totals[0], found.energy_drive, work),
        "work of the loads": _apart(known.totals[1], found.energy_load, work),
        "mean torque of the motor": _apart(known.totals[2] / period, found.torque_motor_mean, rms),
        "rms torque of the motor": _apart(np.sqrt(known.totals[3] / period), found.torque_motor_rms, rms),
        "multiplier": abs(growth - found.multiplier),
    }


def steepness(by_hand: ByHand, found: SteadyState) -> float:
    """Largest part of the drive in that [1/rad]."""
    pairs = zip(found.inertia_reduced.tolist(), found.speed.tolist(), strict=True)
    return max(abs(by_hand.drive_torque(omega)[1]) / (J * omega) for J, omega in pairs)


def stiffness(by_hand: ByHand, found: SteadyState) -> float:
    """Largest −∂ε/∂u of a motion [1/rad]."""
    pairs = zip(found.crank_angle.tolist(), found.speed.tolist(), strict=True)
    beside = [by_hand.net_with_slope(phi, omega) for phi, omega in pairs]
    return max(abs(steep) / at.inertia.real for _, _, steep, at in beside)


def rounded(by_hand: ByHand, found: SteadyState, stiff: float) -> float:
    """What the rounding of the speed makes of accelerations under a steep motor, as a share."""
    driven = (
        np.array([by_hand.drive_torque(omega)[0] for omega in found.speed.tolist()]) / found.inertia_reduced
    )
    extremes = np.array([found.acceleration_min, found.acceleration_max])
    peak = _acceleration_scale(extremes, found.speed, driven)
    return stiff * _ROUNDING * found.speed_max**2 / peak


@dataclass
class Figures:
    """What a campaign has found; drives so steep that rounding forbids `WITHIN` are by themselves."""

    worst: dict[str, tuple[float, int]] = field(default_factory=dict)
    decades: Counter[int] = field(default_factory=Counter)
    refused: Counter[str] = field(default_factory=Counter)
    compared: int = 0
    run_ups: int = 0
    off: list[str] = field(default_factory=list)
    unclear: list[str] = field(default_factory=list)

    def judge(
        self, seed: int, deviations: Callable[[tuple[float, float]], dict[str, float]], allowed: float
    ) -> None:
        """Take how far a drive is off the reference, which is made sharper where that is too much."""
        try:
            rough = fine = deviations(_TOLERANCES[0])
            if not all(error <= WITHIN for error in rough.values()):
                fine = deviations(_TOLERANCES[1])
        except GivesUpError:
            rough = fine = {}
        if not (rough and fine):
            self.unclear.append(f"{seed}: SciPy gave up")
        for name, error in fine.items():
            if not error <= allowed and error < 0.3 * rough.get(name, 0.0):
                # Where motions part, as on the way over a breakdown torque, the reference is not so exact.
                self.unclear.append(f"{seed}: {name} off by {error:.2g}, by {rough[name]:.2g} before")
                continue
            if not error <= allowed:
                self.off.append(f"{seed}: {name} off by {error:.2g}, {allowed:.2g} allowed")
            name = f"{name}, rounded" if allowed > 2 * WITHIN else name
            if not error <= self.worst.get(name, (0.0, 0))[0]:
                self.worst[name] = (error, seed)


def compare(random: Generator, figures: Figures, seed: int = 0) -> None:
    description = stiff_drive(random)
    inputs = {"machine": repr(description)}
    by_hand = ByHand(description)
    try:
        with watched(inputs, LONGEST):
            machine = lw.Machine.model_validate(description)
            found = lw.steady_state(machine, n=72)
    except FindingError as error:
        figures.refused[str(error).split(":")[0][:60]] += 1
        return
    except MachineError as error:
        # Torques and forces beyond what a file may hold belong to the stiffest of heavy machines.
        if not re.search(r"1e12 N( m)? in size", str(error)):
            raise
        figures.refused["a torque or a force beyond 1e12"] += 1
        return
    stiff = stiffness(by_hand, found)
    allowed = WITHIN + max(rounded(by_hand, found, stiff), 2 * found.accuracy)
    figures.compared += 1
    figures.decades[int(np.floor(np.log10(steepness(by_hand, found))))] += 1
    figures.judge(seed, partial(deviations, machine, by_hand, found), allowed)
    try:
        with watched(inputs, LONGEST):
            moved = lw.transient(machine, turns=_TURNS, accuracy=_RUN_UP)
    except FindingError as error:
        figures.refused["run-up: " + str(error).split(":")[0][:60]] += 1
        return
    if moved.came_to_rest:
        figures.refused["run-up: comes to rest or does not start"] += 1
        return
    figures.run_ups += 1
    figures.judge(seed, partial(_run_up_deviations, moved, by_hand, stiff), WITHIN)


def _run_up_deviations(
    moved: Transient, by_hand: ByHand, stiff: float, tolerance: tuple[float, float]
) -> dict[str, float]:

    evaluations = Budget()

    def slope(_t: float, y: Floats) -> list[float]:
        evaluations.count()
        left, _, at = by_hand.net(float(y[0]), float(y[1]))
        return [y[1], left.real / at.inertia.real]

    start = [float(moved.crank_angle[0]), float(moved.speed[0])]
    end, top = float(moved.time[-1]), float(np.abs(moved.speed).max())
    method = "Radau" if stiff > _IMPLICIT else "DOP853"
    with np.errstate(all="ignore"):
        sharp = tolerance[0]
        absolute = [sharp, sharp * top]
        known = solve_ivp(slope, (0.0, end), start, method, rtol=sharp, atol=absolute, max_step=end / 50)
    at = moved.at(known.t)
    # A speed at an instant is as exact as the time that has passed up to it.
    late = _RUN_UP * end * float(np.abs(moved.acceleration).max())
    return {
        "angle of the run-up": float(np.abs(at[0] - known.y[0]).max()) / (2 * np.pi),
        "speed of the run-up": float(np.abs(at[1] - known.y[1]).max()) / max(top, late / WITHIN),
    }


def stiff(random: Generator) -> None:
    """A case of `deep.py`: everything within what is promised."""
    figures = Figures()
    compare(random, figures)
    if figures.off:
        raise PromiseError("; ".join(figures.off), {})


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    parser.add_argument("--cases", type=int, default=1000, help="drives (default: 1000)")
    parser.add_argument("--start", type=int, default=0, help="first seed (default: 0)")
    given = parser.parse_args()
    figures, begun = Figures(), time.process_time()
    for seed in range(given.start, given.start + given.cases):
        try:
            compare(generator(1, seed), figures, seed)
        except PromiseError as broken:
            figures.off.append(f"{seed}: {broken.what}")
    print(
        f"{given.cases} drives, {figures.compared} steady motions and {figures.run_ups} run-ups compared, ",
        end="",
    )
    print(f"{time.process_time() - begun:.0f} s")
    print(
        "steepness of the drive [1/rad]: "
        + ", ".join(f"1e{k} {n}" for k, n in sorted(figures.decades.items()))
    )
    for name, (error, seed) in sorted(figures.worst.items()):
        print(f"{name:28} {error:9.2g}   drive {seed}")
    print("\n".join(f"{count:5} refused: {why}" for why, count in figures.refused.most_common()))
    print(f"{len(figures.off)} off: " + "; ".join(figures.off))
    print(f"{len(figures.unclear)} not told by the reference: " + "; ".join(figures.unclear))


if __name__ == "__main__":
    main()
