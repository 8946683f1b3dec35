r"""Steady motion of a torsionally flexible driveline that drives a mechanism of varying inertia.

The stations of the driveline, motor, gearbox and crank, have inertias and are joined by shafts with
stiffness k and damping c; the last one is the mechanism, with its reduced inertia J(φ) and load torque M_r:

.. math:: J_i \ddot\varphi_i = M_d(\dot\varphi_i) - \sum T, \qquad
    J(\varphi)\,\ddot\varphi + \tfrac12 J'(\varphi)\,\dot\varphi^2 = T - M_r(\varphi, \dot\varphi), \qquad
    T = k\,\Delta + c\,\dot\Delta

The solution that repeats after every cycle of the crank is found by Newton's method on all stages of a
collocation, not by waiting; the eigenvalues of the monodromy matrix are its Floquet multipliers.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from linkwright.drive.load_checks import require_same_turns, require_sound_loads
from linkwright.drive.reduction import NO_INERTIA
from linkwright.drive.steady_state import require_accuracy
from linkwright.driveline.chain import Chain, chain_of, fastest
from linkwright.driveline.permitted import TorqueJudgement, judged
from linkwright.kernel.arrays import Complexes, Floats
from linkwright.kernel.errors import ConvergenceError, InputError, SteadyStateError
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label, declared
from linkwright.kernel.result import Result
from linkwright.linkages.closure import require_full_turn, turn_angles
from linkwright.linkages.whole_cycle import over_whole_cycle
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine, compile_machine
from linkwright.machine.program.core import DrivelineMotion, NoDrivelineMotion
from linkwright.torsion.model.drive_train import STIFFNESS_KEYS

# Cycles of the crank that the motion is followed, at most, where Newton's method alone does not converge.
_CYCLES = 300

# Cycles that it is followed before where the motion found is unstable: another may be stable.
_AWAY = 100

# Cycles after which a motion that is followed may repeat, at most.
MULTIPLES = 8

# Angles of a revolution at which the minimum inertia is looked for.
_ANGLES = 36

_OWN = "At its own speed."


@dataclass(frozen=True)
class ElasticMotion(Result):
    """One cycle of steady motion of a torsionally flexible driveline; extremes are not those of the curves.

    Torques and twists are those of the shafts at their own speed, motions those of the stations; a torque is
    positive where the side of the motor drives.
    """

    crank_angle: Annotated[
        Floats, Label("crank angle", "φ", "rad", "Over a cycle, from 0 on.", shape="(n + 1,)")
    ]
    time: Annotated[Floats, Label("time", "t", "s", "From the start of the cycle.")]
    stations: Annotated[
        tuple[str, ...], About("What turns, from the motor on; the mechanism is on the crank.")
    ]
    shafts: Annotated[tuple[str, ...], About("What twists, from the motor on.")]
    ratio: Annotated[Floats, Label("speed over that of the crank", "i", "", shape="(stations,)")]
    speed: Annotated[Floats, Label("speed of each station", "ω", "rad/s", shape="(stations, n + 1)")]
    acceleration: Annotated[
        Floats, Label("acceleration of each station", "ε", "rad/s²", shape="(stations, n + 1)")
    ]
    torque: Annotated[Floats, Label("torque of each shaft", "T", "N m", _OWN, shape="(shafts, n + 1)")]
    twist: Annotated[Floats, Label("twist of each shaft", "Δ", "rad", _OWN, shape="(shafts, n + 1)")]
    torque_drive: Annotated[
        Floats,
        Label("driving torque referred to the crank", "M_d", "N m", "Of the motor, behind the gearbox."),
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
        names = {"(shafts,)": self.shafts, "(stations,)": self.stations}
        for name, (_, mark) in declared(type(self)).items():
            if isinstance(mark, Label) and mark.shape in names:
                values = getattr(self, name)
                results[name] = {
                    part: value if np.isfinite(value) else None
                    for part, value in zip(names[mark.shape], values.tolist(), strict=True)
                }
        return results


@public
def elastic_motion(
    machine: Machine, *, accuracy: float = 1e-9, n: int = 360, angles: Floats | None = None
) -> ElasticMotion:
    """Find the steady motion of a torsionally flexible driveline with its mechanism.

    Parameters
    ----------
    machine : Machine
        With a mechanism, a motor, and a [drive] of which something twists.
    accuracy : float
        Relative accuracy of speeds and twists, down to 1e-13.
    n : int
        Intervals of a revolution for the curves; extremes and means do not depend on it.
    angles : ndarray, shape (m,), optional
        Crank angles of the curves instead, within the cycle [rad].

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
        The crank comes to rest or turns back; says where.
    ConvergenceError
        No periodic motion was found, or not to the accuracy.
    InputError
        The machine has no motor, or nothing of its driveline twists.

    References
    ----------
    .. [1] Dresig and Holzweißig, Dynamics of Machinery, 2010, sections 2.3 and 4.3.
    """
    drive = machine.drive
    if drive is None or not drive.twists:
        raise InputError(
            f"{machine.name}: the driveline is rigid; expected one of {', '.join(STIFFNESS_KEYS)}"
        )
    if drive.motor is None:
        raise InputError(f"{machine.name}: steady motion needs a motor; add [drive.motor]")
    require_accuracy(accuracy)
    compiled = compile_machine(machine)
    require_full_turn(compiled, machine)
    compiled = over_whole_cycle(compiled)
    require_same_turns(machine)
    require_sound_loads(compiled, machine)
    chain = chain_of(machine)
    motion = _solved(compiled, chain, accuracy)
    multipliers = _multipliers(motion, chain)
    if abs(multipliers[0]) >= 1:
        # Unstable: the motion that the machine comes to in time may be another one.
        other = compiled.driveline(accuracy, **chain.links, **_search(compiled, chain, _AWAY))
        if isinstance(other, DrivelineMotion):
            motion, multipliers = other, _multipliers(other, chain)
    phi = turn_angles(n, compiled.turns * motion.multiple) if angles is None else angles
    return _result(machine, motion, chain, phi, compiled.turns, multipliers)


def _search(compiled: CompiledMachine, chain: Chain, cycles: int) -> dict[str, Any]:
    """Where the search begins, and for how long it follows the motion."""
    speed = compiled.speed_guess
    period = compiled.cycle / speed
    inertia = compiled.reductions(turn_angles(_ANGLES, compiled.turns)).inertia.min()
    return {
        "speed": speed,
        "fastest": fastest(chain, float(inertia), period),
        "cycles_first": cycles,
        "cycles_max": _CYCLES,
        "multiples": MULTIPLES if cycles or not chain.is_linear else 1,
        "start": None,
    }


def _solved(compiled: CompiledMachine, chain: Chain, accuracy: float) -> DrivelineMotion:
    motion = compiled.driveline(accuracy, **chain.links, **_search(compiled, chain, 0))
    if isinstance(motion, NoDrivelineMotion):
        raise _failure(motion, compiled, chain, accuracy)
    return motion


def _failure(
    motion: NoDrivelineMotion, compiled: CompiledMachine, chain: Chain, accuracy: float
) -> Exception:
    angles = turn_angles(360, compiled.turns)
    if not (compiled.reductions(angles).inertia - chain.links["apart"]).min() > 0:
        return SteadyStateError(NO_INERTIA)
    if motion.reason == "stops":
        turned = motion.crank_angle / (2 * np.pi)
        return SteadyStateError(
            f"no steady motion of the elastic driveline: started at {compiled.speed_guess:.4g} rad/s, the "
            f"crank comes to rest or turns back after {turned:.4g} revolutions, at φ = "
            f"{np.degrees(motion.crank_angle) % 360:.4g}°; choose a stiffer or more damped coupling, a "
            "larger flywheel or motor, or follow the motion in time (torsion_transient)"
        )
    if motion.reason == "not found":
        return ConvergenceError(
            f"no periodic motion of the elastic driveline was found: in {_CYCLES} cycles the motion does not "
            "come to one that Newton's method converges to; follow it in time (torsion_transient)",
            method="Newton's method",
            iterations=_CYCLES,
        )
    return ConvergenceError(
        "steady motion of the elastic driveline was found to a relative accuracy of "
        f"{motion.accuracy:.1e} only, {accuracy:g} is required, with at most 20 000 steps per cycle: leave "
        "out a stiffness that is rigid at this speed, give its shaft damping, smooth jumps of loads, or "
        "reduce the accuracy",
        method="collocation",
    )


def _multipliers(motion: DrivelineMotion, chain: Chain) -> Complexes:
    """From the largest on; without that by which a motor of constant speed keeps its speed."""
    found: Complexes = np.linalg.eigvals(motion.monodromy).astype(complex)
    found = found[np.argsort(-np.abs(found), kind="stable")]
    multipliers: Complexes = found if chain.links["held"] is None else found[:-1]
    return multipliers


def _result(
    machine: Machine, motion: DrivelineMotion, chain: Chain, phi: Floats, turns: int, multipliers: Complexes
) -> ElasticMotion:
    curves = motion.curves(np.ascontiguousarray(phi, dtype=np.float64))
    at, ratio, lead = chain.mass, chain.ratio, chain.lead
    found = ElasticMotion(
        crank_angle=phi,
        time=curves.time,
        stations=chain.stations,
        shafts=chain.shafts,
        ratio=ratio,
        speed=ratio[:, None] * curves.speed[at],
        acceleration=ratio[:, None] * curves.acceleration[at],
        torque=curves.torque / lead[:, None],
        twist=curves.twist * lead[:, None],
        torque_drive=curves.torque_drive,
        torque_load=curves.torque_load,
        speed_min=ratio * motion.speed.least[at],
        speed_max=ratio * motion.speed.greatest[at],
        speed_min_angle=motion.speed.least_at[at],
        speed_max_angle=motion.speed.greatest_at[at],
        acceleration_min=ratio * motion.acceleration.least[at],
        acceleration_max=ratio * motion.acceleration.greatest[at],
        torque_min=motion.torque.least / lead,
        torque_max=motion.torque.greatest / lead,
        torque_min_angle=motion.torque.least_at,
        torque_max_angle=motion.torque.greatest_at,
        torque_mean=motion.torque_mean / lead,
        torque_rms=motion.torque_rms / lead,
        twist_min=motion.twist.least * lead,
        twist_max=motion.twist.greatest * lead,
        power_dissipated=motion.loss / motion.period,
        period=motion.period,
        multipliers=multipliers,
        energy_drive=motion.energy_drive / (turns * motion.multiple),
        energy_load=motion.energy_load / (turns * motion.multiple),
        accuracy=motion.accuracy,
        steps=motion.steps,
        turns=turns * motion.multiple,
        cycles_followed=motion.cycles,
        notes=chain.notes,
    )
    return judged(machine, found)
