r"""A train of a machine file made ready to move in time: its parts, its engine, its torques, its events.

An engine in motion is not linear: a throw at the angle φ + α has the inertia J(φ + α), and its swinging
changes both. What linear vibration calls inertia torque, :math:`-\tfrac12 J'\Omega^2`, is part of the
motion's own equation.

A cylinder gives the torque of its gas without combustion, and on top of it, with a weight over time, what the
combustion adds. Both are taken at one speed.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from linkwright.drive.model.motor import ConstantSpeedMotor
from linkwright.kernel.arrays import Complexes, Floats
from linkwright.kernel.core.curve import Curve, odd, product, straight, switched
from linkwright.kernel.core.curve import smooth as smooth_curve
from linkwright.kernel.core.periodic_table import PeriodicTable, smooth, waves
from linkwright.kernel.errors import InputError, MachineError, Problem
from linkwright.kernel.limits import SAMPLES
from linkwright.kernel.numerics.tangent import primal, variables_of
from linkwright.torsion.core.torque import (
    DecayingTorque,
    GovernorTorque,
    OverSpeed,
    Power,
    TrainTorque,
    motor_curve,
    short_circuit,
)
from linkwright.torsion.core.train import ReferredTrain, refer
from linkwright.torsion.core.transient import MovingTrain, VariableInertia, moving, variable_inertia, viscous
from linkwright.torsion.excitation.engine_torques import cylinder_torques
from linkwright.torsion.excitation.excited_train import highest_order
from linkwright.torsion.in_time.friction_parts import friction_elements
from linkwright.torsion.in_time.ice_impacts import IceStarts, ice_torque
from linkwright.torsion.in_time.moving_parts import link_manner, with_parts
from linkwright.torsion.model.drive_shaft import LooseShaft
from linkwright.torsion.model.engine.engine import ReciprocatingEngine, firing_angles
from linkwright.torsion.model.engine.engine_motion import reduced_throw
from linkwright.torsion.model.ice_impacts import IceImpacts
from linkwright.torsion.model.train import Train, TrainGear
from linkwright.torsion.model.train_torques import (
    Excitation,
    Harmonic,
    InstalledEngine,
    LoadHarmonic,
    TrainLoad,
)
from linkwright.torsion.model.train_transient import (
    FuelSwitch,
    LoadStep,
    Misfire,
    MotorSwitch,
    ShortCircuit,
    SpeedCourse,
    TorqueCourse,
    TorqueStep,
    TrainTransient,
    transient_faults,
)
from linkwright.torsion.model.whole_train import whole_train

# Share of the energy of a mode from which on a shaft counts in it.
_COUNTS = 0.05

# Turns over which orders may repeat together to share one table.
_TURNS_MAX = 8


def moving_train(
    train: Train, manoeuvre: TrainTransient, ice: IceStarts | None = None, *, slips: bool = True
) -> MovingTrain:
    """A train with all torques of a manoeuvre, and notes on assumptions.

    `ice`: where known ice begins; `slips`: with its parts with friction, instead of engaged discs as one.
    """
    _require_motors_of_torque(manoeuvre)
    expanded, referred = whole_train(train), refer(train, slips=slips)
    _require_fit(train, manoeuvre, tuple(expanded.discs))
    if train.mechanisms:
        found, expected = f"the mechanism {next(iter(train.mechanisms))}", "none in a motion in time"
        remedy = "leave [train.transient] out; steady motion (elastic_motion) has mechanisms"
        raise MachineError([Problem("train.transient", found, expected, remedy)])
    place = {name: k for k, name in enumerate(expanded.discs)}
    own = np.array([disc.inertia for disc in expanded.discs.values()])
    inertias = [
        inertia
        for engine in train.installed
        for inertia in throw_inertias(engine.engine, place[engine.throws[0]], engine.phase)
    ]
    own[[inertia.on for inertia in inertias]] = 0.0
    by_mode = manoeuvre.loss_by == "mode" and bool(referred.loss_factor.any())
    ratios = _ratios(referred, by_mode=by_mode)
    damping, notes = _mode_damping(referred) if by_mode else shaft_damping(referred, manoeuvre.loss_mode)
    moved = moving(
        referred,
        own,
        swing_damping=[disc.damping for disc in expanded.discs.values()],
        shaft_damping=damping,
        curves=[_curve(train, name) for name in referred.shafts],
        inertias=inertias,
        torques=[
            *_engines(train, manoeuvre, referred),
            *_outside(expanded, manoeuvre, place),
            *_events(manoeuvre, place, ice or {}),
        ],
        modal_damping=replace(referred, ratios=ratios).modal_damping if ratios.any() else None,
        frictions=friction_elements(expanded, manoeuvre, place) if slips else (),
        notes=notes,
        manners=[link_manner(expanded, referred, name) for name in referred.shafts],
    )
    return with_parts(moved, train, expanded, manoeuvre)


def _require_motors_of_torque(manoeuvre: TrainTransient) -> None:
    for name, motor in manoeuvre.motors.items():
        if isinstance(motor.motor, ConstantSpeedMotor):
            expected = "a motor whose torque follows its speed, to move in time"
            raise MachineError([Problem(f"train.motors.{name}.motor.kind", "constant_speed", expected)])


def _ratios(referred: ReferredTrain, *, by_mode: bool) -> Floats:
    """Damping ratio of each mode: the given one and that of its hysteresis."""
    given = referred.ratios if len(referred.ratios) else np.zeros(len(referred.inertia))
    if not by_mode:
        return given
    omega, shapes = referred.modes()
    ratios = np.zeros_like(given)
    vibrating = omega > 0
    loss = np.einsum("ka,ab,kb->k", shapes, referred.loss_matrix, shapes)[vibrating]
    ratios[: len(loss)] = 0.5 * loss / omega[vibrating] ** 2
    return given + ratios


def _mode_damping(referred: ReferredTrain) -> tuple[Floats, list[str]]:
    """Viscous damping of the shafts alone where modes have that of the hysteresis, and a note about it."""
    note = "hysteresis of shafts is replaced by a damping ratio of each mode, exact at its natural frequency"
    return referred.damping / referred.lead**2, [note]


def _require_fit(train: Train, manoeuvre: TrainTransient, discs: tuple[str, ...]) -> None:
    faults = list(transient_faults(train.model_copy(update={"transient": manoeuvre}), discs))
    if faults:
        contexts = ((wrong["loc"], getattr(wrong["type"], "context", None) or {}) for wrong in faults)
        raise MachineError([Problem(".".join(map(str, place)), **words) for place, words in contexts])


def shaft_damping(referred: ReferredTrain, mode: int | None = None) -> tuple[Floats, list[str]]:
    """Damping of each shaft at its own speed, with that of its hysteresis at the frequency of a mode.

    And a note about it. `mode`: None for the lowest that twists the shaft considerably.
    """
    lead = referred.lead
    own: Floats = referred.damping / lead**2
    if not primal(referred.loss_factor).any():
        return own, []
    omega, where = _loss_frequencies(referred, mode)
    lossy = referred.loss_factor > 0
    at = primal(omega)[lossy]
    low, high = (float(frequency) / (2 * np.pi) for frequency in (at.min(), at.max()))
    span = f"{low:.4g} Hz" if low == high else f"{low:.4g} to {high:.4g} Hz"
    note = (
        f"hysteresis of shafts is replaced by viscous damping of equal loss at {span}, {where}: damping is "
        "lower below and higher above"
    )
    return own + viscous(referred.stiffness / lead**2, referred.loss_factor, omega), [note]


def _loss_frequencies(referred: ReferredTrain, mode: int | None) -> tuple[Any, str]:
    """Frequency at which viscous damping equals the hysteresis of each shaft [rad/s], and in words."""
    omega, shapes = replace(
        referred, stiffness=primal(referred.stiffness), inertia=primal(referred.inertia)
    ).modes()
    twisting = omega > 1e-6 * omega[-1]
    omega, shapes = omega[twisting], shapes[twisting]
    if mode is not None:
        if mode > len(omega):
            raise InputError(
                f"train.transient.loss_mode: found {mode}, expected a mode of vibration, 1 to {len(omega)}"
            )
        return np.full(len(referred.shafts), omega[mode - 1]), f"mode {mode}"
    # The last is the ground, HELD = −1.
    held = np.column_stack([shapes, np.zeros(len(shapes))])
    twist = held[:, referred.ends[:, 0]] - held[:, referred.ends[:, 1]]
    shares = primal(referred.stiffness) * twist**2 / omega[:, None] ** 2
    counts = shares >= _COUNTS
    chosen = np.where(counts.any(axis=0), counts.argmax(axis=0), shares.argmax(axis=0))
    where = "for each shaft the lowest mode that twists it considerably"
    return _by_rayleigh(referred, omega[chosen], twist[chosen], shapes[chosen]), where


def _by_rayleigh(referred: ReferredTrain, omega: Floats, twist: Floats, shapes: Floats) -> Any:
    """Natural frequencies with their derivatives: of Rayleigh's quotient, the shapes held [rad/s]."""
    if variables_of((referred.stiffness, referred.inertia)) is None:
        return omega
    strain = np.einsum("rs,s->r", twist**2, referred.stiffness)
    return (strain / np.einsum("rm,m->r", shapes**2, referred.inertia)) ** 0.5


