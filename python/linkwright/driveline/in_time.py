r"""Motion in time of a torsionally flexible driveline with its mechanism: start, stop, load steps.

.. math:: J_i \ddot\varphi_i = M_d(\dot\varphi_i) - \sum T, \qquad
    J(\varphi)\,\ddot\varphi + \tfrac12 J'(\varphi)\,\dot\varphi^2 = T - M_r(\varphi, \dot\varphi, t)

by DOP853, or Radau IIA where a shaft is nearly rigid, with exact events: kinks over the angle and over
speeds, the crank coming to rest under dry loads, and torn loose by the torque of its shaft; so too the motor
behind a gearbox whose losses hold it. The balance of energy measures what is returned.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from linkwright.drive.load_checks import require_half_turns, require_sound_loads
from linkwright.drive.model.motor import ConstantSpeedMotor, DcMotor, InductionMotor
from linkwright.drive.reduction import NO_INERTIA
from linkwright.drive.transient import require_motion
from linkwright.driveline.chain import Chain, Driven, chain_of
from linkwright.driveline.elastic_motion import ElasticMotion
from linkwright.driveline.permitted import TorqueJudgement, in_motion
from linkwright.driveline.solving import require_flexible
from linkwright.driveline.train_chain import driveline_chain, moving_train
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import ConvergenceError, InputError, SteadyStateError
from linkwright.kernel.public import public
from linkwright.kernel.public.arguments import array
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.linkages.closure import require_full_turn
from linkwright.linkages.law_jumps import require_finite_accelerations
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine, compile_machine
from linkwright.machine.program.core import DrivelineInTime
from linkwright.torsion.model.drive_train import MOTOR, brake_disc

_OWN = "At its own speed."

# Extremes that the core has of a motion.
_EXTREMES = ("speed", "acceleration", "torque", "twist")


# Share of the duration by which a time may be beyond the end of the motion.
_ROUNDING = 1e-12


@dataclass(frozen=True)
class DriveSwitch:
    """What changes at an instant of a motion in time.

    Attributes
    ----------
    time : float
        [s].
    motor, brake : bool or None
        Whether the motor is on and the brake applied from then on; None as before.
    machine : Machine or None
        The machine from then on, such as one with other loads by `replace`; None as before.
    """

    time: float
    motor: bool | None = None
    brake: bool | None = None
    machine: Machine | None = None


@dataclass(frozen=True)
class ElasticTransient(Result):
    """Motion in time of a torsionally flexible driveline; extremes are not those of the curves.

    Torques and twists are those of the shafts at their own speed, motions those of the stations; a torque is
    positive where the side of the motor drives.
    """

    time: Annotated[Floats, Label("time", "t", "s", "Ends of the steps, unless others are asked for.")]
    crank_angle: Annotated[Floats, Label("crank angle", "φ", "rad", "Continuous over the revolutions.")]
    stations: Annotated[
        tuple[str, ...], About("What turns, from the motor on; the mechanism is on the crank.")
    ]
    shafts: Annotated[tuple[str, ...], About("What twists, from the motor on.")]
    ratio: Annotated[Floats, Label("speed over that of the crank", "i", "", shape="(stations,)")]
    angle: Annotated[Floats, Label("angle of each station", "φ_i", "rad", shape="(stations, n)")]
    speed: Annotated[Floats, Label("speed of each station", "ω", "rad/s", shape="(stations, n)")]
    acceleration: Annotated[
        Floats, Label("acceleration of each station", "ε", "rad/s²", shape="(stations, n)")
    ]
    torque: Annotated[Floats, Label("torque of each shaft", "T", "N m", _OWN, shape="(shafts, n)")]
    twist: Annotated[Floats, Label("twist of each shaft", "Δ", "rad", _OWN, shape="(shafts, n)")]
    torque_drive: Annotated[
        Floats,
        Label("driving torque referred to the crank", "M_d", "N m", "Of all motors, behind their gearboxes."),
    ]
    motors: Annotated[tuple[str, ...], About("What drives.")]
    torque_motor: Annotated[
        Floats,
        Label("torque of each motor", "M_m", "N m", "At its speed, less gear losses.", shape="(motors, n)"),
    ]
    torque_load: Annotated[Floats, Label("load torque referred to the crank", "M_r", "N m")]
    speed_min: Annotated[Floats, Label("minimum speed", "ω_min", "rad/s", shape="(stations,)")]
    speed_max: Annotated[Floats, Label("maximum speed", "ω_max", "rad/s", shape="(stations,)")]
    speed_min_time: Annotated[Floats, Label("time of the minimum speed", "", "s", shape="(stations,)")]
    speed_max_time: Annotated[Floats, Label("time of the maximum speed", "", "s", shape="(stations,)")]
    acceleration_min: Annotated[Floats, Label("minimum acceleration", "ε_min", "rad/s²", shape="(stations,)")]
    acceleration_max: Annotated[Floats, Label("maximum acceleration", "ε_max", "rad/s²", shape="(stations,)")]
    torque_min: Annotated[Floats, Label("minimum torque", "T_min", "N m", _OWN, shape="(shafts,)")]
    torque_max: Annotated[Floats, Label("maximum torque", "T_max", "N m", _OWN, shape="(shafts,)")]
    torque_min_time: Annotated[Floats, Label("time of the minimum torque", "", "s", shape="(shafts,)")]
    torque_max_time: Annotated[Floats, Label("time of the maximum torque", "", "s", shape="(shafts,)")]
    twist_min: Annotated[Floats, Label("minimum twist", "Δ_min", "rad", _OWN, shape="(shafts,)")]
    twist_max: Annotated[Floats, Label("maximum twist", "Δ_max", "rad", _OWN, shape="(shafts,)")]
    energy_dissipated: Annotated[
        Floats,
        Label("heat of each shaft", "Q", "J", "What its damping turns into heat.", shape="(shafts,)"),
    ]
    energy_motor: Annotated[
        float, Label("work of the motor", "A_M", "J", "At its shaft.", table="elastic_transient")
    ]
    energy_drive: Annotated[float, Label("work behind the gearbox", "A_d", "J", table="elastic_transient")]
    energy_load: Annotated[float, Label("work of the loads", "A_r", "J", table="elastic_transient")]
    energy_brake: Annotated[float, Label("work of the brake", "A_b", "J", table="elastic_transient")]
    energy_kinetic: Annotated[float, Label("gain of kinetic energy", "ΔE", "J", table="elastic_transient")]
    energy_elastic: Annotated[float, Label("gain of strain energy", "ΔU", "J", table="elastic_transient")]
    heat_motor: Annotated[
        float | None,
        Label(
            "heat of the rotor",
            "Q_M",
            "J",
            "∫ M (ω₀ − ω) dt of an induction or DC motor without a limit of its torque; None for others.",
            table="elastic_transient",
        ),
    ]
    accuracy: Annotated[float, Label("relative accuracy of a step", "", "")]
    energy_error: Annotated[
        float,
        Label(
            "energy-balance residual",
            "",
            "",
            "Largest gain of energy, less works, over the largest of energies and works.",
            table="elastic_transient",
        ),
    ]
    steps: Annotated[int, Label("steps", "", "")]
    steps_implicit: Annotated[
        int, Label("steps by the implicit method", "", "", "Where stability would limit the explicit ones.")
    ]
    evaluations: Annotated[int, Label("evaluations of the machine", "", "")]
    end: Annotated[str, About("How it ended: `time`, `turns` or `rest`.")]
    torque_drive_end: Annotated[
        float,
        Label("driving torque at the crank at the end", "", "N m", "What the drive gives at rest."),
    ]
    torque_load_end: Annotated[
        float,
        Label("load torque referred to the crank at the end", "", "N m", "What the loads need at rest."),
    ]
    state_end: Annotated[
        Floats, About("Twists and speeds against the crank, its speed and angle.", "(2 masses,)")
    ]
    slips: Annotated[Floats, Label("times at which the crank leaves rest", "", "s", over="slips")]
    judgements: Annotated[tuple[TorqueJudgement, ...], About("Torques against what is permitted.")] = ()
    notes: Annotated[tuple[str, ...], About("What was assumed.")] = ()

    @property
    def findings(self) -> list[str]:
        """Limits that are exceeded, in sentences."""
        return [f"{judgement.words}." for judgement in self.judgements if not judgement.is_kept]

    @property
    def turns(self) -> Annotated[float, Label("revolutions of the crank", "n", "")]:
        """Revolutions of the crank from start to end, in whichever direction."""
        return abs(float(self.state_end[-1] - self.crank_angle[0])) / (2 * np.pi)

    @property
    def duration(
        self,
    ) -> Annotated[float, Label("duration", "", "s", table="elastic_transient", before="energy_motor")]:
        """Time at the end of the motion."""
        return float(self.time[-1])

    @property
    def torque_peak(
        self,
    ) -> Annotated[Floats, Label("peak torque", "T_peak", "N m", shape="(shafts,)")]:
        """Largest absolute torque of each shaft."""
        return np.maximum(self.torque_max, -self.torque_min)

    @property
    def torque_peak_time(
        self,
    ) -> Annotated[Floats, Label("time of the peak torque", "", "s", shape="(shafts,)")]:
        """When it is reached."""
        return np.where(self.torque_max >= -self.torque_min, self.torque_max_time, self.torque_min_time)

    @property
    def heat_gearbox(
        self,
    ) -> Annotated[
        float, Label("heat of the gearbox", "Q_G", "J", table="elastic_transient", before="energy_load")
    ]:
        """Work of the motor at its shaft, less that behind the gearbox."""
        return self.energy_motor - self.energy_drive

    @property
    def came_to_rest(self) -> bool:
        """Whether everything stands at the end, and nothing moves it."""
        return self.end == "rest"

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """As `Result.to_dict`; extremes by name of shaft and station."""
        results = super().to_dict(curves=curves)
        results["judgements"] = [judgement.to_dict() for judgement in self.judgements]
        return results | self.parts_by_name()


@public
def elastic_transient(
    machine: Machine,
    *,
    angle: float = 0.0,
    speed: float = 0.0,
    duration: float = np.inf,
    turns: float = np.inf,
    accuracy: float = 1e-9,
    motor: bool = True,
    brake: bool = False,
    clockwise: bool = False,
    start: ElasticMotion | ElasticTransient | None = None,
    switches: Sequence[DriveSwitch] = (),
    times: ArrayLike | None = None,
) -> ElasticTransient:
    """Compute the motion in time of a torsionally flexible driveline with its mechanism.

    Parameters
    ----------
    machine : Machine
        With a mechanism and a [drive] of which something twists, or a train with mechanisms.
    angle, speed : float
        Angle [rad] and speed [rad/s] of the crank at the start, at which all turns and nothing is twisted.
    duration : float
        Longest time [s].
    turns : float
        Most revolutions of the crank; one of the two must be finite.
    accuracy : float
        Relative accuracy of a step, at its end and on the way there.
    motor, brake : bool
        Whether the motor is on and the brake applied.
    clockwise : bool
        Whether the motor drives the crank clockwise.
    start : ElasticMotion or ElasticTransient, optional
        The motion starts from the first angle of this steady motion, or from the end of this motion in time.
    switches : sequence of DriveSwitch
        What changes on the way, in the order of time.
    times : array_like, optional
        Times of the curves [s], in place of the ends of the steps.

    Returns
    -------
    ElasticTransient
        The motion until time or turns are over, or everything is at rest.

    Raises
    ------
    AssemblyError
        The motion reaches an angle at which the mechanism does not close.
    ConvergenceError
        The accuracy cannot be kept.
    InputError
        Nothing of the driveline twists, neither duration nor turns is finite, or the motor keeps its speed.

    References
    ----------
    .. [1] Hairer, Nørsett, Wanner, Solving Ordinary Differential Equations I, II.5 (DOP853).
    .. [2] Hairer, Wanner, Solving Ordinary Differential Equations II, IV.5 (Radau IIA, for stiff drives).
    .. [3] Dresig and Holzweißig, Dynamics of Machinery, 2010, sections 2.3 and 4.3.
    """
    require_motion(angle, speed, (duration, turns), accuracy)
    moving = followed(
        machine,
        _state(machine, start, (angle, speed)),
        limits=(duration, turns),
        accuracy=accuracy,
        motor=motor,
        brake=brake,
        sense=-1.0 if clockwise else 1.0,
        switches=switches,
    )
    return moving.result(None if times is None else _within(array("times", times), moving.ends[-1]))


def _within(times: Floats, last: float) -> Floats:
    """Times of the motion; those that rounding put beyond an end are at that end."""
    inside = np.clip(times, 0.0, last)
    beyond = np.abs(times - inside) > _ROUNDING * last
    if times.ndim != 1 or beyond.any():
        raise InputError(f"times: expected times from 0 s to {last:.6g} s, when the motion ends")
    return inside


_WORKS = ("work_shaft", "impulse", "work_drive", "work_load", "work_brake", "heat")
_CURVES = (
    "angle",
    "speed",
    "acceleration",
    "twist",
    "torque",
    "torque_drive",
    "torque_load",
    "energy_kinetic",
    "energy_elastic",
    *_WORKS,
)


class _Stretch(NamedTuple):
    """A motion between two switches."""

    motion: DrivelineInTime
    machine: Machine
    chain: Chain


@dataclass
class Followed:
    """A motion in time, stretch by stretch, of which curves are read."""

    accuracy: float
    sense: float  # +1 or −1, the direction in which the motor drives
    stretches: list[_Stretch] = field(default_factory=list)

    @property
    def last(self) -> DrivelineInTime:
        """The last stretch."""
        return self.stretches[-1].motion

    @property
    def ends(self) -> Floats:
        """Ends of all steps [s]."""
        parts = [each.motion.time for each in self.stretches]
        return np.concatenate([parts[0], *(part[1:] for part in parts[1:])])

    def curves(self, times: Floats, names: Sequence[str] = _CURVES) -> dict[str, Floats]:
        """Curves of masses and links at times, all referred to the crank; works from the start on."""
        bounds = [each.motion.time[-1] for each in self.stretches[:-1]]
        which = np.searchsorted(bounds, times, side="left")
        found: dict[str, Floats] = {}
        before: dict[str, Floats] = {}
        for k, each in enumerate(self.stretches):
            at = which == k
            # The last number is the end of the stretch, up to which works add up.
            asked = np.append(times[at], each.motion.time[-1])
            core = each.motion.curves(np.ascontiguousarray(asked))
            for name in names:
                values = getattr(core, name)
                if name in _WORKS:
                    values = values + before.get(name, 0.0)
                    before[name] = values[..., -1:]
                found.setdefault(name, np.empty((*values.shape[:-1], len(times))))[..., at] = values[..., :-1]
        return found

    def result(self, times: Floats | None = None, words: str = "in this motion in time") -> ElasticTransient:
        """The motion with its curves, extremes and energies; `words`: what judgements call it."""
        found = _result(self, self.ends if times is None else times)
        return in_motion(self.stretches[-1].machine, found, words)


def followed(
    machine: Machine,
    state: Floats,
    *,
    limits: tuple[float, float],
    accuracy: float,
    motor: bool = True,
    brake: bool = False,
    sense: float = 1.0,
    switches: Sequence[DriveSwitch] = (),
    after: Followed | None = None,
) -> Followed:
    """The motion from a state of masses against the crank until a time and a number of revolutions.

    `after`: a motion that it goes on from, and becomes part of.
    """
    duration, turns = limits
    moving = Followed(accuracy, sense) if after is None else after
    time = 0.0 if after is None else float(after.last.time[-1])
    state = state if after is None else after.last.state
    first = float(state[-1])
    ends = [*(switch.time for switch in switches), duration]
    if any(later <= earlier for earlier, later in zip([time, *ends], ends, strict=False)):
        raise InputError("switches: expected increasing times above 0, before the duration")
    for switch, until in zip([DriveSwitch(time), *switches], ends, strict=True):
        machine = switch.machine or machine
        motor = motor if switch.motor is None else switch.motor
        brake = brake if switch.brake is None else switch.brake
        compiled, chain, speed = ready_in_time(machine, motor=motor)
        if moving.stretches:
            _require_same_driveline(moving.stretches[0].chain, chain)
        left = turns - abs(float(state[-1]) - first) / (2 * np.pi)
        motion = compiled.driveline_in_time(
            chain.core,
            state=np.ascontiguousarray(state),
            brakes=_brakes(machine, chain) if brake else np.zeros(len(chain.links["inertia"]) + 1),
            time=time,
            motor=sense,
            speed=speed,
            until=until,
            turns=left,
            accuracy=accuracy,
        )
        _require_end(motion, compiled, machine, chain, accuracy)
        moving.stretches.append(_Stretch(motion, machine, chain))
        state, time = motion.state, float(motion.time[-1])
        if motion.end == "turns" or (motion.end == "rest" and until == ends[-1]):
            break
        if motion.end == "rest":
            # What stands is taken on at the next switch.
            time = until
    return moving


def ready_in_time(machine: Machine, *, motor: bool = True) -> Driven:
    """A machine with an elastic driveline that moves in time, in the core's terms, with its speed at work."""
    if machine.has_mounted_mechanisms:
        return moving_train(machine, motor=motor)
    require_flexible(machine)
    drive = machine.drive
    assert drive is not None
    if isinstance(drive.motor, ConstantSpeedMotor):
        raise InputError("a constant-speed motor has no run-up: it keeps its speed under any load")
    if drive.gearbox.locks:
        raise InputError(
            "drive.gearbox.reverse: found 0, a self-locking gearbox, which has no motion in time behind "
            "a flexible shaft; give it the factor of a gearbox that is not self-locking"
        )
    compiled = compile_machine(machine, motor=motor)
    require_half_turns(compiled, machine)
    require_finite_accelerations(machine)
    return Driven(compiled, chain_of(machine), compiled.speed_guess)


