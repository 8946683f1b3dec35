"""Laws that the motion of a drive keeps: those of its curves (`steady_laws`), and plain integration by SciPy,
which shares no solver with the product."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

import numpy as np
from broken import LONGEST, PromiseError, watched
from numpy.random import Generator
from numpy.typing import NDArray
from random_drives import random_drive
from scipy.integrate import solve_ivp
from steady_laws import rounding, violations

import linkwright as lw
from linkwright import FindingError, InputError, SteadyStateError
from linkwright.drive import End, SteadyState, SteadyStates
from linkwright.machine import CompiledMachine, compile_machine

Floats = NDArray[np.float64]
Inputs = Mapping[str, str]

# What every number and curve of a steady motion must keep; the solver's own promise is sharper.
WITHIN = 1e-6

# Marching errs by some of its tolerance a step, and passes kinks by ever smaller steps. Where a motor is so
# steep that the first errs by more than is looked for, the second tells.
MARCH = (1e-10, 1e-12)

# Angles at which curves are compared.
INTERVALS = 144

TURN = 2 * np.pi


def drive(random: Generator) -> None:
    """A random drive: its steady motion keeps all laws, or its refusal is true in time."""
    description = random_drive(random)
    inputs = {"machine": repr(description)}
    with watched(inputs, LONGEST):
        try:
            machine = lw.Machine.model_validate(description)
            compiled = compile_machine(machine)
            found = lw.steady_state(machine, n=INTERVALS)
        except SteadyStateError:
            refused_in_time(machine, compiled, inputs)
            return
        except (FindingError, InputError):
            return
        steady_laws(machine, found, compiled, inputs)
        forces_agree(machine, found, inputs)


def steady_laws(machine: lw.Machine, found: SteadyState, compiled: CompiledMachine, inputs: Inputs) -> None:
    for law, error in violations(machine, found, max(WITHIN, 3 * found.accuracy)).items():
        raise PromiseError(f"the law of {law} is broken by {error:.2g} of the peak", inputs)
    _powers(found, compiled, inputs)
    _integral(found, compiled, inputs)
    _reached(found, inputs)


def _powers(found: SteadyState, compiled: CompiledMachine, inputs: Inputs) -> None:
    """M_d − M_r = J ε + ½ J′ ω² at every angle."""
    at = compiled.reductions(found.crank_angle)
    inertia = at.inertia * found.acceleration + 0.5 * at.inertia_slope * found.speed**2
    rest = found.torque_drive - found.torque_load - inertia
    parts = (at.load, at.dry, at.viscous * found.speed)
    terms = np.abs([found.torque_drive, found.torque_load, inertia, *parts])
    worst = np.abs(rest).max()
    if not worst <= WITHIN * terms.max() + rounding(found, compiled):
        raise PromiseError(f"torques are out of balance by {worst / terms.max():.2g} of the largest", inputs)


def _slope(compiled: CompiledMachine, phi: float, state: Floats) -> list[float]:
    """dE/dφ, and 1/ω for the time."""
    at = compiled.reductions(np.array([phi]))
    omega = float(np.sqrt(2.0 * max(state[0], 1e-300) / at.inertia[0]))
    torque = compiled.motor_torques(omega).crank
    resisting = float(at.load[0] + at.dry[0] + at.viscous[0] * omega) + float(
        compiled.speed_load(np.array([omega]))[0]
    )
    if compiled.has_laws:
        resisting += float(compiled.law_torques(np.array([phi]), np.array([omega]))[0, 0])
    return [float(torque[0]) - resisting, 1.0 / omega]


def _jacobian(compiled: CompiledMachine, phi: float, state: Floats) -> list[list[float]]:
    """Its derivative by E; nothing depends on the time."""
    step = 1e-6 * state[0]
    ahead, behind = (_slope(compiled, phi, np.array([state[0] + side, 0.0])) for side in (step, -step))
    return [[(a - b) / (2 * step), 0.0] for a, b in zip(ahead, behind, strict=True)]


def _integral(found: SteadyState, compiled: CompiledMachine, inputs: Inputs) -> None:
    """The curve of speed is what the energy equation gives from its first value on, and so is the time."""
    # A motion that grows apart by its multiplier multiplies the errors of marching.
    room = WITHIN * max(1.0, abs(found.multiplier))
    broken = ""
    for accuracy in MARCH:
        broken = _marched_apart(found, compiled, accuracy, room)
        if not broken:
            return
    raise PromiseError(broken, inputs)


def _marched_apart(found: SteadyState, compiled: CompiledMachine, accuracy: float, room: float) -> str:
    """By how much speed or time are off a march of some accuracy; nothing if they are not, or it gives up."""
    J = compiled.reductions(found.crank_angle).inertia
    start = [0.5 * J[0] * found.speed[0] ** 2, 0.0]
    marched = solve_ivp(
        partial(_slope, compiled), (0.0, TURN), start, "Radau", found.crank_angle,
        jac=partial(_jacobian, compiled), max_step=TURN / 100,
        rtol=accuracy, atol=[accuracy * start[0], accuracy * found.period],
    )  # fmt: skip
    if not marched.success:
        return ""
    omega = np.sqrt(2.0 * marched.y[0] / J)
    off = np.abs(omega - found.speed) / found.speed_max
    late = np.abs(marched.y[1] - found.time) / found.period
    if not off.max() < room:
        at = np.degrees(found.crank_angle[off.argmax()])
        return f"speed is off by {off.max():.2g} of its maximum at {at:.1f} deg"
    return "" if late.max() < room else f"time is off by {late.max():.2g} of the period"


def _reached(found: SteadyState, inputs: Inputs) -> None:
    # Between two angles speed changes by what its extreme acceleration allows and no more.
    step = np.diff(found.time).max()
    steepest = max(abs(found.acceleration_min), abs(found.acceleration_max))
    room = steepest * step + WITHIN * found.speed_max
    if found.speed.min() - found.speed_min > room or found.speed_max - found.speed.max() > room:
        raise PromiseError("an extreme of the speed lies farther from its curve than it can get", inputs)


def forces_agree(machine: lw.Machine, found: SteadyState, inputs: Inputs) -> None:
    """Joint forces ask the drive for the torque that the reduction asks for."""
    forces = lw.forces(machine, n=INTERVALS)
    worst = np.abs(forces.torque_drive - found.torque_drive).max()
    size = max(np.abs(found.torque_drive).max(), np.abs(found.torque_load).max())
    # A force in line with its crank turns nothing, but for the rounding of its moment.
    arm = max(crank.radius for crank in machine.mechanism.cranks.values())
    moment = arm * max(np.abs(pair.force).max() for pair in forces.pairs.values())
    if not worst <= WITHIN * size + rounding(found, compile_machine(machine)) + 1e-15 * moment:
        raise PromiseError(
            f"torques of joint forces and reduction differ by {worst:.2g} of {size:.2g} N m", inputs
        )


def refused_in_time(machine: lw.Machine, compiled: CompiledMachine, inputs: Inputs) -> None:
    """A machine that is refused does not settle into a motion from any of some speeds."""
    for factor in (1.0, 0.3):
        try:
            moved = lw.transient(machine, speed=factor * compiled.speed_guess, turns=60.0, accuracy=1e-9)
        except FindingError:
            continue
        if moved.end != End.TURNS:
            continue
        whole = np.arange(57, 61) * TURN
        speeds = np.interp(whole, moved.crank_angle, moved.speed)
        spread = np.ptp(speeds) / speeds.mean()
        # A machine with a large flywheel runs down slowly, which is no steady motion.
        if spread < 1e-7:
            raise PromiseError(
                f"refused, yet it turns at {speeds[-1]:.6g} rad/s, the same every revolution", inputs
            )


def batch(random: Generator) -> None:
    """Rows of a batch are what the machines are one by one, and are refused where those are."""
    description = random_drive(random)
    inputs = {"machine": repr(description)}
    with watched(inputs, LONGEST):
        try:
            machine = lw.Machine.model_validate(description)
            entries = [(address, value) for address, value in lw.addresses(machine).items() if value]
            address, value = entries[random.integers(len(entries))]
            values = value * random.uniform(0.9, 1.1, 6)
            rows = lw.steady_states(machine, {address: values})
        except (FindingError, InputError):
            return
        inputs["address"] = address
        for k, at in enumerate(values):
            _row_agrees(machine, address, at, rows, k, inputs)


def _row_agrees(
    machine: lw.Machine, address: str, value: float, rows: SteadyStates, k: int, inputs: Inputs
) -> None:
    try:
        alone = lw.steady_state(lw.replace(machine, {address: value}), n=12)
    except (FindingError, InputError) as error:
        if rows.status[k] == 0:
            raise PromiseError(f"row {k} ({address} = {value}) answers; alone: {error}", inputs) from None
        return
    if rows.status[k] != 0:
        return
    for name in ("speed_min", "speed_max", "period"):
        one, many = getattr(alone, name), getattr(rows, name)[k]
        if not abs(one - many) <= WITHIN * (alone.period if name == "period" else alone.speed_max):
            raise PromiseError(f"row {k} ({address} = {value}): {name} {many}, alone {one}", inputs)
