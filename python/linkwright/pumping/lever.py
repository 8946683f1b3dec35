"""Link and lever of a rotator as functions of the crank angle, and what the lever gives the worm."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import AssemblyError
from linkwright.kernel.numerics.turn_fit import turn_curve
from linkwright.linkages.closure import require_full_turn
from linkwright.linkages.kinematics import motion_arrays
from linkwright.linkages.model.mechanism import Mechanism
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine, compile_machine
from linkwright.pumping.model.rod_rotator import LEVER, LINK, PIN, RodRotator
from linkwright.pumping.model.rotator_lengths import Lengths, lengths
from linkwright.pumping.model.unit import ROD, PumpingUnit
from linkwright.pumping.unit import PolishedRod, turn_extreme

# Angles over which the motion of a stroke is examined.
_ANGLES = 1440

# Difference of the way forward from the swing that is rounding [rad].
_ONCE = 1e-9


@dataclass(frozen=True)
class LeverMotion:
    """Link and lever at crank angles, arrays (n,)."""

    angles: Floats  # crank angles [rad]
    # link, lever: φ_4 and φ_5, continuous over the angles [rad].
    link: Floats
    lever: Floats
    # link_d1, link_d2, lever_d1, lever_d2: their derivatives by the crank angle [–].
    link_d1: Floats
    link_d2: Floats
    lever_d1: Floats
    lever_d2: Floats
    diagonal: Floats  # l_d [m]
    residual: float  # maximum gap in the loop over the longest link [–]


@dataclass(frozen=True)
class Lever:
    """Link and lever of a rotator as functions of the crank angle."""

    compiled: CompiledMachine  # unit and rotator alone
    lengths: Lengths  # l_4 and l_5 [m]

    @classmethod
    def of(cls, machine: Machine, unit: PumpingUnit, rotator: RodRotator) -> Lever:
        """The lever of a machine's rotator, whatever else the machine holds."""
        alone = machine.with_entries({"mechanism": Mechanism(), "bodies": {}, "loads": {}, "drive": None})
        compiled = compile_machine(alone)
        require_full_turn(compiled, alone)
        return cls(compiled, lengths(unit, rotator))

    def motion(self, angles: Floats) -> LeverMotion:
        """Link and lever at crank angles [rad]."""
        asked = [("points", PIN), ("points", ROD), ("links", LINK), ("links", LEVER)]
        motion = motion_arrays(self.compiled, np.ascontiguousarray(angles), asked)[0]
        if not np.isfinite(motion).all():
            at = float(angles[int(np.argmin(np.isfinite(motion).all(axis=0)))])
            raise AssemblyError(
                f"the pin of the rotator passes over the hanger at crank angle {np.degrees(at):.2f}°, "
                "where the direction of the lever is undefined; give the hanger cable a free length "
                "(pumping_unit.cable)",
                element="rotator",
                crank_angle=at,
            )
        pin, hanger, link, lever = motion[0:2], motion[6:8], motion[12:16], motion[16:20]
        l_4, l_5 = self.lengths
        gap = pin + l_4 * link[:2] - hanger - l_5 * lever[:2]
        return LeverMotion(
            angles=angles,
            link=np.unwrap(np.arctan2(link[1], link[0])),
            lever=np.unwrap(np.arctan2(lever[1], lever[0])),
            link_d1=link[2],
            link_d2=link[3],
            lever_d1=lever[2],
            lever_d2=lever[3],
            diagonal=np.hypot(*(pin - hanger)),
            residual=float(np.hypot(*gap).max() / max(l_4, l_5)),
        )


def turns_of(fine: LeverMotion) -> float:
    """Whole revolutions of the lever per revolution of the crank, counter-clockwise positive."""
    return float(np.round((fine.lever[-1] - fine.lever[0]) / (2 * np.pi)))


def swing_of(lever: Lever, fine: LeverMotion) -> float:
    """Range of the lever's angle [rad]."""
    if turns_of(fine):
        return 2 * np.pi
    angle = _about_middle(lever, fine)
    return turn_extreme(angle, +1)[0] - turn_extreme(angle, -1)[0]


def _about_middle(lever: Lever, fine: LeverMotion) -> Callable[[Floats], Floats]:
    """The lever's angle at crank angles, about the middle of its range [rad]."""
    # None comes near the cut of the arc tangent there.
    middle = 0.5 * (fine.lever.min() + fine.lever.max())

    def angle(at: Floats) -> Floats:
        off = lever.motion(at).lever - middle
        near: Floats = off - 2 * np.pi * np.round(off / (2 * np.pi))
        return near

    return angle


def takes_along(rotator: RodRotator, rod: PolishedRod, lever: Lever) -> Callable[[LeverMotion], Floats]:
    """1 where the lever turns the worm, 0 where the clutch slips: by its sense in the clutch's stroke."""
    if rotator.regime == "continuous":
        return lambda motion: np.ones(len(motion.angles))
    start, end = (rod.bottom, rod.top) if rotator.clutch == "upstroke" else (rod.top, rod.bottom)
    stroke = lever.motion(np.linspace(start, start + (end - start) % (2 * np.pi), _ANGLES)).lever
    sense = np.sign(stroke[-1] - stroke[0])
    return lambda motion: (sense * motion.lever_d1 > 0).astype(np.float64)


def worm_turns_of(rotator: RodRotator, lever: Lever, fine: LeverMotion, swing: float) -> float:
    """Revolutions of the worm per revolution of the crank."""
    turns = abs(turns_of(fine))
    if rotator.regime == "continuous" or turns:
        return turns
    # What goes forward comes back: half of the way between the angles at which the lever turns back, with the
    # start of the revolution, at which it may.
    rate = turn_curve(lambda at: lever.motion(at).lever_d1[None], np.array([0.0, 2 * np.pi]), "motion")
    back = _about_middle(lever, fine)(np.append(0.0, rate.crossings()))
    # A lever that rocks once goes forward by its swing, whose ends are known to rounding.
    way = 0.5 * float(np.abs(np.diff(back, append=back[:1])).sum())
    return (swing if abs(way - swing) < _ONCE else way) / (2 * np.pi)