def _curve(train: Train, name: str) -> Curve | None:
    """Torque over twist of a coupling that has a curve, or of an elastic part with backlash."""
    coupling = train.couplings.get(name)
    if coupling is not None and coupling.twist is not None:
        return odd(*coupling.curve())
    part = train.gears.get(name) or train.shafts.get(name)
    if isinstance(part, LooseShaft) and part.twist is not None:
        return _behind(part.backlash / 2, *part.points)
    if isinstance(part, TrainGear | LooseShaft) and part.backlash:
        assert part.stiffness is not None
        return _behind(part.backlash / 2, np.zeros(1), np.zeros(1), np.array([part.stiffness]))
    return None


def _behind(half: float, twist: Floats, torque: Floats, slope: Floats) -> Curve:
    """A curve from zero behind half of the backlash on either side: between its flanks nothing is carried."""
    if not half:
        return odd(twist, torque, slope)
    x, y = twist + half, np.asarray(torque, float)
    after, before = np.array(slope, float), np.array(slope, float)
    before[0] = 0.0
    return Curve(
        np.concatenate([-x[::-1], x]),
        np.concatenate([-y[::-1], y]),
        before=np.concatenate([after[::-1], before]),
        after=np.concatenate([before[::-1], after]),
    )


def _engines(train: Train, manoeuvre: TrainTransient, referred: ReferredTrain) -> list[TrainTorque]:
    if not train.installed:
        return []
    service = None if train.run is None else train.run.service
    speed = manoeuvre.gas_speed or manoeuvre.speed or service
    if not speed:
        raise InputError(
            "train.transient.gas_speed: found nothing, expected the speed at which gas torques are taken, as "
            "the motion starts at rest and [train.run] gives no speed of service"
        )
    torques = []
    for engine in train.installed:
        first = referred.discs.index(engine.throws[0])
        its_speed = speed * float(referred.speed[first])
        torques += engine_motion_torques(engine, manoeuvre, its_speed, highest_order(train), first)
    return torques


