r"""Motion of a train in time: start, stop, resonance passed, step of load, misfire, short circuit.

.. math:: J(\theta)\,\ddot\theta + \tfrac12 J'(\theta)\,\dot\theta^2 + \sum M_\mathrm{shaft} = \sum M

with the inertia of every throw and mechanism as it changes with the angle, and couplings of any curve. Steps
are chosen by their error; none goes over a switch.

References
----------
.. [1] Hairer, Nørsett, Wanner, Solving Ordinary Differential Equations I, II.5, and II, IV.8: DOP853 and
RADAU5.
.. [2] Eksergian, Dynamical analysis of machines, J. Franklin Inst. 209 (1930): inertia that changes with the
angle.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, field, replace
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from linkwright.kernel.arrays import Floats, Integers
from linkwright.kernel.errors import ConvergenceError, InputError
from linkwright.kernel.limits import SAMPLES
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result, finite
from linkwright.machine.machine import Machine
from linkwright.torsion.core.transient import MovingTrain, TrainMotion
from linkwright.torsion.in_time.engaged_start import EngagedStart, engaged_start, is_asked, slipping_notes
from linkwright.torsion.in_time.friction_parts import start_speeds
from linkwright.torsion.in_time.ice_impacts import (
    IceMilling,
    IceStart,
    IceStarts,
    ice_events,
    ice_notes,
    is_outrun,
    milled,
    turns_needed,
    within_limit,
)
from linkwright.torsion.in_time.moving_drive import moving_drive
from linkwright.torsion.in_time.moving_parts import joint_leads
from linkwright.torsion.in_time.moving_train import moving_train
from linkwright.torsion.in_time.peak_judgement import PeakJudgement, judged, unjudged
from linkwright.torsion.in_time.stage_torque import stage_torques
from linkwright.torsion.in_time.steady_start import balanced_start, loaded_angles
from linkwright.torsion.model.train import Train
from linkwright.torsion.model.train_transient import TrainTransient
from linkwright.torsion.model.whole_train import whole_train

# Samples of a motion where nothing is said, and their maximum distance [s]: order 24 at 2500 rpm is a
# kilohertz.
_SAMPLES = 4000
_SAMPLE_TIME = 5e-4

# Time that a motion is followed at least to find its first angle [s].
_INSTANT = 1e-3

# Time in which a running train swings in before its manoeuvre [s]: modes of some hundred hertz with a
# damping of one per cent are down to a thousandth.
_SETTLE = 1.0


@dataclass(frozen=True)
class TorsionTransient(Result):
    """Motion of a train in time."""

    time: Annotated[Floats, Label("time", "t", "s", "Of the samples.")]
    discs: Annotated[tuple[str, ...], About("Discs in the order of the file.")]
    angle: Annotated[Floats, Label("angle of each disc", "φ", "rad", "In its own sense.", shape="(discs, n)")]
    speed: Annotated[
        Floats, Label("speed of each disc", "ω", "rad/s", "In its own sense.", shape="(discs, n)")
    ]
    shafts: Annotated[tuple[str, ...], About("What twists.")]
    torque: Annotated[
        Floats,
        Label(
            "torque in each shaft",
            "M",
            "N m",
            "At its own speed, with its damping; positive if the first end drives the second.",
            shape="(shafts, n)",
        ),
    ]
    kinetic_energy: Annotated[Floats, Label("kinetic energy", "", "J")]
    potential_energy: Annotated[Floats, Label("potential energy", "", "J")]
    torque_max: Annotated[
        Floats,
        Label(
            "maximum torque in each shaft",
            "M_max",
            "N m",
            "Of the whole motion, between the samples as well.",
            shape="(shafts,)",
        ),
    ]
    torque_max_time: Annotated[Floats, Label("time of the maximum torque", "", "s", shape="(shafts,)")]
    torque_min: Annotated[
        Floats,
        Label(
            "minimum torque in each shaft",
            "M_min",
            "N m",
            "Of the whole motion, between the samples as well.",
            shape="(shafts,)",
        ),
    ]
    torque_min_time: Annotated[Floats, Label("time of the minimum torque", "", "s", shape="(shafts,)")]
    speed_max: Annotated[
        Floats,
        Label(
            "maximum speed of each disc",
            "ω_max",
            "rad/s",
            "Of the whole motion, between the samples as well.",
            shape="(discs,)",
        ),
    ]
    speed_max_time: Annotated[Floats, Label("time of the maximum speed", "", "s", shape="(discs,)")]
    speed_min: Annotated[
        Floats,
        Label(
            "minimum speed of each disc",
            "ω_min",
            "rad/s",
            "Of the whole motion, between the samples as well.",
            shape="(discs,)",
        ),
    ]
    speed_min_time: Annotated[Floats, Label("time of the minimum speed", "", "s", shape="(discs,)")]
    work: Annotated[dict[str, float], About("Work of each torque from outside [J].")]
    loss: Annotated[
        dict[str, float],
        About(
            'Loss in each shaft, clutch, brake and freewheel, by the damping of the discs, "discs", and by '
            'damping ratios, "modes" [J].'
        ),
    ]
    energy_error: Annotated[
        float,
        Label(
            "error of the energy",
            "",
            "",
            "Gain of energy less work and losses, over the largest of these.",
        ),
    ]
    method: Annotated[str, About('``"explicit"`` or ``"implicit"``.')]
    steps: Annotated[int, Label("steps", "", "")]
    steps_rejected: Annotated[int, Label("rejected steps", "", "")]
    evaluations: Annotated[int, Label("evaluations of the train", "", "")]
    frequency_bound: Annotated[float, Label("bound of the highest frequency at the start", "", "Hz")]
    notes: Annotated[tuple[str, ...], About("What was assumed.")]
    balance: Annotated[
        str, About("Changes that balance the mean torques at the start; empty if there are none.")
    ] = ""
    judgements: Annotated[
        tuple[PeakJudgement, ...],
        About("Limits of shafts, couplings and gear stages against the largest torques."),
    ] = ()
    stages: Annotated[tuple[str, ...], About("Gear stages.")] = ()
    stage_torque: Annotated[
        Floats,
        Label(
            "torque of each gear stage",
            "M",
            "N m",
            "At its first disc, positive if that drives; NaN where rigid stages close a loop.",
            shape="(stages, n)",
        ),
    ] = field(default_factory=lambda: np.zeros((0, 0)))
    pendulums: Annotated[tuple[str, ...], About("Centrifugal pendulums.")] = ()
    swing: Annotated[
        Floats,
        Label(
            "swing of each pendulum",
            "ψ",
            "rad",
            "Relative to the disc that carries it, of any size.",
            shape="(pendulums, n)",
        ),
    ] = field(default_factory=lambda: np.zeros((0, 0)))
    ice: Annotated[tuple[IceMilling, ...], About("Ice that the propeller met.")] = ()
    frictions: Annotated[tuple[str, ...], About("Clutches, brakes and freewheels.")] = ()
    friction_torque: Annotated[
        Floats,
        Label(
            "torque of each clutch, brake and freewheel",
            "T",
            "N m",
            "Positive if the first end drives the second, or a brake resists forward motion.",
            shape="(frictions, n)",
        ),
    ] = field(default_factory=lambda: np.zeros((0, 0)))
    slip: Annotated[
        Floats,
        Label(
            "slip of each clutch, brake and freewheel",
            "s",
            "rad/s",
            "Speed of the first end less that of the second.",
            shape="(frictions, n)",
        ),
    ] = field(default_factory=lambda: np.zeros((0, 0)))
    friction_state: Annotated[
        Integers,
        About("0 open, 1 stuck or locked, 2 sliding forward, 3 sliding backward; (frictions, n)."),
    ] = field(default_factory=lambda: np.zeros((0, 0), np.int32))
    friction_torque_max: Annotated[
        Floats,
        Label(
            "peak friction torque",
            "T_max",
            "N m",
            "Largest size in the whole motion, between the samples as well.",
            shape="(frictions,)",
        ),
    ] = field(default_factory=lambda: np.zeros(0))
    friction_torque_max_time: Annotated[
        Floats, Label("time of the peak friction torque", "", "s", shape="(frictions,)")
    ] = field(default_factory=lambda: np.zeros(0))
    friction_heat: Annotated[Floats, Label("friction work, lost as heat", "Q", "J", shape="(frictions,)")] = (
        field(default_factory=lambda: np.zeros(0))
    )
    friction_power_max: Annotated[
        Floats,
        Label(
            "peak friction power",
            "P_max",
            "W",
            "Of the whole motion, between the samples as well.",
            shape="(frictions,)",
        ),
    ] = field(default_factory=lambda: np.zeros(0))
    engagements: Annotated[
        Integers, Label("engagements: how often slip ended", "", "", shape="(frictions,)")
    ] = field(default_factory=lambda: np.zeros(0, np.int32))
    slip_time: Annotated[Floats, Label("slipping time", "t_s", "s", shape="(frictions,)")] = field(
        default_factory=lambda: np.zeros(0)
    )
    stuck_time: Annotated[Floats, Label("time stuck or locked", "", "s", shape="(frictions,)")] = field(
        default_factory=lambda: np.zeros(0)
    )

    @property
    def findings(self) -> list[str]:
        """Limits that are exceeded, in sentences."""
        return [f"{judgement.words}." for judgement in self.judgements if not judgement.is_kept]

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Extremes by name of shaft and disc; with ``curves`` also the samples."""
        results = super().to_dict(curves=curves) | {"work": self.work, "loss": self.loss}
        results["judgements"] = [judgement.to_dict() for judgement in self.judgements]
        stages = {
            name: {"torque_max": float(row.max()), "torque_min": float(row.min())}
            for name, row in zip(self.stages, self.stage_torque, strict=True)
        }
        results["stages"] = finite(stages)
        results["pendulums"] = {
            name: {"swing_max": float(np.abs(row).max())}
            for name, row in zip(self.pendulums, self.swing, strict=True)
        }
        results["ice"] = [asdict(one) for one in self.ice]
        return results | self.parts_by_name()


