"""What of a train steady motion with mechanisms does not carry, and the analysis that does."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.drive.model.motor import ConstantSpeedMotor
from linkwright.kernel.errors import MachineError, Problem
from linkwright.torsion.model.train import GROUND, Train
from linkwright.torsion.model.whole_train import RodShaft, whole_train

_MODES = "leave it out; natural frequencies and forced vibration (torsion) have it"
_IN_TIME = "leave it out; motion in time (torsion_transient) has it, in a train without mechanisms"


def require_carried(train: Train) -> None:
    """Raise MachineError if a train has parts that its steady motion with mechanisms does not have."""
    wrong = list(_problems(train))
    if wrong:
        raise MachineError(wrong)


def _problems(train: Train) -> Iterator[Problem]:
    for engine in train.installed:
        key = f"train.engines.{engine.name}" if engine.name else "train.engine"
        yield Problem(key, "an engine", "none beside [train.mechanisms]", _IN_TIME)
    if train.planetaries:
        yield Problem(
            "train.planetaries", next(iter(train.planetaries)), "none beside [train.mechanisms]", _MODES
        )
    if train.pendulums:
        yield Problem(
            "train.pendulums", next(iter(train.pendulums)), "none beside [train.mechanisms]", _MODES
        )
    if train.modal_damping is not None:
        remedy = "give damping or loss_factor of the shafts"
        yield Problem("train.modal_damping", "ratios of modes", "none beside [train.mechanisms]", remedy)
    for name in train.excitations:
        yield Problem(
            f"train.excitations.{name}", "a pulsating torque", "none beside [train.mechanisms]", _MODES
        )
    for name, load in train.loads.items():
        if load.harmonics:
            expected = "none beside [train.mechanisms]"
            yield Problem(f"train.loads.{name}.harmonics", f"{len(load.harmonics)} of them", expected, _MODES)
    yield from _links(train)
    yield from _frictions(train)
    held = [name for name, motor in train.motors.items() if isinstance(motor.motor, ConstantSpeedMotor)]
    if len(held) > 1:
        remedy = "give the others a characteristic over their speed"
        yield Problem(f"train.motors.{held[1]}.motor.kind", "constant_speed", "one such motor", remedy)


def _frictions(train: Train) -> Iterator[Problem]:
    """Parts with dry friction that are not engaged all the time, or of which nothing shows it."""
    for name, clutch in train.clutches.items():
        if not clutch.closed:
            expected, remedy = "true beside [train.mechanisms]", "leave out what it disconnects"
            yield Problem(f"train.clutches.{name}.closed", "false", expected, remedy)
    for name in train.brakes:
        remedy = "give its torque as a load, [train.loads.NAME] with exponent = 0"
        yield Problem(f"train.brakes.{name}", "a brake", "none beside [train.mechanisms]", remedy)
    for name, wheel in train.freewheels.items():
        if wheel.stiffness is None:
            found, expected = "a rigid freewheel", "an elastic one beside [train.mechanisms]"
            remedy = "give stiffness and ring_inertia: the torque of its spring shows whether it stays locked"
            yield Problem(f"train.freewheels.{name}", found, expected, remedy)


def _links(train: Train) -> Iterator[Problem]:
    """Shafts, gears and couplings that are no link between two discs, or with losses."""
    turns = "a train that turns freely"
    for table in ("shafts", "couplings"):
        for name, part in getattr(train, table).items():
            if GROUND in part.between:
                remedy = "leave it out; natural frequencies (torsion) have held trains"
                yield Problem(f"train.{table}.{name}.between", GROUND, turns, remedy)
    whole = whole_train(train)
    for name, shaft in whole.shafts.items():
        if shaft.joint_angle is not None:
            yield Problem(
                f"train.shafts.{name}.joint_angle", "a joint", "none beside [train.mechanisms]", _MODES
            )
        if isinstance(shaft, RodShaft):
            yield Problem(f"train.shafts.{name}.inertia", "distributed", '"ends" beside [train.mechanisms]')
    for name, gear in train.gears.items():
        if gear.carrier is not None:
            yield Problem(
                f"train.gears.{name}.carrier", gear.carrier, "none beside [train.mechanisms]", _MODES
            )
        if gear.losses is not None:
            yield Problem(f"train.gears.{name}.efficiency", "losses", "1 beside [train.mechanisms]", _IN_TIME)