def _require_same_driveline(chain: Chain, other: Chain) -> None:
    """Raise if a switch changes what the driveline consists of."""
    if (chain.stations, chain.shafts) != (other.stations, other.shafts):
        raise InputError(
            f"switches: found a machine with the shafts {', '.join(other.shafts)}, expected "
            f"{', '.join(chain.shafts)} as at the start"
        )


def _brakes(machine: Machine, chain: Chain) -> Floats:
    """Torque of the brake on every mass, at the speed of the crank: it acts where it stands."""
    torques = np.zeros(len(chain.links["inertia"]) + 1)
    drive = machine.drive
    if drive is not None and drive.brake is not None:
        mass = chain.mass[chain.stations.index(brake_disc(drive))]
        torques[mass] = drive.brake.torque * (drive.gearbox.ratio if drive.brake.on == MOTOR else 1.0)
    return torques


def _require_end(
    motion: DrivelineInTime, compiled: CompiledMachine, machine: Machine, chain: Chain, accuracy: float
) -> None:
    if motion.end == "does not close":
        if machine.has_mounted_mechanisms:
            raise SteadyStateError(NO_INERTIA)
        require_full_turn(compiled, machine)
        require_sound_loads(compiled, machine)
        raise SteadyStateError(NO_INERTIA)
    if motion.end == "inaccurate":
        raise ConvergenceError(
            f"the integration stopped at {motion.time[-1]:.6g} s: steps became too small or too many for an "
            f"accuracy of {accuracy:g}; leave out a stiffness that is rigid at this speed, give its shaft "
            "damping, smooth jumps of loads, or reduce the accuracy",
            method="DOP853 and Radau IIA",
            iterations=len(motion.time),
        )