def _outside(train: Train, manoeuvre: TrainTransient, place: dict[str, int]) -> Iterator[TrainTorque]:
    for name, load in train.loads.items():
        yield from _load(name, load, manoeuvre, place[load.on])
    for name, excitation in train.excitations.items():
        law = _over_speed(excitation)
        waves = [wave for wave in excitation.harmonics if not wave.frequency]
        for shape, pitch, phase in _shapes(waves, 0.0) if waves else ():
            yield TrainTorque(name, place[excitation.on], 1.0, law, shape, pitch, phase)
        for wave in excitation.harmonics:
            if wave.frequency:
                yield from _fixed_frequency(name, place[excitation.on], wave, law, manoeuvre)
    for name, driver in train.drivers.items():
        if driver.torque is not None and driver.control is None:
            law = None if driver.speed is None else Power(driver.speed, driver.exponent, is_even=True)
            yield TrainTorque(name, place[driver.on], driver.torque, law)
    for name, motor in manoeuvre.motors.items():
        changes = [
            (event.time, float(event.kind == "motor_on"), 0.0)
            for event in manoeuvre.events
            if isinstance(event, MotorSwitch) and event.motor == name
        ]
        weight = switched(changes, float(motor.on_at_start))
        torque = OverSpeed(motor_curve(motor.motor))
        yield TrainTorque(name, place[motor.on], 1.0, torque, weight=weight)


