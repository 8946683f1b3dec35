r"""Steady motions of an elastic driveline over a number of its file, through folds.

A branch of periodic motions y(λ) is followed by pseudo-arclength [1]_: where the parameter λ turns back, in a
fold, the branch goes on, and the motions between two folds coexist with others. Floquet multipliers on the
way tell what becomes of a motion: one passes 1 in a fold, −1 where its period doubles, a pair the unit circle
at a Neimark–Sacker point, from which on it is modulated [2]_.

References
----------
.. [1] Keller, Numerical solution of bifurcation and nonlinear eigenvalue problems, in Applications of
   Bifurcation Theory, Academic Press 1977, 359-384.
.. [2] Kuznetsov, Elements of Applied Bifurcation Theory, 3rd ed. 2004, chapters 4 and 5.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from linkwright.driveline.chain import Chain, Driven, listed
from linkwright.driveline.coexisting import is_same
from linkwright.driveline.solving import multipliers_of, ready, search, solved
from linkwright.kernel.arrays import Bools, Complexes, Floats
from linkwright.kernel.errors import ConvergenceError, InputError, SteadyStateError
from linkwright.kernel.public import public
from linkwright.machine.address import replace
from linkwright.machine.machine import Machine
from linkwright.machine.program.core import DrivelineMotion

Kind = Literal["fold", "period doubling", "Neimark–Sacker"]

# Machines through which all numbers are polynomials of the parameter, and what these may err by.
_NODES = (5, 9, 17, 33)
_ERROR = 1e-11

# Ratio of both ends of a range from which on its logarithm is the parameter.
_WIDE = 4.0

# Motions of a branch at most.
_POINTS = 600


@dataclass(frozen=True)
class SpecialPoint:
    """Where motions of a branch change their stability.

    Attributes
    ----------
    kind : str
        Fold, period doubling or Neimark–Sacker.
    parameter : float
        Where it is: of a fold solved for, of others interpolated between two motions.
    """

    kind: Kind
    parameter: float


@dataclass(frozen=True)
class ElasticBranch:
    """A branch of steady motions.

    Attributes
    ----------
    parameter : ndarray, shape (n,)
        Values of the entry, in the order of the branch.
    torque_min, torque_max : ndarray, shape (shafts, n)
        Extremes of the torques of the shafts at their own speed [N m].
    speed_mean, speed_min, speed_max : ndarray, shape (n,)
        Of the crank [rad/s].
    multiplier_max : ndarray, shape (n,)
        Magnitude of the largest Floquet multiplier.
    start : ndarray, shape (n, states)
        Twist and speed of every mass but the crank against it, and speed of the crank, at the start of the
        cycle, referred to the crank.
    special : tuple of SpecialPoint
        Folds, period doublings and Neimark–Sacker points.
    end : str
        Why it ends: at the end of the range, after 600 motions, or as steps became too short.
    """

    parameter: Floats
    torque_min: Floats
    torque_max: Floats
    speed_mean: Floats
    speed_min: Floats
    speed_max: Floats
    multiplier_max: Floats
    start: Floats
    special: tuple[SpecialPoint, ...]
    end: str

    @property
    def torque_peak(self) -> Floats:
        """Peak absolute torques of the shafts, (shafts, n) [N m]."""
        return np.maximum(np.abs(self.torque_min), np.abs(self.torque_max))

    @property
    def is_stable(self) -> Bools:
        """Where small disturbances decay, (n,)."""
        stable: Bools = self.multiplier_max < 1
        return stable

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers and texts, ready for JSON."""
        curves = ("torque_min", "torque_max", "speed_mean", "speed_min", "speed_max", "multiplier_max")
        return {
            "parameter": self.parameter.tolist(),
            **{name: getattr(self, name).tolist() for name in curves},
            "is_stable": self.is_stable.tolist(),
            "special": [{"kind": point.kind, "parameter": point.parameter} for point in self.special],
            "end": self.end,
        }


