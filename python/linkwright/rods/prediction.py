r"""Predicted motion of a rod string: cards from the polished rod to the pump.

The displacement of a section is :math:`u_{tt} = a^2 u_{xx} - c\,u_t`, exact per harmonic through any
number of
sections; valves of the pump make its load of the wave that comes down the rods, instant by instant
(`crates/linkwright-rods`). The polished rod moves as its unit does at the speed that its drive has under this
load.

References
----------
.. [1] Gibbs, Predicting the Behavior of Sucker-Rod Pumping Systems, J. Pet. Tech. 15 (1963) 769.
.. [2] API RP 11L, 4th ed. 1988, 2 and 3: terms F_o/Sk_r, N/N_o, N/N_o′, S_p/S, F_1/Sk_r, F_2/Sk_r.
.. [3] Takács, Sucker-Rod Pumping Handbook, 2015, 4.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, NamedTuple

import numpy as np

from linkwright.drive.steady_state import SteadyState
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import ConvergenceError, InputError
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.machine.machine import Machine
from linkwright.pumping.gear_torque import GearTorque, gear_torque
from linkwright.rods.core import Solved, sample_counts, solve_string
from linkwright.rods.model.rod_string import RodString
from linkwright.rods.numbers import ApiNumbers, api_numbers
from linkwright.rods.polished_rod import (
    HarmonicRod,
    RodMotion,
    UnitRod,
    given_counterbalance,
    over_angle,
    polished_rod_of,
    table_angles,
    with_load,
)
from linkwright.rods.scalars import StringNumbers, string_scalars
from linkwright.rods.stress import RodStress, rod_stress

# Samples of the first solution, and of the finest.
_FIRST, _MOST = 256, 8192

# Rounds between string and drive at most, and the change of the motion at which they end, over the accuracy.
_ROUNDS, _ALIKE = 40, 1e-3

# Error over the change by twice the samples, whose numbers are not quite doubled.
_SURE = 2.0

# Numbers of samples that are tried.
_TRIALS = 4


# Of a prediction and of a diagnosis alike.
DYNAMIC_LOAD = Label(
    *("dynamic load", "F", "N", "Tension beyond the weight of the rods in the fluid below.", "(stations, n)")
)
ROD_POSITION = Label("position of the polished rod", "s", "m", "Above the bottom of its stroke.")
BALANCE = Label(
    *("residual of the work balance", "", "", "Of the string, over the work of the polished rod."), scale=1.0
)


@dataclass(frozen=True)
class RodStringMotion(StringNumbers[float], Result):
    """A rod string with its pump over one stroke."""

    time: Annotated[Floats, Label("time", "t", "s", "From the bottom of the stroke.")]
    stations: Annotated[tuple[str, ...], About("The polished rod, the tapers, the pump.")]
    position: Annotated[
        Floats,
        Label("position", "u", "m", "Upward, from the string at rest without pump load.", "(stations, n)"),
    ]
    load: Annotated[Floats, DYNAMIC_LOAD]
    rod_position: Annotated[Floats, ROD_POSITION]
    rod_load: Annotated[
        Floats,
        Label("load of the polished rod", "W", "N", "With the weight of rods and the stuffing-box friction."),
    ]
    crank_angle: Annotated[Floats | None, Label("crank angle", "φ", "rad", "None without a pumping unit.")]
    numbers: Annotated[ApiNumbers, About("Terms of API RP 11L.")]
    stress: Annotated[RodStress, About("Loads and stresses of the sections, with the Goodman diagram.")]
    gear: Annotated[GearTorque | None, About("Torque of the gearbox; None without a pumping unit.")]
    gear_best: Annotated[
        GearTorque | None, About("The same with the best counterbalance; None without a pumping unit.")
    ]
    drive: Annotated[SteadyState | None, About("Steady motion of the drive; None without a motor.")]
    balance: Annotated[float, BALANCE]
    harmonics: Annotated[
        int, Label("harmonics", "", "", "Of the stroke, the finest solution.", table="rod_string")
    ]
    accuracy: Annotated[
        float,
        Label(
            "accuracy reached",
            "",
            "",
            "Difference from the solution with half the harmonics: of peak and minimum load over their "
            "range, of "
            "the plunger stroke over the stroke.",
            table="rod_string",
        ),
    ]
    sweeps: Annotated[int, Label("sweeps between string and pump", "", "", "Of the finest solution.")]

    @property
    def efficiency(self) -> Annotated[float, Label("efficiency of the rod string", "η", "")]:
        """Hydraulic power over the power of the polished rod."""
        return self.power_hydraulic / self.power_rod

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Scalars by name, and those of its parts: terms of API RP 11L, stresses, gearbox, drive."""
        names = ("numbers", "gear", "gear_best", "drive")
        parts = {name: getattr(self, name) for name in names if getattr(self, name)}
        found = super().to_dict(curves=curves) | {"stress": self.stress.to_dict(curves=True)}
        return found | {name: part.to_dict(curves=curves) for name, part in parts.items()}