def _state(
    machine: Machine, start: ElasticMotion | ElasticTransient | None, at_rest: tuple[float, float]
) -> Floats:
    """Twists and speeds of the masses against the crank, its speed and angle."""
    if isinstance(start, ElasticTransient):
        return start.state_end
    require_flexible(machine)
    chain = driveline_chain(machine)
    masses = len(chain.links["inertia"]) + 1
    angle, speed = at_rest
    twists, speeds = np.zeros(masses - 1), np.full(masses, float(speed))
    if start is not None:
        angle = float(start.crank_angle[0])
        twists[:] = np.linalg.lstsq(chain.joins[:, :-1], start.twist[:, 0] / chain.lead, rcond=None)[0]
        speeds[chain.mass] = start.speed[:, 0] / chain.ratio
    state: Floats = np.concatenate([twists, speeds[:-1] - speeds[-1], [speeds[-1], angle]])
    return state


def _result(moving: Followed, times: Floats) -> ElasticTransient:
    machine, chain, last = moving.stretches[-1].machine, moving.stretches[-1].chain, moving.last
    curves = moving.curves(np.append(times, last.time[-1]))
    ends = {name: values[..., -1] for name, values in curves.items()}
    start = moving.stretches[0].motion.curves(moving.stretches[0].motion.time[:1])
    curves = {name: values[..., :-1] for name, values in curves.items()}
    at, ratio, lead = chain.mass, chain.ratio, chain.lead
    return ElasticTransient(
        time=times,
        crank_angle=curves["angle"][-1],
        stations=chain.stations,
        shafts=chain.shafts,
        ratio=ratio,
        angle=ratio[:, None] * curves["angle"][at],
        speed=ratio[:, None] * curves["speed"][at],
        acceleration=ratio[:, None] * curves["acceleration"][at],
        torque=curves["torque"] / lead[:, None],
        twist=curves["twist"] * lead[:, None],
        motors=chain.motors,
        torque_drive=curves["torque_drive"].sum(axis=0),
        torque_motor=curves["torque_drive"] / chain.motor_ratio[:, None],
        torque_load=curves["torque_load"],
        **_extremes(moving, chain),
        energy_dissipated=ends["heat"],
        energy_motor=float(ends["work_shaft"]),
        energy_drive=float(ends["work_drive"]),
        energy_load=float(ends["work_load"]),
        energy_brake=float(ends["work_brake"]),
        energy_kinetic=float(ends["energy_kinetic"] - start.energy_kinetic[0]),
        energy_elastic=float(ends["energy_elastic"] - start.energy_elastic[0]),
        heat_motor=_heat(machine, chain, ends, moving.sense),
        accuracy=moving.accuracy,
        energy_error=max(each.motion.energy_error for each in moving.stretches),
        steps=sum(len(each.motion.time) - 1 for each in moving.stretches),
        steps_implicit=sum(each.motion.implicit for each in moving.stretches),
        evaluations=sum(each.motion.evaluations for each in moving.stretches),
        end=last.end,
        torque_drive_end=last.torque_drive_end,
        torque_load_end=last.torque_load_end,
        state_end=last.state,
        slips=np.array(list(_slips(moving))),
        notes=chain.notes,
    )