@public
def torsion_transient(machine: Machine, manoeuvre: TrainTransient | None = None) -> TorsionTransient:
    """Follow a manoeuvre of a train in time.

    Parameters
    ----------
    machine : Machine
        With a [train], or with a torsionally flexible driveline.
    manoeuvre : TrainTransient, optional
        Default: that of the file, [train.transient]; a driveline needs one. Speeds are those of the first
        disc, of a driveline those of the motor.

    Returns
    -------
    TorsionTransient
        Speeds of all discs and torques in all shafts.

    Raises
    ------
    InputError
        There is no train, or no manoeuvre, or it does not fit the train.
    AssemblyError
        The mechanism behind the driveline does not close all round.
    ConvergenceError
        The accuracy cannot be kept, or needs too many steps.
    """
    if manoeuvre is None and machine.train is not None:
        manoeuvre = machine.train.transient
    if manoeuvre is None:
        remedy = 'give [train.transient] with a duration, such as "2 s"'
        raise InputError(f"{machine.name} has no manoeuvre: {remedy}")
    if machine.train is None:
        train, manoeuvre = moving_drive(machine, manoeuvre)
        moved = _followed(_Start(train, manoeuvre.speed), manoeuvre)
    else:
        motors = {**machine.train.motors, **manoeuvre.motors}
        moved = _train_moved(machine.train, manoeuvre.model_copy(update={"motors": motors}))
    notes = (*moved.notes, *unjudged(machine, moved))
    return replace(moved, judgements=judged(machine, moved), notes=notes)


