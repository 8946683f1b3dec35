"""Run-up of a torsionally flexible driveline with its mechanism: until when, and what its shafts bear.

Whether the machine starts, how long it takes, where it stalls if it does; peak torques of the shafts against
what is permitted; what is lost in couplings, gearbox and motor.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from linkwright.driveline.elastic_motion import (
    SteadySolution,
    solved_motion,
)
from linkwright.driveline.in_time import ElasticTransient, Followed, followed, ready_in_time
from linkwright.driveline.permitted import TorqueJudgement
from linkwright.driveline.solving import require_flexible
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError, StartError, SteadyStateError
from linkwright.kernel.numerics.zeros import zeros
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.linkages.whole_cycle import cycle_of
from linkwright.machine.machine import Machine

# Relative accuracy of a step, and of the steady motion that is approached.
_ACCURACY = 1e-9

# Turns after which it is looked whether the motion has settled, again after as many more.
_FIRST_TURNS = 4.0

# A motion that takes so many times as long as its revolutions at working speed is given up.
_SLOWEST = 4.0

# Looks of a step at whether the motion has settled.
_LOOKS = 4

_UNTIL = (
    "From the start until the speed of a station, referred to the crank, last differed from that of steady "
    "motion at the same angle by more than ``settled`` times the mean speed."
)


@dataclass(frozen=True)
class ElasticRunUp(Result):
    """Run-up of a torsionally flexible driveline."""

    crank_time: Annotated[Floats, Label("time", "t", "s", "Ends of the steps.")]
    crank_angle: Annotated[Floats, Label("crank angle", "φ", "rad", "Continuous over the revolutions.")]
    speed: Annotated[Floats, Label("speed of the crank", "ω", "rad/s")]
    time: Annotated[float, Label("time", "t", "s", _UNTIL, table="elastic_run_up")]
    turns: Annotated[float, Label("revolutions of the crank", "n", "", _UNTIL, table="elastic_run_up")]
    settled: Annotated[float, Label("share of the mean speed that counts as settled", "", "")]
    shafts: Annotated[tuple[str, ...], About("What twists, from the motor on.")]
    torque_steady: Annotated[
        Floats,
        Label("peak torque in steady motion", "", "N m", "At its own speed.", shape="(shafts,)"),
    ]
    motion: Annotated[ElasticTransient, About("The whole motion.")]

    @property
    def torque_peak(
        self,
    ) -> Annotated[Floats, Label("peak torque of the start-up", "T_peak", "N m", shape="(shafts,)")]:
        """Largest absolute torque of each shaft."""
        return self.motion.torque_peak

    @property
    def torque_peak_time(
        self,
    ) -> Annotated[Floats, Label("time of the peak torque", "", "s", shape="(shafts,)")]:
        """When it is reached."""
        return self.motion.torque_peak_time

    @property
    def torque_factor(
        self,
    ) -> Annotated[Floats, Label("peak torque over that of steady motion", "", "", shape="(shafts,)")]:
        """How many times as much each shaft bears as in steady motion."""
        with np.errstate(divide="ignore"):
            factor: Floats = self.torque_peak / self.torque_steady
        return factor

    @property
    def energy_error(self) -> Annotated[float, Label("energy-balance residual", "", "")]:
        """Of the whole motion."""
        return self.motion.energy_error

    @property
    def judgements(
        self,
    ) -> Annotated[tuple[TorqueJudgement, ...], About("Torques against what is permitted.")]:
        """Of the whole motion."""
        return self.motion.judgements

    @property
    def findings(self) -> list[str]:
        """Limits that are exceeded, in sentences."""
        return self.motion.findings

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """As any result, with the motion, and torques by name of shaft."""
        results = super().to_dict(curves=curves)
        for name in ("torque_steady", "torque_peak", "torque_peak_time", "torque_factor"):
            results[name] = dict(zip(self.shafts, getattr(self, name).tolist(), strict=True))
        results.pop("judgements", None)
        return results | {"motion": self.motion.to_dict(curves=curves)}


@public
def elastic_run_up(machine: Machine, *, accuracy: float = _ACCURACY) -> ElasticRunUp:
    """Run-up of a torsionally flexible driveline from the start angle and speed (``[run_up]`` of the file).

    Parameters
    ----------
    machine : Machine
        With a mechanism, a motor, and a [drive] of which something twists.
    accuracy : float
        Relative accuracy of a step, and of the steady motion that is approached.

    Returns
    -------
    ElasticRunUp
        The motion, when it has settled, and what its shafts bear.

    Raises
    ------
    StartError
        It does not start, stalls, or is driven backwards; says at which angle, with the torques.
    SteadyStateError
        It has not settled within ``run_up.turns_max``, or has no steady motion.
    AssemblyError
        See `elastic_motion`.
    """
    require_flexible(machine)
    if not machine.has_mounted_mechanisms and (machine.drive is None or machine.drive.motor is None):
        raise InputError(f"{machine.name}: a run-up needs a motor; add [drive.motor]")
    options = machine.run_up
    turns = min(_FIRST_TURNS, options.turns_max)
    solved: SteadySolution | None = None
    moving = _from_start(machine, turns, accuracy)
    while True:
        _require_forward(moving, machine)
        if solved is None:
            solved = solved_motion(machine, accuracy)
            mean = 2 * np.pi * solved.turns / solved.motion.period
        limit = options.settled * mean
        known = _steady_speeds(solved)
        settled = _settled(moving, known, limit)
        # Settled well before the end: otherwise the speed may yet leave the band again.
        if settled is not None and (settled[1] <= 0.8 * turns or turns >= options.turns_max):
            break
        if turns >= options.turns_max or moving.last.end == "time":
            raise SteadyStateError(_too_slow(moving, known, mean, options.settled))
        more = min(2 * turns, options.turns_max - turns)
        moving, turns = _from_start(machine, more, accuracy, moving), turns + more
    motion = moving.result(words="during the run-up")
    return ElasticRunUp(
        crank_time=motion.time,
        crank_angle=motion.crank_angle,
        speed=motion.speed[-1],
        time=settled[0],
        turns=settled[1],
        settled=options.settled,
        shafts=solved.chain.shafts,
        torque_steady=np.maximum(solved.motion.torque.greatest, -solved.motion.torque.least)
        / solved.chain.lead,
        motion=motion,
    )


def require_elastic_start(machine: Machine) -> None:
    """Raise if the machine does not move on from its start; a `StartError` with the torques."""
    _require_forward(_from_start(machine, min(1.0, machine.run_up.turns_max), 1e-6), machine)


def _from_start(machine: Machine, turns: float, accuracy: float, after: Followed | None = None) -> Followed:
    """The motion from the start of the run-up, or further on, for a number of revolutions."""
    options, (_, chain, speed) = machine.run_up, ready_in_time(machine)
    others = np.zeros(2 * len(chain.links["inertia"]))
    state = np.concatenate([others, [options.speed_start, options.angle_start]])
    duration = _SLOWEST * options.turns_max * 2 * np.pi / speed
    return followed(machine, state, limits=(duration, turns), accuracy=accuracy, after=after)


def _require_forward(moving: Followed, machine: Machine) -> None:
    """Raise if the motion came to rest, or went backwards."""
    last = moving.last
    turned = float(last.crank_angle[-1] - moving.stretches[0].motion.crank_angle[0]) / (2 * np.pi)
    drive, load = last.torque_drive_end, last.torque_load_end
    cycle = 2 * np.pi if machine.has_mounted_mechanisms else cycle_of(machine)
    angle = f"{np.degrees(last.crank_angle[-1] % cycle):.1f}°"
    balance = f"at {angle} the motor gives {drive:.0f} N m at the crank, the load needs {load:.0f} N m"
    remedy = "choose a motor with more starting torque, a larger ratio, or another start angle"
    after = f"after {abs(turned):.2f} revolutions and {last.time[-1]:.2f} s"
    if last.end == "rest":
        moved = np.ptp(last.crank_angle) > 0
        raise StartError(
            f"stalls {after}: {balance}; {remedy}" if moved else f"does not start: {balance}; {remedy}"
        )
    if last.end == "turns" and turned < 0:
        raise StartError(f"does not start: the load drives the crank backwards; {balance}; {remedy}")


def _steady_speeds(solved: SteadySolution) -> Callable[[Floats], Floats]:
    """What gives the steady speeds of the masses, at the crank, at crank angles."""
    cycle = 2 * np.pi * solved.turns

    def speeds(angle: Floats) -> Floats:
        found: Floats = solved.motion.curves(np.ascontiguousarray(angle % cycle)).speed
        return found

    return speeds


def _settled(moving: Followed, known: Callable[[Floats], Floats], limit: float) -> tuple[float, float] | None:
    """Time and turns at which the motion last enters the band about steady motion; None if never."""
    first, ends = moving.stretches[0].motion.crank_angle[0], moving.ends
    looks = np.append(
        (ends[:-1, None] + np.diff(ends)[:, None] * np.arange(_LOOKS) / _LOOKS).ravel(), ends[-1]
    )

    def off(time: Floats) -> tuple[Floats, Floats]:
        curves = moving.curves(time, ("angle", "speed"))
        away = np.abs(curves["speed"] - known(curves["angle"][-1])).max(axis=0)
        return away - limit, curves["angle"][-1]

    excess = off(looks)[0]
    outside = np.flatnonzero(excess > 0)
    if not len(outside):
        return 0.0, 0.0
    if outside[-1] == len(looks) - 1:
        return None
    last = outside[-1:]
    settled = np.maximum(*zeros(lambda time: off(time)[0], looks[last], looks[last + 1]))
    turned = float(off(settled)[1][0] - first) / (2 * np.pi)
    return float(settled[0]), turned


def _too_slow(moving: Followed, known: Callable[[Floats], Floats], mean: float, band: float) -> str:
    ends = moving.ends[-1:]
    curves = moving.curves(ends)
    angle = curves["angle"][-1]
    off = float(np.abs(curves["speed"] - known(angle)).max()) / mean
    turned = abs(float(angle[0] - moving.stretches[0].motion.crank_angle[0])) / (2 * np.pi)
    return (
        f"has not settled after {turned:.0f} revolutions ({ends[0]:.1f} s): its speed still "
        f"differs from it by {100 * off:.2g} %, more than {100 * band:.2g} %; raise run_up.turns_max"
    )