def _over_speed(excitation: Excitation) -> Power | OverSpeed | None:
    """How the amplitudes of an excitation depend on the speed; None for not at all."""
    if excitation.speeds is not None and excitation.factors is not None:
        return OverSpeed(straight(excitation.speeds, excitation.factors))
    return None if excitation.speed is None else Power(excitation.speed, excitation.exponent, is_even=True)


# Points in a period of a sine over time where a law over the speed leaves room for no other: cubics between
# them err by 1e-6.
_IN_PERIOD = 48

# Before the start of a motion that settles for as long as a file is likely to ask for [s].
_LONG_BEFORE = 100.0


def _fixed_frequency(
    name: str, on: int, wave: Harmonic, law: Power | OverSpeed | None, manoeuvre: TrainTransient
) -> Iterator[TrainTorque]:
    """M cos(νφ + ω₀t + β), by products of a sine over time and one over the angle."""
    order, omega = wave.line
    size, sense = abs(omega), math.copysign(1.0, omega)
    terms = [(wave.torque, sense * wave.phase + np.pi / 2, 0.0)]
    if order:
        # cos(νφ + β) cos(ω₀t) − sin(νφ + β) sin(ω₀t)
        terms = [(wave.torque, np.pi / 2, wave.phase), (-sense * wave.torque, 0.0, wave.phase - np.pi / 2)]
    shape = waves([1.0], [1.0], [0.0], 1, 0.0) if order else None
    before = max(_LONG_BEFORE, manoeuvre.settle or 0.0)
    for scale, lead, phase in terms:
        if law is None:
            over_time = DecayingTorque(-before, np.inf, 0.0, size, lead - size * before)
            yield TrainTorque(name, on, scale, over_time, shape, order or 1.0, phase)
        else:
            weight = _sine(size, lead, manoeuvre)
            yield TrainTorque(name, on, scale, law, shape, order or 1.0, phase, weight)


def _sine(omega: float, lead: float, manoeuvre: TrainTransient) -> Curve:
    """sin(ωt + lead) over the motion and the time in which it settles, by cubics."""
    start = -1.1 if manoeuvre.settle is None else -1.1 * manoeuvre.settle - 0.1
    count = math.ceil((manoeuvre.duration - start) * omega / (2 * np.pi) * _IN_PERIOD) + 1
    if count > SAMPLES.most * 5:
        raise InputError(
            f"train.transient.duration: found {manoeuvre.duration:g} s, with {omega / (2 * np.pi):.4g} Hz "
            f"of an excitation over the speed; expected at most {SAMPLES.most * 5 // _IN_PERIOD} periods"
        )
    time = np.linspace(start, manoeuvre.duration, max(count, 3))
    value, slope = np.sin(omega * time + lead), omega * np.cos(omega * time + lead)
    # It sets in within the first piece: before, where mean torques are found, there is none.
    value[0] = slope[0] = 0.0
    return smooth_curve(time, value, slope, beyond="held")