def _train_moved(train: Train, manoeuvre: TrainTransient) -> TorsionTransient:
    """The motion of a train: up to each ice first, since its pulses follow the angle of the propeller."""
    starts: dict[int, IceStart] = {}
    listed = ice_events(manoeuvre)
    for n, event in listed:
        before = _moved_with(train, manoeuvre, starts, max(event.time, _INSTANT))
        at, disc = int(np.abs(before.time - event.time).argmin()), before.discs.index(event.on)
        speed = float(before.speed[disc, at])
        turns = turns_needed(event, speed, manoeuvre.duration - event.time)
        starts[n] = IceStart(float(before.angle[disc, at]), turns)
    while True:
        moved = _moved_with(train, manoeuvre, starts, manoeuvre.duration)
        outrun = [
            n
            for n, event in listed
            if is_outrun(event, starts[n], moved.angle[moved.discs.index(event.on), moved.time >= event.time])
        ]
        if not outrun:
            break
        starts |= {n: starts[n]._replace(turns=within_limit(2 * starts[n].turns)) for n in outrun}
    ice = tuple(
        milled(
            event,
            starts[n],
            moved.time,
            *(curve[moved.discs.index(event.on)] for curve in (moved.angle, moved.speed)),
        )
        for n, event in listed
    )
    return replace(moved, ice=ice, notes=(*moved.notes, *ice_notes(ice)))