@public
def rod_string(machine: Machine, *, accuracy: float = 1e-3) -> RodStringMotion:
    """Motion of a rod string under its pumping unit: cards, loads, stresses, production.

    Parameters
    ----------
    machine : Machine
        A machine with a rod string.
    accuracy : float
        Accuracy of peak and minimum load and of the plunger stroke, by which the number of harmonics is
        chosen.

    Returns
    -------
    RodStringMotion
        Cards of the polished rod, of every taper and of the pump, with what follows from them.

    Raises
    ------
    InputError
        The machine has no rod string, or nothing moves its polished rod.
    ConvergenceError
        No periodic motion was found: without damping vibrations of the string may not die out.

    Notes
    -----
    Dynamic loads are tensions beyond the weight of the rods in the fluid; stresses and the tendency to buckle
    are those of the effective tension, which buoyancy at the lower end does not compress.
    """
    return solution(machine, accuracy).result


class Solution(NamedTuple):
    """A rod string in motion, and how it was solved."""

    string: RodString
    rod: HarmonicRod | UnitRod
    moved: RodMotion
    solved: Solved
    result: RodStringMotion


def solution(machine: Machine, accuracy: float) -> Solution:
    """The motion of a rod string with its solution; raises what `rod_string` raises."""
    string = string_of(machine)
    if not 1e-6 <= accuracy <= 0.1:
        raise InputError(f"accuracy: found {accuracy}, expected a number from 1e-6 to 0.1")
    rod = polished_rod_of(machine, string)
    least, before, start, last = _FIRST, None, None, 0.0
    while True:
        moved, solved = _settled(string, rod, least, start, _ALIKE * accuracy)
        scalars = _scalars(string, rod, moved, solved)
        change = np.inf if before is None else _difference(scalars, before)
        # The error beside corners is of second order, but a change may be small by chance: the one before
        # counts too.
        reached = _SURE * max(change, last / 4)
        if reached <= accuracy or 2 * least > _MOST:
            result = _result(string, rod, moved, solved, scalars, float(reached))
            return Solution(string, rod, moved, solved, result)
        last = 0.0 if before is None else change
        least, before, start = 2 * least, scalars, np.asarray(solved.wave)


def string_of(machine: Machine) -> RodString:
    """The rod string of a machine; an `InputError` without one."""
    string: RodString | None = machine.rod_string
    if string is None:
        raise InputError(f"{machine.name} has no [rod_string]: expected the description of one")
    return string


def _settled(
    string: RodString, rod: HarmonicRod | UnitRod, least: int, start: Floats | None, alike: float
) -> tuple[RodMotion, Solved]:
    """String and drive at their common motion."""
    counts = sample_counts(string, rod.period, least)
    # Answers to other samples differ by more than those that are extrapolated from.
    rod.rounds.clear()
    for _ in range(_ROUNDS):
        moved, solved = _periodic(string, rod, counts, start)
        start = np.asarray(solved.wave)
        if rod.take(polished_rod_load(string, moved.position, solved.cards.load[0][::2])) <= alike:
            return moved, solved
    raise ConvergenceError(
        "string and drive have not come to a common steady motion: the drive is close to its limit"
    )


