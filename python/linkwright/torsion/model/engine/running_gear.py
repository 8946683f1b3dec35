"""The running gear of one throw: rods and pistons of its cylinders, and how they move together.

Side by side, or fork and blade, all rods stand on the crank pin and move alike; they differ in mass alone.
Articulated rods stand on a pin of their master rod.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from numpy.typing import ArrayLike

from linkwright.kernel.errors import InputError
from linkwright.torsion.model.engine.rod import ArticulatedRod, Rod
from linkwright.torsion.model.engine.rod_motion import RodMotion, articulated_pin, crank_pin, rod_motion


@dataclass(frozen=True, slots=True)
class RunningGear:
    """Rod and piston of one cylinder."""

    rod: Rod  # on the crank pin; an `ArticulatedRod` on its master rod
    piston_mass: float  # of the reciprocating mass with the piston: piston, rings, pin [kg]
    # β, from the vertical to the axis of the cylinder, in the sense of rotation [rad].
    bank_angle: float = 0.0
    offset: float = 0.0  # e of that axis from the axis of the crank, in the sense of rotation [m]
    master: int = 0  # of an articulated rod: the place of its master rod among the gears of the throw, from 0
    name: str = "the cylinder"  # what the cylinder is called in messages

    def __post_init__(self) -> None:
        if not (math.isfinite(self.piston_mass) and self.piston_mass >= 0):
            raise InputError(f"piston_mass: found {self.piston_mass:g}, expected a mass of 0 or more [kg]")

    @property
    def is_articulated(self) -> bool:
        """Whether the rod stands on a master rod."""
        return isinstance(self.rod, ArticulatedRod)


def throw_motion(
    crank_radius: float, gears: Sequence[RunningGear], crank_angle: ArrayLike
) -> tuple[RodMotion, ...]:
    """Motion of all rods and pistons of one throw. `crank_radius`: r [m]; `crank_angle`: [rad]."""
    pin = crank_pin(crank_radius, crank_angle)
    found: dict[int, RodMotion] = {}
    # Master rods come first, wherever they stand.
    for at, gear in sorted(enumerate(gears), key=lambda each: each[1].is_articulated):
        big_end = pin
        if isinstance(gear.rod, ArticulatedRod):
            master = found[_master(gears, at)]
            big_end = articulated_pin(master, gear.rod.pin_radius, gear.rod.pin_angle)
        found[at] = rod_motion(big_end, crank_angle, gear.rod.length, gear.bank_angle, gear.offset, gear.name)
    return tuple(found[at] for at in range(len(gears)))


def _master(gears: Sequence[RunningGear], at: int) -> int:
    """Place of the master rod of an articulated rod."""
    place = gears[at].master
    if not 0 <= place < len(gears) or gears[place].is_articulated:
        found = "none" if not 0 <= place < len(gears) else "an articulated rod"
        raise InputError(
            f"master: found {place} for {gears[at].name}, where {found} stands; expected the place of a "
            "master rod among the gears of the throw, counted from 0"
        )
    return place