def _moved_with(train: Train, manoeuvre: TrainTransient, ice: IceStarts, duration: float) -> TorsionTransient:
    begun = _started(moving_train(train, manoeuvre, ice), train, manoeuvre, ice)
    moving, balance = begun.moving, begun.words
    moved = _followed(begun, manoeuvre.model_copy(update={"duration": duration}))
    if duration < manoeuvre.duration or not train.gears:
        return replace(moved, balance=balance)
    gears, first = whole_train(train).gears, np.unique(moving.mass, return_index=True)[1]
    n = moving.speed[first, None]
    torque = stage_torques(
        moving,
        gears,
        moved.time,
        moved.angle[first] / n,
        moved.speed[first] / n,
        moved.torque,
        moved.friction_torque,
    )
    return replace(moved, balance=balance, stages=tuple(gears), stage_torque=torque)


class _Start(NamedTuple):
    """A train as its motion begins."""

    moving: MovingTrain
    speed: ArrayLike  # () or (masses,) [rad/s]
    words: str = ""  # what balances it
    engaged: EngagedStart | None = None  # a train with friction in steady running


def _started(moving: MovingTrain, train: Train, manoeuvre: TrainTransient, ice: IceStarts) -> _Start:
    """A train, its speeds at the start, and what balances it; open clutches leave open what would."""
    if not moving.frictions:
        return _Start(*balanced_start(moving, train, manoeuvre))
    if not is_asked(manoeuvre):
        return _Start(moving, start_speeds(moving, manoeuvre))
    engaged = engaged_start(moving, train, manoeuvre, ice)
    return _Start(engaged.moving, engaged.speed, engaged.words, engaged)


def _followed(start: _Start, manoeuvre: TrainTransient) -> TorsionTransient:
    """The motion as the manoeuvre asks for it."""
    train, engaged = start.moving, start.engaged
    loaded = manoeuvre.loaded and manoeuvre.speed > 0 and not manoeuvre.twists
    settle = _settling_time(manoeuvre)
    if engaged is not None:
        angle, loaded = engaged.angles(_start_angles(engaged.rigid, manoeuvre), loaded=loaded), False
    else:
        angle = _start_angles(train, manoeuvre)
        if train.frictions:
            # Torques that set in at the start are part of a motion with friction.
            loaded, settle = False, manoeuvre.settle or 0.0
    moved = follow_train(
        train,
        duration=manoeuvre.duration,
        speed=start.speed,
        angle=angle,
        loaded=loaded,
        settle=settle,
        sample_time=manoeuvre.sample_time,
        accuracy=manoeuvre.accuracy,
        method=manoeuvre.method,
        steps_max=manoeuvre.steps_max,
    )
    if engaged is None:
        return moved
    return replace(moved, notes=(*moved.notes, *slipping_notes(train, moved.friction_state)))