def _load(name: str, load: TrainLoad, manoeuvre: TrainTransient, on: int) -> Iterator[TrainTorque]:
    """A load and its pulsation: one torque, unless its orders do not repeat together."""
    if load.exponent < 0 and not manoeuvre.speed:
        raise InputError(
            f"train.loads.{name}.exponent: found {load.exponent:g}, expected 0 or more in a motion from "
            "rest, where the load would grow beyond bounds"
        )
    steps = [
        (event.time, event.factor, event.over)
        for event in manoeuvre.events
        if isinstance(event, LoadStep) and event.load == name
    ]
    weight = switched(steps) if steps else None
    law = Power(load.speed, load.exponent)
    first, *others = _shapes(load.harmonics, 1.0) if load.harmonics else [(None, 1.0, 0.0)]
    for shape, pitch, phase in (first, *others):
        yield TrainTorque(name, on, -load.torque, law, shape, pitch, phase, weight)


def _shapes(
    harmonics: Sequence[Harmonic] | Sequence[LoadHarmonic], mean: float
) -> list[tuple[PeriodicTable, float, float]]:
    """Tables with pitch and phase: one for orders that repeat within some revolutions, else one each."""
    orders = np.array([harmonic.order for harmonic in harmonics])
    sizes = [harmonic.torque if isinstance(harmonic, Harmonic) else harmonic.share for harmonic in harmonics]
    phases = [harmonic.phase for harmonic in harmonics]
    for turns in range(1, _TURNS_MAX + 1):
        if np.abs(orders * turns - np.round(orders * turns)).max() < 1e-9:
            rounded = np.round(orders * turns) / turns
            return [(waves(rounded.tolist(), sizes, phases, turns, mean), 1.0, 0.0)]
    # A load's mean goes with its first order.
    return [
        (waves([1.0], [size], [0.0], 1, mean if n == 0 else 0.0), float(order), phase)
        for n, (order, size, phase) in enumerate(zip(orders, sizes, phases, strict=True))
    ]


def _events(manoeuvre: TrainTransient, place: dict[str, int], ice: IceStarts) -> Iterator[TrainTorque]:
    for n, event in enumerate(manoeuvre.events, start=1):
        name = f"{event.kind}_{n}"
        match event:
            case TorqueStep():
                # A sine that neither swings nor decays is a constant.
                law = DecayingTorque(event.time, event.end, 0.0, 0.0, np.pi / 2)
                yield TrainTorque(name, place[event.on], event.torque, law)
            case TorqueCourse():
                yield TrainTorque(name, place[event.on], weight=straight(event.times, event.torque))
            case SpeedCourse():
                lead = GovernorTorque(event.gain, straight(event.times, event.speed))
                yield TrainTorque(name, place[event.on], 1.0, lead)
            case IceImpacts() if n - 1 in ice:
                yield ice_torque(name, place[event.on], event, ice[n - 1])
            case ShortCircuit():
                yield from short_circuit(
                    name,
                    place[event.on],
                    torque=event.torque,
                    reactance=event.reactance,
                    speed=event.pole_pairs * event.speed,
                    decay=event.decay,
                    phases=event.phases,
                    start=event.time,
                    end=event.end,
                )


# Name of what combustion adds in a cylinder: after that of one of several engines, before its number.
COMBUSTION = re.compile(r"(?:^|_)combustion_\d+$")

# Angles over one revolution at which a throw is reduced: far beyond its harmonics.
_SAMPLES = 256


