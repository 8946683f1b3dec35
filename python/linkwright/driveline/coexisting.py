"""Steady motions beside the one that is found: from other beginnings, and after several cycles.

With backlash or a curve a driveline may have several steady motions at one speed. The machine is followed
from cycle to cycle from other beginnings, until it repeats after up to eight cycles: a run-up from a tenth of
the speed without load, every link on either flank, and a large vibration of every link.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.driveline.chain import Chain
from linkwright.kernel.arrays import Floats
from linkwright.machine.program.compiled import CompiledMachine
from linkwright.machine.program.core import DrivelineMotion, NoDrivelineMotion

# Cycles that are followed from each beginning.
FOLLOWED = 60

# Speed at which the run-up begins, over that without load.
_LOW = 0.1

# Twists of a large vibration, over the largest of the known motion.
_LARGE = 4.0

# Difference of extremes, over their largest, from which on two motions are two.
_OTHER = 1e-5

# Cycles after which a motion that is followed may repeat, at most.
MULTIPLES = 8

# Where a machine began; the motion that it came to; what its last cycles differ by otherwise.
Followed = tuple[str, DrivelineMotion | None, float]

RUN_UP = "a run-up from a tenth of the speed without load"


@dataclass(frozen=True)
class OtherMotion:
    """A further steady motion of an elastic driveline.

    Attributes
    ----------
    turns : int
        Revolutions after which it repeats.
    period : float
        Duration of its cycle [s].
    torque_min, torque_max : ndarray, shape (shafts,)
        Extremes of the torques of the shafts, at their own speed [N m].
    multiplier_max : float
        Magnitude of the largest Floquet multiplier.
    start : str
        From where the motion came to it, in words.
    """

    turns: int
    period: float
    torque_min: Floats
    torque_max: Floats
    multiplier_max: float
    start: str

    @property
    def is_stable(self) -> bool:
        """Whether small disturbances decay."""
        return self.multiplier_max < 1

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers and texts, ready for JSON."""
        return {
            "turns": self.turns,
            "period": self.period,
            "torque_min": self.torque_min.tolist(),
            "torque_max": self.torque_max.tolist(),
            "multiplier_max": self.multiplier_max,
            "is_stable": self.is_stable,
            "start": self.start,
        }


def followed_motions(
    compiled: CompiledMachine,
    chain: Chain,
    known: DrivelineMotion | None,
    accuracy: float,
    search: dict[str, Any],
) -> Iterator[Followed]:
    """What the machine comes to from each beginning.

    Its words; the motion, or None where it does not repeat; the difference of its last cycles, over their
    size, or NaN where it stops.
    """
    for words, start in _beginnings(chain, known, search["speed"]):
        asked = search | {
            "cycles_first": FOLLOWED,
            "cycles_max": 2 * FOLLOWED,
            "multiples": MULTIPLES,
            "start": np.ascontiguousarray(start),
        }
        motion = steady_of(compiled, chain, accuracy, asked)
        if isinstance(motion, DrivelineMotion):
            yield words, motion, 0.0
        else:
            yield words, None, motion.accuracy if motion.reason == "not found" else np.nan


def steady_of(
    compiled: CompiledMachine, chain: Chain, accuracy: float, search: dict[str, Any]
) -> DrivelineMotion | NoDrivelineMotion:
    """Steady motion over its shortest cycle, or why there is none.

    A motion that alternates about one that repeats after each cycle is near itself after two first.
    """
    motion = compiled.driveline(chain.core, accuracy=accuracy, **search)
    if isinstance(motion, NoDrivelineMotion) or motion.multiple == 1:
        return motion
    for multiple in range(1, motion.multiple // 2 + 1):
        if motion.multiple % multiple == 0:
            asked = search | {
                "cycles_first": 1,
                "cycles_max": 1,
                "multiples": multiple,
                "start": motion.start,
            }
            one = compiled.driveline(chain.core, accuracy=accuracy, **asked)
            if isinstance(one, DrivelineMotion) and _has_same_extremes(motion, one):
                return one
    return motion


def is_same(a: DrivelineMotion, b: DrivelineMotion) -> bool:
    """Whether two motions have the same extremes and the same cycle."""
    return a.multiple == b.multiple and _has_same_extremes(a, b)


def _has_same_extremes(a: DrivelineMotion, b: DrivelineMotion) -> bool:
    """Whether torques and speeds of two motions have the same extremes."""
    pairs = [(a.torque, b.torque), (a.speed, b.speed)]
    for one, other in pairs:
        size = np.maximum(np.abs(one.greatest), np.abs(one.least))
        off = np.maximum(np.abs(one.greatest - other.greatest), np.abs(one.least - other.least))
        if (off > _OTHER * size).any():
            return False
    return True


def _beginnings(chain: Chain, known: DrivelineMotion | None, speed: float) -> Iterator[tuple[str, Floats]]:
    links, others = chain.links, len(chain.links["inertia"])
    held = chain.speed_held
    crank = speed if held is None else held
    low = crank if held is not None else _LOW * crank
    rest = np.zeros(2 * others)
    yield RUN_UP, np.append(rest, low)
    # Twists of the masses against the crank from those of the links.
    wound = [("the driving flanks", links["gap"]), ("the driven flanks", -links["gap"])]
    if known is not None:
        span = _LARGE * np.maximum(np.abs(known.twist.greatest), np.abs(known.twist.least))
        wound += [("links wound up far", span), ("links wound back far", -span)]
    for words, twist in wound:
        start = rest.copy()
        start[:others] = np.linalg.lstsq(chain.joins[:, :-1], twist, rcond=None)[0]
        yield words, np.append(start, crank)