def _start_angles(train: MovingTrain, manoeuvre: TrainTransient) -> Floats:
    """Angles of the masses at the start: with the given twists, none of joints, (masses,) [rad]."""
    if manoeuvre.twists or any(manner.joint for manner in train.manners):
        return _twisted(train, manoeuvre)
    angles: Floats = manoeuvre.angle * train.turning
    return angles


def follow_train(
    train: MovingTrain,
    *,
    duration: float,
    speed: ArrayLike = 0.0,
    angle: ArrayLike = 0.0,
    loaded: bool = False,
    settle: float = 0.0,
    sample_time: float | None = None,
    accuracy: float = 1e-8,
    method: Literal["auto", "explicit", "implicit"] = "auto",
    steps_max: int = 5_000_000,
) -> TorsionTransient:
    """Follow any train; `duration`, `settle`, `sample_time` [s]; `speed`, `angle` () or (masses,)."""
    _require(duration, accuracy, sample_time, settle)
    _require_inertia(train)
    n = train.masses
    at = np.broadcast_to(np.asarray(angle, dtype=float), n)
    turning = np.broadcast_to(np.asarray(speed, dtype=float), n) * train.turning
    if loaded:
        at = loaded_angles(train, at, turning)
    times = _times(duration, sample_time)
    moved = train.follow(
        at, turning, times, accuracy=accuracy, start=0.0 - settle, method=method, steps_max=steps_max
    )
    if moved.end != "time":
        raise ConvergenceError(_given_up(train, moved, accuracy), method=moved.method, iterations=moved.steps)
    return _result(train, times, moved)


def _twisted(train: MovingTrain, manoeuvre: TrainTransient) -> Floats:
    """Angles of the masses with given twists at the start, the first disc at its angle, (masses,) [rad]."""
    joins = train.joins
    for name in manoeuvre.twists.keys() - set(train.shafts):
        raise InputError(f'train.transient.twists: found "{name}", expected one of {", ".join(train.shafts)}')
    twists = np.array([manoeuvre.twists.get(name, 0.0) for name in train.shafts])
    turned_so_far = manoeuvre.angle if train.is_free else 0.0
    wanted = (twists - joint_leads(train, np.full(train.masses, turned_so_far))) / train.lead
    first, is_free = int(train.mass[0]), train.is_free
    turned = [mass for mass in range(train.masses) if mass != first or not is_free]
    at = np.zeros(train.masses)
    at[turned] = np.linalg.lstsq(joins[:, turned], wanted, rcond=None)[0]
    left = joins @ at - wanted
    if np.abs(left).max() > _TWISTS_FIT * np.abs(wanted).max():
        name = train.shafts[int(np.abs(left).argmax())]
        raise InputError(
            f"train.transient.twists: found twists that do not fit together at {name}, expected those of "
            "shafts in a loop to add up to zero around it"
        )
    angles: Floats = at + turned_so_far * train.turning
    return angles


def _settling_time(manoeuvre: TrainTransient) -> float:
    if manoeuvre.twists:
        return 0.0
    if manoeuvre.settle is not None:
        return manoeuvre.settle
    return _SETTLE if manoeuvre.speed > 0 and manoeuvre.balanced and manoeuvre.loaded else 0.0


# Share of the largest twist within which twists around a loop add up to zero.
_TWISTS_FIT = 1e-9


def _require(duration: float, accuracy: float, sample_time: float | None, settle: float) -> None:
    if not 0 < duration < np.inf:
        raise InputError(f"duration: found {duration:g} s, expected a finite time above 0")
    if not 0 <= settle < np.inf:
        raise InputError(f"settle: found {settle:g} s, expected a finite time of 0 or more")
    if not 1e-14 <= accuracy <= 1e-2:
        raise InputError(f"accuracy: found {accuracy:g}, expected a number from 1e-14 to 1e-2")
    if sample_time is not None and not duration / SAMPLES.most <= sample_time < np.inf:
        least = duration / SAMPLES.most
        raise InputError(f"sample_time: found {sample_time:g} s, expected at least {least:.3g} s")