def _periodic(
    string: RodString, rod: HarmonicRod | UnitRod, counts: list[int], start: Floats | None
) -> tuple[RodMotion, Solved]:
    """The string under a motion of the polished rod.

    Where a jump of the load falls on a sample, sweeps may move it: others have it between them.
    """
    for n in counts[:_TRIALS]:
        moved = rod.motion(n)
        solved = solve_string(string, moved.period, moved.position, start)
        if solved.has_converged:
            return moved, solved
    raise ConvergenceError(
        f"no periodic motion of the rod string was found: waves between string and pump still change by "
        f"{solved.change:.2g} of the fluid load; expected damping by which they die out, see "
        "rod_string.damping"
    )


def polished_rod_load(string: RodString, position: Floats, dynamic: Any) -> Any:
    """Load of the polished rod: dynamic load, weight of the rods in the fluid, friction of the stuffing
    box [N].
    """
    direction = np.sign(np.roll(position, -1) - np.roll(position, 1))
    return dynamic + string.weight_fluid + string.stuffing_box * direction


def _difference(fine: Mapping[str, float], coarse: Mapping[str, float]) -> float:
    change = {name: abs(fine[name] - coarse[name]) for name in ("load_max", "load_min", "plunger_stroke")}
    peaks = max(change["load_max"], change["load_min"]) / (fine["load_max"] - fine["load_min"])
    return max(peaks, change["plunger_stroke"] / fine["stroke"])


def _scalars(
    string: RodString, rod: HarmonicRod | UnitRod, moved: RodMotion, solved: Solved
) -> dict[str, float]:
    position = rod.motion(len(solved.cards.load[0])).position
    found = string_scalars(string, moved.stroke, moved.period, solved.cards, solved.mean_load, position)
    return {name: float(number) for name, number in found.items()}


def _result(
    string: RodString,
    rod: HarmonicRod | UnitRod,
    moved: RodMotion,
    solved: Solved,
    scalars: dict[str, Any],
    accuracy: float,
) -> RodStringMotion:
    cards, period = solved.cards, moved.period
    moved = rod.motion(len(cards.load[0]))
    load = polished_rod_load(string, moved.position, cards.load[0])
    gear = _gear(rod, moved, load, is_best=False)
    is_given = isinstance(rod, UnitRod) and given_counterbalance(rod.unit) is not None
    best = _gear(rod, moved, load, is_best=True) if is_given else gear
    peak = None if best is None else max(best.torque_net_up, best.torque_net_down)
    numbers = api_numbers(string, scalars, peak)
    lost = float(cards.loss.sum())
    return RodStringMotion(
        time=period * np.arange(len(load)) / len(load),
        stations=station_names(string),
        position=cards.position,
        load=cards.load,
        rod_position=moved.position - moved.position.min(),
        rod_load=load,
        crank_angle=moved.crank_angle,
        **scalars,
        numbers=numbers,
        stress=rod_stress(string, cards.load),
        gear=gear,
        gear_best=best,
        drive=rod.steady if isinstance(rod, UnitRod) else None,
        balance=float((cards.work[0] - cards.work[-1] - lost) / cards.work[0]),
        harmonics=len(load) // 2 - 1,
        accuracy=accuracy,
        sweeps=solved.sweeps,
    )


def station_names(string: RodString) -> tuple[str, ...]:
    """Names of the polished rod, the tapers and the pump."""
    tapers = (f"taper {n}" for n in range(1, len(string.sections)))
    return ("polished rod", *tapers, "pump")


def _gear(rod: HarmonicRod | UnitRod, moved: RodMotion, load: Floats, *, is_best: bool) -> GearTorque | None:
    if not isinstance(rod, UnitRod) or moved.crank_angle is None:
        return None
    loaded = with_load(rod.unit, over_angle(moved.crank_angle, load), is_best=is_best)
    shown = np.append(table_angles(), 2 * np.pi)
    return gear_torque(loaded, rod.rod.motion, rod.ends, shown)
