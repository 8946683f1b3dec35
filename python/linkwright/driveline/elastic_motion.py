r"""Steady motion of a torsionally flexible driveline that drives a mechanism of varying inertia.

The stations of the driveline, motor, gearbox and crank, have inertias and are joined by shafts with
stiffness k and damping c; the last one is the mechanism, with its reduced inertia J(φ) and load torque M_r:

.. math:: J_i \ddot\varphi_i = M_d(\dot\varphi_i) - \sum T, \qquad
    J(\varphi)\,\ddot\varphi + \tfrac12 J'(\varphi)\,\dot\varphi^2 = T - M_r(\varphi, \dot\varphi), \qquad
    T = k\,\Delta + c\,\dot\Delta

A train may have several motors, loads over the speed, and several mechanisms, the further ones at angles in
which the twists have a part. The solution that repeats after every cycle of the crank is found by Newton's
method on all stages of a collocation, not by waiting; the eigenvalues of the monodromy matrix are its Floquet
multipliers.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated, Any, NamedTuple

import numpy as np

from linkwright.drive.steady_state import require_accuracy
from linkwright.driveline.chain import Chain, Driven
from linkwright.driveline.coexisting import (
    FOLLOWED,
    Followed,
    OtherMotion,
    followed_motions,
    is_same,
    steady_of,
)
from linkwright.driveline.permitted import TorqueJudgement, judged
from linkwright.driveline.solving import AWAY, multipliers_of, ready, search, solved
from linkwright.kernel.arrays import Complexes, Floats
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.reader.numbers import number
from linkwright.kernel.result import Result
from linkwright.linkages.closure import turn_angles
from linkwright.machine.machine import Machine
from linkwright.machine.program.core import DrivelineMotion

_OWN = "At its own speed."


@dataclass(frozen=True)
class ElasticMotion(Result):
    """One cycle of steady motion of a torsionally flexible driveline; extremes are not those of the curves.

    Torques and twists are those of the shafts at their own speed, motions those of the stations; a torque is
    positive where the side of the motor drives, in a train where the first end of the shaft does.
    """

    crank_angle: Annotated[
        Floats, Label("crank angle", "φ", "rad", "Over a cycle, from 0 on.", shape="(n + 1,)")
    ]
    time: Annotated[Floats, Label("time", "t", "s", "From the start of the cycle.")]
    stations: Annotated[
        tuple[str, ...], About("What turns, from the motor on; the mechanism is on the crank.")
    ]
    shafts: Annotated[tuple[str, ...], About("What twists, from the motor on.")]
    motors: Annotated[tuple[str, ...], About("What drives: the motor, or motors and drivers of a train.")]
    crank: Annotated[str, About("Station whose crank angle counts; of a train that of the first mechanism.")]
    ratio: Annotated[Floats, Label("speed over that of the crank", "i", "", shape="(stations,)")]
    speed: Annotated[Floats, Label("speed of each station", "ω", "rad/s", shape="(stations, n + 1)")]
    acceleration: Annotated[
        Floats, Label("acceleration of each station", "ε", "rad/s²", shape="(stations, n + 1)")
    ]
    torque: Annotated[Floats, Label("torque of each shaft", "T", "N m", _OWN, shape="(shafts, n + 1)")]
    twist: Annotated[Floats, Label("twist of each shaft", "Δ", "rad", _OWN, shape="(shafts, n + 1)")]
    torque_drive: Annotated[
        Floats,
        Label("driving torque referred to the crank", "M_d", "N m", "Of all motors, behind the gearbox."),
    ]
    torque_motor: Annotated[
        Floats,
        Label(
            "torque of each motor",
            "M_m",
            "N m",
            "At its own speed, less gear losses.",
            shape="(motors, n + 1)",
        ),
    ]
    torque_motor_min: Annotated[
        Floats, Label("minimum torque of each motor", "M_m,min", "N m", shape="(motors,)")
    ]
    torque_motor_max: Annotated[
        Floats, Label("maximum torque of each motor", "M_m,max", "N m", shape="(motors,)")
    ]
    torque_motor_mean: Annotated[
        Floats, Label("mean torque of each motor", "M_m,m", "N m", "Over time.", shape="(motors,)")
    ]
    power_motor: Annotated[
        Floats, Label("mean power of each motor", "P_m", "W", "Less gear losses.", shape="(motors,)")
    ]
    torque_load: Annotated[Floats, Label("load torque referred to the crank", "M_r", "N m")]
    speed_min: Annotated[Floats, Label("minimum speed", "ω_min", "rad/s", shape="(stations,)")]
    speed_max: Annotated[Floats, Label("maximum speed", "ω_max", "rad/s", shape="(stations,)")]
    speed_min_angle: Annotated[
        Floats, Label("crank angle of the minimum speed", "φ(ω_min)", "rad", shape="(stations,)")
    ]
    speed_max_angle: Annotated[
        Floats, Label("crank angle of the maximum speed", "φ(ω_max)", "rad", shape="(stations,)")
    ]
    acceleration_min: Annotated[Floats, Label("minimum acceleration", "ε_min", "rad/s²", shape="(stations,)")]
    acceleration_max: Annotated[Floats, Label("maximum acceleration", "ε_max", "rad/s²", shape="(stations,)")]
    torque_min: Annotated[Floats, Label("minimum torque", "T_min", "N m", _OWN, shape="(shafts,)")]
    torque_max: Annotated[Floats, Label("maximum torque", "T_max", "N m", _OWN, shape="(shafts,)")]
    torque_min_angle: Annotated[
        Floats, Label("crank angle of the minimum torque", "φ(T_min)", "rad", shape="(shafts,)")
    ]
    torque_max_angle: Annotated[
        Floats, Label("crank angle of the maximum torque", "φ(T_max)", "rad", shape="(shafts,)")
    ]
    torque_mean: Annotated[Floats, Label("mean torque", "T_m", "N m", "Over time.", shape="(shafts,)")]
    torque_rms: Annotated[
        Floats, Label("root mean square torque", "T_rms", "N m", "Over time.", shape="(shafts,)")
    ]
    twist_min: Annotated[Floats, Label("minimum twist", "Δ_min", "rad", _OWN, shape="(shafts,)")]
    twist_max: Annotated[Floats, Label("maximum twist", "Δ_max", "rad", _OWN, shape="(shafts,)")]
    backlash: Annotated[Floats, Label("backlash of each shaft", "b", "rad", _OWN, shape="(shafts,)")]
    power_dissipated: Annotated[
        Floats,
        Label(
            "dissipated power", "P_v", "W", "Mean power that the damping turns into heat.", shape="(shafts,)"
        ),
    ]
    period: Annotated[float, Label("period", "T_c", "s", "Duration of a cycle.", table="elastic_motion")]
    multipliers: Annotated[
        Complexes,
        About(
            "Floquet multipliers: shares of small disturbances left after a cycle, from the largest on.",
            "(states,)",
        ),
    ]
    energy_drive: Annotated[
        float,
        Label("work of the motor per revolution", "A_d", "J", "Behind the gearbox.", table="elastic_motion"),
    ]
    energy_load: Annotated[
        float, Label("work of the loads per revolution", "A_r", "J", table="elastic_motion")
    ]
    accuracy: Annotated[
        float,
        Label("accuracy reached", "", "", "Error of speeds and twists, each over the largest of its kind."),
    ]
    steps: Annotated[int, Label("steps of the finest mesh", "", "")]
    turns: Annotated[int, Label("revolutions of a cycle", "", "")]
    cycles_followed: Annotated[
        int, Label("cycles followed in time", "", "", "Before Newton's method; 0 where it needs none.")
    ]
    judgements: Annotated[tuple[TorqueJudgement, ...], About("Torques against what is permitted.")] = ()
    notes: Annotated[tuple[str, ...], About("What was assumed.")] = ()
    start: Annotated[
        str, About("From where the machine comes to this motion; empty where it was not looked for.")
    ] = ""
    other_motions: Annotated[
        tuple[OtherMotion, ...], About("Further steady motions, from other beginnings, if asked for.")
    ] = ()
    not_periodic: Annotated[
        tuple[str, ...], About("Beginnings from which the motion does not repeat, in sentences.")
    ] = ()

    @property
    def findings(self) -> list[str]:
        """Limits that are exceeded, in sentences."""
        return [f"{judgement.words}." for judgement in self.judgements if not judgement.is_kept]

    @property
    def speed_mean_time(
        self,
    ) -> Annotated[
        float, Label("mean speed of the crank", "ω_m", "rad/s", table="elastic_motion", before="period")
    ]:
        """Angle of a cycle over its duration."""
        return 2 * np.pi * self.turns / self.period

    @property
    def unevenness(
        self,
    ) -> Annotated[Floats, Label("coefficient of speed fluctuation", "δ", "", shape="(stations,)")]:
        """Range of the speed of each station over its mean over time."""
        means = self.speed_mean_time * self.ratio
        fluctuation: Floats = (self.speed_max - self.speed_min) / means
        return fluctuation

    @property
    def torque_peak(
        self,
    ) -> Annotated[Floats, Label("peak torque", "T_peak", "N m", shape="(shafts,)")]:
        """Largest absolute torque of each shaft."""
        return np.maximum(self.torque_max, -self.torque_min)

    @property
    def torque_vibratory(
        self,
    ) -> Annotated[Floats, Label("vibratory torque", "T_v", "N m", shape="(shafts,)")]:
        """Half the peak-to-peak torque of each shaft."""
        half: Floats = 0.5 * (self.torque_max - self.torque_min)
        return half

    @property
    def torque_ratio(
        self,
    ) -> Annotated[Floats, Label("peak over mean torque", "T_peak/T_m", "", shape="(shafts,)")]:
        """Peak torque over the size of the mean torque; infinite without a mean."""
        with np.errstate(divide="ignore"):
            ratio: Floats = self.torque_peak / np.abs(self.torque_mean)
        return ratio

    @property
    def multiplier_max(
        self,
    ) -> Annotated[float, Label("largest Floquet multiplier", "∣G∣", "", table="elastic_motion", scale=1.0)]:
        """Largest absolute value of the multipliers; the motion is stable if it is below 1."""
        return float(np.abs(self.multipliers[0]))

    @property
    def is_stable(self) -> bool:
        """Whether small disturbances die away."""
        return self.multiplier_max < 1

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """As `Result.to_dict`; extremes by name of shaft and station, multipliers as pairs of numbers."""
        results = super().to_dict(curves=curves)
        results["multipliers"] = [[float(each.real), float(each.imag)] for each in self.multipliers]
        results["judgements"] = [judgement.to_dict() for judgement in self.judgements]
        results["other_motions"] = [other.to_dict() for other in self.other_motions]
        results["not_periodic"] = list(self.not_periodic)
        return results | self.parts_by_name()


@public
def elastic_motion(
    machine: Machine,
    *,
    accuracy: float = 1e-9,
    n: int = 360,
    angles: Floats | None = None,
    others: bool = False,
) -> ElasticMotion:
    """Find the steady motion of a torsionally flexible driveline with its mechanism.

    Parameters
    ----------
    machine : Machine
        With a mechanism, a motor, and a [drive] of which something twists; or with a [train] that has
        mechanisms and motors.
    accuracy : float
        Relative accuracy of speeds and twists, down to 1e-13.
    n : int
        Intervals of a revolution for the curves; extremes and means do not depend on it.
    angles : ndarray, shape (m,), optional
        Crank angles of the curves instead, within the cycle [rad].
    others : bool
        Whether to look for other steady motions, from other beginnings, where links have backlash or curves.

    Returns
    -------
    ElasticMotion
        One cycle from φ = 0.

    Raises
    ------
    AssemblyError
        The mechanism does not close all round.
    FindingError
        It does not repeat after 24 revolutions of the crank or fewer.
    SteadyStateError
        The crank comes to rest or turns back; says where. Or its motion is chaotic.
    ConvergenceError
        No periodic motion was found, or not to the accuracy.
    InputError
        The machine has no motor, or nothing of its driveline twists.

    References
    ----------
    .. [1] Dresig and Holzweißig, Dynamics of Machinery, 2010, sections 2.3 and 4.3.
    """
    require_accuracy(accuracy)
    found = solved_motion(machine, accuracy)
    (compiled, chain, _), motion, rest = found
    if others and not chain.is_linear and not rest:
        rest = list(followed_motions(compiled, chain, motion, accuracy, search(found.driven, 0)))
    phi = turn_angles(n, found.turns) if angles is None else angles
    result = result_of(machine, motion, chain, phi, found.turns)
    return _with_others(result, motion, chain, rest, compiled.turns) if others else result


class SteadySolution(NamedTuple):
    """Steady motion as the core has it, of which curves are read."""

    driven: Driven
    motion: DrivelineMotion
    rest: list[Followed]  # what was found from other beginnings, if these had to be asked

    @property
    def chain(self) -> Chain:
        """The driveline."""
        return self.driven.chain

    @property
    def turns(self) -> int:
        """Revolutions of a cycle."""
        return self.driven.compiled.turns * self.motion.multiple


def solved_motion(machine: Machine, accuracy: float) -> SteadySolution:
    """Steady motion of an elastic driveline; raises as `elastic_motion`."""
    driven = ready(machine)
    motion, rest = solved(driven, accuracy)
    if abs(multipliers_of(motion, driven.chain)[0]) >= 1 and not motion.cycles:
        # Unstable: the motion that the machine comes to in time may be another one.
        compiled, chain, _ = driven
        other = steady_of(compiled, chain, accuracy, search(driven, AWAY))
        if isinstance(other, DrivelineMotion):
            motion = other
    return SteadySolution(driven, motion, rest)


def _with_others(
    found: ElasticMotion, motion: DrivelineMotion, chain: Chain, rest: list[Followed], turns: int
) -> ElasticMotion:
    """The motion with what the machine comes to from other beginnings."""
    known, listed = [motion], []
    start, chaotic = "", []
    for words, other, off in rest:
        if other is None:
            if off > 0:
                chaotic.append(
                    f"From {words} the motion does not repeat within {2 * FOLLOWED} cycles: the last ones "
                    f"differ by {number(100 * off, 2)} % at best; it is chaotic, or settles very slowly"
                )
        elif is_same(motion, other):
            start = start or words
        elif not any(is_same(one, other) for one in known):
            known.append(other)
            lead = chain.lead
            multiplier = float(np.abs(multipliers_of(other, chain)[0]))
            least, greatest = other.torque.least / lead, other.torque.greatest / lead
            listed.append(
                OtherMotion(turns * other.multiple, other.period, least, greatest, multiplier, words)
            )
    return replace(found, start=start, other_motions=tuple(listed), not_periodic=tuple(chaotic))


def result_of(
    machine: Machine, motion: DrivelineMotion, chain: Chain, phi: Floats, turns: int
) -> ElasticMotion:
    """The motion at crank angles [rad], with its torques judged."""
    curves = motion.curves(np.ascontiguousarray(phi, dtype=np.float64))
    at, ratio, lead, of_motor = chain.mass, chain.ratio, chain.lead, chain.motor_ratio
    found = ElasticMotion(
        crank_angle=phi,
        time=curves.time,
        stations=chain.stations,
        shafts=chain.shafts,
        motors=chain.motors,
        crank=chain.crank,
        ratio=ratio,
        speed=ratio[:, None] * curves.speed[at],
        acceleration=ratio[:, None] * curves.acceleration[at],
        torque=curves.torque / lead[:, None],
        twist=curves.twist * lead[:, None],
        torque_drive=curves.torque_drive.sum(axis=0),
        torque_motor=curves.torque_drive / of_motor[:, None],
        torque_load=curves.torque_load,
        speed_min_angle=motion.speed.least_at[at],
        speed_max_angle=motion.speed.greatest_at[at],
        torque_min_angle=motion.torque.least_at,
        torque_max_angle=motion.torque.greatest_at,
        backlash=2 * chain.links["gap"] * lead,
        multipliers=multipliers_of(motion, chain),
        accuracy=motion.accuracy,
        steps=motion.steps,
        turns=turns,
        cycles_followed=motion.cycles,
        notes=chain.notes,
        **measures(motion, chain, turns),
    )
    return judged(machine, found)


def measures(motion: Any, chain: Any, turns: int) -> dict[str, Any]:
    """Extremes, means and work of stations and shafts at their own speeds; tangents go through."""
    at, ratio, lead, of_motor = chain.mass, chain.ratio, chain.lead, chain.motor_ratio
    return {
        "speed_min": ratio * motion.speed.least[at],
        "speed_max": ratio * motion.speed.greatest[at],
        "acceleration_min": ratio * motion.acceleration.least[at],
        "acceleration_max": ratio * motion.acceleration.greatest[at],
        "torque_min": motion.torque.least / lead,
        "torque_max": motion.torque.greatest / lead,
        "torque_mean": motion.torque_mean / lead,
        "torque_rms": motion.torque_rms / lead,
        "twist_min": motion.twist.least * lead,
        "twist_max": motion.twist.greatest * lead,
        "power_dissipated": motion.loss / motion.period,
        "period": motion.period,
        "torque_motor_min": motion.torque_drive.least / of_motor,
        "torque_motor_max": motion.torque_drive.greatest / of_motor,
        "torque_motor_mean": motion.torque_drive_mean / of_motor,
        "power_motor": motion.energy_drive / motion.period,
        "energy_drive": motion.energy_drive.sum(axis=0) / turns,
        "energy_load": motion.energy_load / turns,
    }