def _require_inertia(train: MovingTrain) -> None:
    least = np.array(train.inertia, dtype=float)
    for rotor in train.inertias:
        least[rotor.on] += rotor.table.value.min()
    J = np.zeros(train.masses)
    np.add.at(J, train.mass, train.speed**2 * least)
    for mass in np.flatnonzero(~(J > 0)):
        names = [name for name, of in zip(train.discs, train.mass, strict=True) if of == mass]
        raise InputError(
            f"inertia of {' with '.join(names)}: found {J[mass]:g} kg m² at its minimum, expected more than 0"
        )


def _times(duration: float, sample_time: float | None) -> Floats:
    step = sample_time or min(duration / _SAMPLES, _SAMPLE_TIME)
    samples = min(max(round(duration / step), 1), SAMPLES.most)
    return np.linspace(0.0, duration, samples + 1)


def _given_up(train: MovingTrain, moved: TrainMotion, accuracy: float) -> str:
    if moved.end == "rounded":
        shaft = int(np.argmax(train.stiffness))
        return (
            f"the torque of shaft {train.shafts[shaft]}, {train.stiffness[shaft]:.4g} N m/rad, is not "
            f"known to the accuracy {accuracy:g}: its twist is lost in the rounding of the angles at its "
            'ends; take method "auto" or "implicit", or ask for less'
        )
    when = f"the integration stopped at {moved.time:.6g} s after {moved.steps} steps"
    if moved.end == "unsettled":
        lossy = [name for name, manner in zip(train.shafts, train.manners, strict=False) if manner.loss]
        names = ", ".join([*(friction.name for friction in train.frictions), *lossy])
        return (
            f"{when}: no states of {names} agree, sticking or slipping; check the speeds at the start and "
            "the static torques, or leave out a part in parallel"
        )
    if moved.end == "not finite":
        return f"{when}: an acceleration is no finite number; look at the torques"
    frequency, disc = moved.fastest / (2 * np.pi), _fastest_disc(train)
    stiff = f"{disc} vibrates on its shafts at up to {frequency:.4g} Hz"
    if moved.method == "explicit":
        remedy = 'take method "implicit", or combine it with its neighbour into one disc'
    else:
        remedy = "ask for less accuracy, or check for a torque that jumps back and forth"
    many = moved.end == "too many steps"
    why = "that is the maximum" if many else f"no step keeps the accuracy {accuracy:g}"
    return f"{when}: {why}, and {stiff}; {remedy}"


def _fastest_disc(train: MovingTrain) -> str:
    about = np.zeros(train.masses + 1)
    slopes = [0.0 if curve is None else float(np.abs(curve.after).max()) for curve in train.curves]
    ends = np.append(train.mass, train.masses)[train.tip]
    stiffness = train.lead**2 * (train.stiffness + slopes)
    np.add.at(about, ends[:, 0], stiffness)
    np.add.at(about, ends[:, 1], stiffness)
    J = np.zeros(train.masses)
    np.add.at(J, train.mass, train.speed**2 * train.mean_inertia)
    fastest = int(np.argmax(about[:-1] / J))
    return train.discs[int(np.flatnonzero(train.mass == fastest)[0])]