def throw_inertias(engine: ReciprocatingEngine, place: int = 0, phase: float = 0.0) -> list[VariableInertia]:
    """Inertia of each throw with its rods and pistons. `place`: of the first; `phase`: [rad]."""
    phi = 2 * np.pi * np.arange(_SAMPLES) / _SAMPLES
    reduced = reduced_throw(engine, phi)
    first = variable_inertia(0, reduced.inertia_reduced, reduced.inertia_reduced_d1)
    return [VariableInertia(place + n, first.table, angle + phase) for n, angle in enumerate(engine.throws)]


def engine_motion_torques(
    installed: InstalledEngine, manoeuvre: TrainTransient, speed: float, highest: float, first: int = 0
) -> list[TrainTorque]:
    """Torques of gas and weight on the throws.

    ``"gas_N"`` of each cylinder without combustion, ``"combustion_N"`` on top of it, ``"weight_N"`` of each
    throw; before it the name of one of several engines. `speed`: of its crank [rad/s]; `first`: its disc.
    """
    engine, phase, prefix = installed.engine, installed.phase, installed.prefix
    fires, _ = firing_angles(engine.places, engine.firing_order, engine.cycle)
    motored, added = _gas_tables(engine, speed, highest)
    torques = []
    for n, (place, angle) in enumerate(zip(engine.places, fires, strict=True)):
        number = n + 1
        disc, lead = first + place.throw, phase - float(angle)
        gas = TrainTorque(f"{prefix}gas_{number}", disc, shape=motored[place.bank], phase=lead)
        factor = engine.factor(number)
        burns = TrainTorque(
            f"{prefix}combustion_{number}",
            disc,
            factor,
            shape=added[place.bank],
            phase=lead,
            weight=combustion_weight(manoeuvre, number, installed.name),
        )
        torques += [gas, burns]
    return [*torques, *_weights(installed, first)]


def combustion_weight(manoeuvre: TrainTransient, cylinder: int, engine: str = "") -> Curve | None:
    """Share of the combustion in a cylinder over time. None if it burns all the time."""
    fuel = [
        (event.time, float(event.kind == "fuel_on"), event.over)
        for event in manoeuvre.events
        if isinstance(event, FuelSwitch) and event.engine in (None, engine)
    ]
    weight = switched(fuel, manoeuvre.fuel) if fuel or manoeuvre.fuel != 1.0 else None
    for change in _misfires(manoeuvre, cylinder, engine):
        weight = change if weight is None else product(weight, change)
    return weight


def _misfires(manoeuvre: TrainTransient, cylinder: int, engine: str) -> Iterator[Curve]:
    for event in manoeuvre.events:
        if isinstance(event, Misfire) and cylinder in event.cylinders and event.engine in (None, engine):
            end = [(event.end, 1.0, 0.0)] if np.isfinite(event.end) else []
            yield switched([(event.time, event.factor, 0.0), *end])


def _gas_tables(
    engine: ReciprocatingEngine, speed: float, highest: float
) -> tuple[list[PeriodicTable], list[PeriodicTable]]:
    gas = cylinder_torques(engine, np.array([speed]), highest)
    turns = engine.strokes // 2

    def table(harmonics: Complexes) -> PeriodicTable:
        wave = harmonics[1:]
        return waves(gas.orders[1:].tolist(), np.abs(wave), np.angle(wave), turns, float(harmonics[0].real))

    motored = [table(bank.motored[0]) for bank in gas.banks]
    added = [table(bank.firing[0] - bank.motored[0]) for bank in gas.banks]
    return motored, added


def _weights(installed: InstalledEngine, first: int) -> list[TrainTorque]:
    engine, prefix = installed.engine, installed.prefix
    phi = 2 * np.pi * np.arange(_SAMPLES) / _SAMPLES
    table = smooth(reduced_throw(engine, phi).weight_torque)
    return [
        TrainTorque(f"{prefix}weight_{n + 1}", first + n, shape=table, phase=angle + installed.phase)
        for n, angle in enumerate(engine.throws)
    ]