@dataclass(frozen=True)
class ElasticBranches:
    """Branches of steady motions over an entry of the file.

    Attributes
    ----------
    address : str
        The entry.
    shafts : tuple of str
        What twists.
    branches : tuple of ElasticBranch
        That from the first end of the range, then that from the other, where it is another.
    """

    address: str
    shafts: tuple[str, ...]
    branches: tuple[ElasticBranch, ...]

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers and texts, ready for JSON."""
        return {
            "address": self.address,
            "shafts": list(self.shafts),
            "branches": [branch.to_dict() for branch in self.branches],
        }


@public
def elastic_branches(
    machine: Machine, address: str, first: float, last: float, *, accuracy: float = 1e-8
) -> ElasticBranches:
    """Follow the steady motion of an elastic driveline over a number of its file.

    Parameters
    ----------
    machine : Machine
        With a mechanism, a motor, and a [drive] of which something twists.
    address : str
        The number, such as ``"drive.crankshaft.stiffness"`` or ``"drive.motor.speed"``.
    first, last : float
        Ends of its range, in SI.
    accuracy : float
        Relative accuracy of speeds and twists of every motion.

    Returns
    -------
    ElasticBranches
        The branch of the motion at the first end, through folds, to an end of the range; and that of the
        motion at the other end, where it is another.

    Raises
    ------
    InputError
        The ends are equal, or numbers of the machine are no smooth functions of the entry.
    ConvergenceError
        No periodic motion was found at an end.
    """
    if not (np.isfinite([first, last]).all() and first != last):
        raise InputError(f"range: found {first:g} to {last:g}, expected two different finite numbers")
    family = _Family(machine, address, first, last)
    branches: list[ElasticBranch] = []
    ends: list[DrivelineMotion] = []
    refused: list[Exception] = []
    for place, direction in ((0.0, 1.0), (1.0, -1.0)):
        try:
            motion, driven = family.motion(place, accuracy)
        except (ConvergenceError, SteadyStateError) as none:
            # At one end there may be no motion of one cycle, as behind period doublings.
            refused.append(none)
            continue
        if any(is_same(motion, end) for end in ends):
            continue
        chain = driven.chain
        points, why = driven.compiled.driveline_branch(
            nodes=family.nodes,
            machines=family.machines,
            accuracy=accuracy,
            fastest=search(driven, 0)["fastest"],
            parameter=place,
            start=motion,
            direction=direction,
            points_max=_POINTS,
        )
        if len(points) < 2:
            raise ConvergenceError(
                f"no branch of steady motions starts at {address} = {family.value(place):g}",
                method="pseudo-arclength",
                iterations=len(points),
            )
        ends.append(points[-1][2])
        branches.append(_branch(points, why, chain, family))
    if not branches:
        raise refused[0]
    return ElasticBranches(address, chain.shafts, tuple(branches))


class _Family:
    """Machines over a parameter from 0 to 1, of which the entry is a function."""

    def __init__(self, machine: Machine, address: str, first: float, last: float) -> None:
        self._machine, self._address = machine, address
        self._ends = (first, last)
        wide = min(first, last) > 0 and max(first, last) > _WIDE * min(first, last)
        self._is_wide = wide
        for count in _NODES:
            # Chebyshev's places, with both ends.
            places = 0.5 - 0.5 * np.cos(np.pi * np.arange(count) / (count - 1))
            self.nodes = places.tolist()
            machines = [self._numbers(place) for place in places]
            if self._error(places, machines) <= _ERROR:
                self.machines = [(q, chain.core) for q, chain in machines]
                return
        raise InputError(
            f"{address}: the numbers of the machine are no smooth functions of it from {first:g} to "
            f"{last:g}; choose a smaller range"
        )

    def value(self, place: float) -> float:
        """The entry at a place of the range."""
        first, last = self._ends
        if self._is_wide:
            return float(first * (last / first) ** place)
        return float(first + place * (last - first))

    @property
    def cycle(self) -> float:
        """Angle of a cycle [rad]."""
        return self._at(0.0).compiled.cycle

    def motion(self, place: float, accuracy: float) -> tuple[DrivelineMotion, Driven]:
        """Steady motion at a place."""
        driven = self._at(place)
        motion = solved(driven, accuracy)[0]
        if motion.multiple > 1:
            raise ConvergenceError(
                f"at {self._address} = {self.value(place):g} the motion repeats after {motion.multiple} "
                "cycles: no branch of one cycle starts there",
                method="pseudo-arclength",
                iterations=0,
            )
        return motion, driven

    def _at(self, place: float) -> Driven:
        return ready(replace(self._machine, {self._address: self.value(place)}))

    def _numbers(self, place: float) -> tuple[Floats, Chain]:
        compiled, chain, _ = self._at(place)
        return np.array(compiled.one), chain

    def _error(self, places: Floats, machines: list[tuple[Floats, Chain]]) -> float:
        """What the numbers between the nodes differ by, over their sizes."""
        weights = np.array([1 / np.prod(x - np.delete(places, k)) for k, x in enumerate(places)])
        known = np.array([_flat(*machine) for machine in machines])
        size = np.abs(known).max(axis=0)
        worst = 0.0
        for place in (0.137, 0.523, 0.911):
            shares = weights / (place - places)
            guess = shares @ known / shares.sum()
            off = np.abs(guess - _flat(*self._numbers(place)))
            worst = max(worst, float(np.max(off / np.where(size > 0, size, 1.0))))
        return worst


def _flat(q: Floats, chain: Chain) -> Floats:
    """All numbers of a machine in a row."""
    return np.concatenate([q, np.asarray(listed(chain))])


def _branch(
    points: Sequence[tuple[float, bool, DrivelineMotion]], why: str, chain: Chain, family: _Family
) -> ElasticBranch:
    places = np.array([place for place, _, _ in points])
    motions = [motion for _, _, motion in points]
    multipliers = [multipliers_of(motion, chain) for motion in motions]
    crank = len(chain.links["inertia"])
    return ElasticBranch(
        parameter=np.array([family.value(place) for place in places]),
        torque_min=np.array([motion.torque.least / chain.lead for motion in motions]).T,
        torque_max=np.array([motion.torque.greatest / chain.lead for motion in motions]).T,
        speed_mean=np.array([family.cycle / motion.period for motion in motions]),
        speed_min=np.array([motion.speed.least[crank] for motion in motions]),
        speed_max=np.array([motion.speed.greatest[crank] for motion in motions]),
        multiplier_max=np.array([abs(each[0]) for each in multipliers]),
        start=np.array([motion.start for motion in motions]),
        special=tuple(_special(points, multipliers, family)),
        end={
            "range": "end of the range",
            "points": f"{_POINTS} motions",
            "short": "steps became too short",
        }[why],
    )


def _special(
    points: Sequence[tuple[float, bool, DrivelineMotion]], multipliers: list[Complexes], family: _Family
) -> Iterator[SpecialPoint]:
    """Folds, and points between two motions at which a test function changes its sign."""
    for k, (place, is_fold, _) in enumerate(points):
        if is_fold:
            yield SpecialPoint("fold", family.value(place))
        if k == 0:
            continue
        for kind, test in (("period doubling", _doubling), ("Neimark–Sacker", _modulation)):
            low, high = test(multipliers[k - 1]), test(multipliers[k])
            if low * high < 0:
                at = points[k - 1][0] + (place - points[k - 1][0]) * low / (low - high)
                yield SpecialPoint(kind, family.value(at))  # type: ignore[arg-type]


def _doubling(multipliers: Complexes) -> float:
    """Σ changes its sign where a multiplier passes −1: Π (μ + 1) of a real matrix is real."""
    return float(np.prod(multipliers + 1).real)


def _modulation(multipliers: Complexes) -> float:
    """Size of the largest pair less 1; −1 without pairs."""
    pairs = multipliers[multipliers.imag > 0]
    return float(np.abs(pairs).max() - 1) if len(pairs) else -1.0