def _result(train: MovingTrain, times: Floats, moved: TrainMotion) -> TorsionTransient:
    n, torque, speed = train.speed, moved.torque_extremes, moved.speed_extremes
    work, loss, error = _energy(train, moved)
    return TorsionTransient(
        time=times,
        discs=train.discs,
        angle=n[:, None] * moved.angle[train.mass],
        speed=n[:, None] * moved.speed[train.mass],
        shafts=train.shafts,
        torque=moved.torque,
        kinetic_energy=moved.kinetic,
        potential_energy=moved.potential,
        torque_max=torque.maximum,
        torque_max_time=torque.maximum_time,
        torque_min=torque.minimum,
        torque_min_time=torque.minimum_time,
        speed_max=n * speed.maximum[train.mass],
        speed_max_time=speed.maximum_time[train.mass],
        speed_min=n * speed.minimum[train.mass],
        speed_min_time=speed.minimum_time[train.mass],
        work=work,
        loss=loss,
        energy_error=error,
        method=moved.method,
        steps=moved.steps,
        steps_rejected=moved.rejected,
        evaluations=moved.evaluations,
        frequency_bound=moved.fastest / (2 * np.pi),
        notes=train.notes,
        pendulums=tuple(train.discs[one.bob] for one in train.pendulums),
        swing=_swings(train, moved),
        **_rubbed(train, moved),
    )


def _swings(train: MovingTrain, moved: TrainMotion) -> Floats:
    """Angle of swing of each pendulum, (pendulums, n) [rad]."""
    rows = [
        one.swing_per_lead
        * float(train.speed[one.on])
        * (moved.angle[train.mass[one.bob]] - moved.angle[train.mass[one.on]])
        for one in train.pendulums
    ]
    return np.array(rows).reshape(len(rows), moved.angle.shape[1])


def _rubbed(train: MovingTrain, moved: TrainMotion) -> dict[str, Any]:
    """What clutches, brakes and freewheels do."""
    friction, names = moved.friction, tuple(one.name for one in train.frictions)
    if not names:
        return {}
    extremes = friction.torque_extremes
    is_forward = extremes.maximum >= -extremes.minimum
    turning = np.vstack([train.speed[:, None] * moved.speed[train.mass], np.zeros(moved.speed.shape[1])])
    first, second = np.array([one.tip for one in train.frictions]).T
    return {
        "frictions": names,
        "friction_torque": friction.torque,
        "slip": turning[first] - turning[second],
        "friction_state": friction.state,
        "friction_torque_max": np.where(is_forward, extremes.maximum, -extremes.minimum),
        "friction_torque_max_time": np.where(is_forward, extremes.maximum_time, extremes.minimum_time),
        "friction_heat": friction.heat,
        "friction_power_max": friction.power_extremes.maximum,
        "engagements": friction.engagements,
        "slip_time": friction.slip_time,
        "stuck_time": friction.stuck_time,
    }


# Angle over which the largest torque does work that counts: a train that stands does none but rounding [rad].
_COUNTED_ANGLE = 1e-6


def _least_energy(moved: TrainMotion) -> float:
    """Energy to which an error of the balance is relative at least [J]."""
    extremes = (moved.torque_extremes, moved.friction.torque_extremes)
    rows = [row for one in extremes for row in (one.maximum, one.minimum)]
    torques = np.abs(np.concatenate(rows))
    return _COUNTED_ANGLE * float(torques[np.isfinite(torques)].max(initial=0.0))


def _energy(train: MovingTrain, moved: TrainMotion) -> tuple[dict[str, float], dict[str, float], float]:
    """Work of each torque, losses, and what is left of the balance."""
    work: dict[str, float] = {}
    names = [*(torque.name for torque in train.torques), *(one.name for one in train.controllers)]
    for name, done in zip(names, moved.work.tolist(), strict=True):
        work[name] = work.get(name, 0.0) + done
    loss: dict[str, Any] = dict(zip(train.shafts, moved.shaft_loss.tolist(), strict=True))
    loss |= {one.name: heat for one, heat in zip(train.frictions, moved.friction.heat.tolist(), strict=True)}
    loss["discs"] = float(moved.mass_loss.sum())
    if train.modal_damping is not None:
        loss["modes"] = moved.modal_loss
    start, end = moved.energy_start, moved.energy_end
    size = max(*map(abs, work.values()), *map(abs, loss.values()), abs(start), abs(end), _least_energy(moved))
    left = end - start - sum(work.values()) + sum(loss.values())
    return work, loss, left / size if size else 0.0
