r"""A driveline that moves in time: motor, shafts that twist, the mechanism with its inertia over the angle.

The mechanism is the disc at the crank, with the reduced inertia J(φ) and the resistance of its loads,

.. math:: M_r(\varphi, \omega) = M_0(\varphi) + M_d(\varphi)\,\mathrm{sign}\,\omega + c(\varphi)\,\omega
    + M_l(\varphi, \omega)

where dry resistance goes through zero near rest, and loads by laws of angle and speed are straight over the
speed between some speeds. The motor drives by its characteristic; what the gearbox loses is taken from its
torque. How exact the samples are is a note of the result.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from linkwright.drive.model.motor import ConstantSpeedMotor
from linkwright.kernel.arrays import Floats
from linkwright.kernel.core.curve import Curve, straight
from linkwright.kernel.core.periodic_table import spline
from linkwright.kernel.errors import InputError
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine, compile_machine
from linkwright.torsion.core.torque import OverSpeed, Power, TrainTorque
from linkwright.torsion.core.transient import MovingTrain, VariableInertia, variable_inertia
from linkwright.torsion.excitation.drive_line import drive_line, mean_inertia, mechanism_alone
from linkwright.torsion.in_time.moving_train import moving_train
from linkwright.torsion.model.drive_train import CRANK, MOTOR
from linkwright.torsion.model.train_transient import TrainMotor, TrainTransient

# Samples of a revolution of the crank: kinks at dead centres are rounded over a few tenths of a degree.
_SAMPLES = 2048

# Speeds between which laws are straight over the speed, up to twice that without load.
_SPEEDS = 33

# Share of the speed without load within which what holds at rest sets in.
_AT_REST = 1e-3


def moving_drive(machine: Machine, manoeuvre: TrainTransient) -> tuple[MovingTrain, TrainTransient]:
    """A driveline ready for a manoeuvre.

    Gives `train`: with all torques; `manoeuvre`: the same, with the motor, and without a balance at the
    start: the characteristic decides.
    """
    train = drive_line(machine)
    drive = machine.drive
    assert drive is not None
    if isinstance(drive.motor, ConstantSpeedMotor):
        raise InputError(
            "drive.motor.kind: found constant_speed, expected a motor whose torque follows its speed, to "
            "move in time"
        )
    motors = dict(manoeuvre.motors)
    if drive.motor is not None:
        at = MOTOR if MOTOR in train.discs else next(iter(train.discs))
        # Checked with the drive; as one of a train it is driven by the same characteristic.
        motors[MOTOR] = TrainMotor.model_construct(on=at, motor=drive.motor, on_at_start=True)
    given = manoeuvre.model_copy(update={"balanced": False, "motors": motors})
    moving = moving_train(train, given)
    compiled = mechanism_alone(machine)
    crank = moving.discs.index(CRANK)
    own = np.array(moving.inertia)
    # The rest is what turns with the crank beside the mechanism; of nothing, rounding is left.
    own[crank] = max(own[crank] - mean_inertia(machine), 0.0)
    torques = tuple(_geared(torque, machine) if torque.name == MOTOR else torque for torque in moving.torques)
    guess = compile_machine(machine).speed_guess
    return (
        replace(
            moving,
            inertia=own,
            inertias=(_inertia(compiled, crank),),
            torques=(*torques, *_resistance(compiled, crank, guess)),
            notes=(*moving.notes, _sampled(compiled, guess)),
        ),
        given,
    )


def _inertia(compiled: CompiledMachine, crank: int) -> VariableInertia:
    at = compiled.reductions(_cycle(compiled))
    return variable_inertia(crank, at.inertia, at.inertia_slope, period=compiled.cycle)


def _resistance(compiled: CompiledMachine, crank: int, guess: float) -> Iterator[TrainTorque]:
    phi = _cycle(compiled)
    at = compiled.reductions(phi)
    parts = (
        ("load", at.load, None),
        ("dry", at.dry, Power(guess, 0.0)),
        ("viscous", at.viscous, Power(1.0, 1.0)),
    )
    for name, torque, law in parts:
        if torque.any():
            yield TrainTorque(name, crank, -1.0, law, spline(torque, compiled.cycle))
    for speeds, torques in compiled.speed_tables:
        yield TrainTorque("speed", crank, -1.0, OverSpeed(_through_rest(speeds, torques, guess)))
    if compiled.has_laws:
        yield from _laws(compiled, phi, crank, guess)


def _sampled(compiled: CompiledMachine, guess: float) -> str:
    """How far the loads lie from their samples: at the angles between these, by four neighbours each."""
    phi = _cycle(compiled)
    between = phi + 0.5 * (phi[1] - phi[0])
    loads, exact = (
        at.load + at.dry + guess * at.viscous
        for at in (compiled.reductions(phi), compiled.reductions(between))
    )
    near, far = loads + np.roll(loads, -1), np.roll(loads, 1) + np.roll(loads, -2)
    off, largest = np.abs((9 * near - far) / 16 - exact).max(), np.abs(exact).max()
    error = float(off / largest) if largest else 0.0
    return (
        f"the loads of the mechanism are sampled at {len(phi)} angles, between which they differ by up to "
        f"{100 * error:.2g} % of the largest; elastic_transient has them at every angle"
    )


def _laws(compiled: CompiledMachine, phi: Floats, crank: int, guess: float) -> Iterator[TrainTorque]:
    """Loads of angle and speed, interpolated between the curves of neighbouring speeds."""
    speeds = np.linspace(0.0, 2 * guess, _SPEEDS)
    # At rest a law may jump: that just above counts.
    asked = np.maximum(speeds, _AT_REST * guess)
    for n, torque in enumerate(compiled.law_torques(phi, asked)):
        if torque.any():
            hat = straight(speeds, np.eye(_SPEEDS)[n])
            yield TrainTorque("law", crank, -1.0, OverSpeed(hat), spline(torque, compiled.cycle))


def _through_rest(speeds: object, torque: object, guess: float) -> Curve:
    """A resistance over speed that opposes both directions, linear through zero at rest."""
    x, y = np.asarray(speeds, dtype=float), np.asarray(torque, dtype=float)
    near = _AT_REST * guess
    ahead = np.append(near, x[x > near])
    sizes = np.interp(ahead, x, y)
    return straight(np.concatenate([-ahead[::-1], ahead]), np.concatenate([-sizes[::-1], sizes]))


def _geared(torque: TrainTorque, machine: Machine) -> TrainTorque:
    assert isinstance(torque.law, OverSpeed)
    _, forward, reverse = compile_machine(machine).gear_factors
    return replace(torque, law=OverSpeed(_lossy(torque.law.curve, forward, reverse)))


def _lossy(curve: Curve, forward: float, reverse: float) -> Curve:
    """A curve with one factor where it is positive and another where it is negative."""
    x, y = curve.x, curve.y
    crossing = np.flatnonzero(y[:-1] * y[1:] < 0)
    # Between two points of different sign the line through both is cut at zero.
    zeros = x[crossing] - y[crossing] * (x[crossing + 1] - x[crossing]) / (y[crossing + 1] - y[crossing])
    slopes = (y[crossing + 1] - y[crossing]) / (x[crossing + 1] - x[crossing])
    after, before = curve.after.copy(), curve.before.copy()
    after[crossing], before[crossing + 1] = slopes, slopes
    x, y = np.insert(x, crossing + 1, zeros), np.insert(y, crossing + 1, 0.0)
    after, before = np.insert(after, crossing + 1, slopes), np.insert(before, crossing + 1, slopes)
    # At zero itself the side tells the sign: what rises comes from below.
    sign_before = np.where(y != 0, y, -before)
    sign_after = np.where(y != 0, y, after)
    factor = np.where(y >= 0, forward, reverse)
    return Curve(
        x,
        factor * y,
        np.where(sign_before >= 0, forward, reverse) * before,
        np.where(sign_after >= 0, forward, reverse) * after,
    )


def _cycle(compiled: CompiledMachine) -> Floats:
    """Even angles of the crank over all revolutions after which mechanism and loads repeat [rad]."""
    samples = _SAMPLES * compiled.turns
    angles: Floats = compiled.cycle * np.arange(samples) / samples
    return angles