def _extremes(moving: Followed, chain: Chain) -> dict[str, Any]:
    """Extremes over all stretches, with times, at the own speed of each part."""
    factors = {"torque": 1 / chain.lead, "twist": chain.lead}
    found: dict[str, Floats] = {}
    for name in _EXTREMES:
        parts = [getattr(each.motion, name) for each in moving.stretches]
        low, high = (np.array([getattr(part, side) for part in parts]) for side in ("least", "greatest"))
        times = (np.array([getattr(part, f"{side}_at") for part in parts]) for side in ("least", "greatest"))
        for side, values, pick, at in zip(
            ("min", "max"), (low, high), (np.argmin, np.argmax), times, strict=True
        ):
            best = pick(values, axis=0)[None]
            value, when = (np.take_along_axis(of, best, axis=0)[0] for of in (values, at))
            if name in factors:
                found[f"{name}_{side}"] = value * factors[name]
            else:
                # What the accuracy leaves of a speed at rest is none.
                value = np.where(np.abs(value) > moving.accuracy * np.abs([low, high]).max(), value, 0.0)
                found[f"{name}_{side}"] = value[chain.mass] * chain.ratio
                when = when[chain.mass]
            if name in ("speed", "torque"):
                found[f"{name}_{side}_time"] = when
    return found


def _heat(machine: Machine, chain: Chain, ends: Mapping[str, Floats], sense: float) -> float | None:
    """Heat of rotors: their torques times what they lag behind the field, or the speed without load."""
    motors = [_motor(machine, name) for name in chain.motors]
    if not all(
        isinstance(motor, InductionMotor) or (isinstance(motor, DcMotor) and motor.torque_max is None)
        for motor in motors
    ):
        return None
    without_load = [float(motor.speed_without_load) for motor in motors] / chain.motor_ratio
    return float(sense * without_load @ ends["impulse"] - ends["work_shaft"])


def _motor(machine: Machine, name: str) -> Any:
    """A motor by its name; None of a driver that is none."""
    if machine.train is not None:
        return machine.train.motors[name].motor if name in machine.train.motors else None
    return machine.drive.motor if machine.drive is not None else None


def _slips(moving: Followed) -> Iterator[float]:
    """Times at which the crank leaves rest."""
    for each in moving.stretches:
        crank = len(each.chain.links["inertia"])
        for at, what, mass in each.motion.events:
            if what == "slip" and mass == crank:
                yield float(each.motion.time[at])
