"""Run-down: motor off, brake on, until the machine stands."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from linkwright.drive.steady_state import SteadyState, steady_state
from linkwright.drive.transient import Transient, transient
from linkwright.kernel.errors import SteadyStateError
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Shown
from linkwright.kernel.result import Result
from linkwright.machine.machine import Machine

# Turns after which a run-down is given up: nothing brakes.
_TURNS_MAX = 1000.0


@dataclass(frozen=True)
class RunDown(Result):
    """The run-down from the steady speed at φ = 0."""

    turns: Annotated[float, Shown("revolutions of the crank", "n", "", "Until rest.", table="run_down")]
    time: Annotated[float, Shown("time", "t", "s", "Until rest.", table="run_down")]
    angle_end: Annotated[float, Shown("crank angle at rest", "φ_end", "rad", table="run_down")]
    motion: Annotated[Transient, About("The whole motion.")]


@public
def run_down(machine: Machine, *, steady: SteadyState | None = None) -> RunDown:
    """Let the machine run down from steady motion, motor off, brake applied if there is one.

    Parameters
    ----------
    machine : Machine
        The machine.
    steady : SteadyState, optional
        Its steady motion, if known already.

    Returns
    -------
    RunDown
        Until it stands; where gravity or a spring would swing it back, until it first comes to rest.

    Raises
    ------
    SteadyStateError
        It does not come to rest within 1000 revolutions: nothing brakes it.
    """
    steady = steady or steady_state(machine, n=8)
    speed = float(steady.speed[0])
    motion = transient(machine, speed=speed, turns=_TURNS_MAX, motor=False, brake=True)
    if not motion.came_to_rest:
        raise SteadyStateError(
            f"does not come to rest within {_TURNS_MAX:.0f} revolutions: add [drive.brake]"
        )
    end = float(motion.crank_angle[-1] % (2 * np.pi))
    return RunDown(turns=motion.turns, time=float(motion.time[-1]), angle_end=end, motion=motion)
