"""Formulas, sources and assumptions of an elastic driveline."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.driveline.elastic_motion import ElasticMotion
from linkwright.driveline.run_up import ElasticRunUp
from linkwright.kernel.page.formulas import Formula
from linkwright.kernel.reader.numbers import number
from linkwright.machine.machine import Machine

_SOURCE = "Dresig, Holzweißig, Dynamics of Machinery, Springer 2010, sections 2.3 and 4.3"

_STATION = Formula("Motion of a station of the driveline", "J_i ε_i = M_d − Σ T", _SOURCE)
_CRANK = Formula(
    "Motion of the crank with the mechanism",
    "J ε + frac(1|2) ω^2 frac(d J|d φ) = T − M_r",
    _SOURCE,
)
_TORQUE = Formula("Torque of a flexible shaft with twist Δ", "T = k Δ + c frac(d Δ|d t)", _SOURCE)


_BACKLASH = Formula(
    "Torque of a shaft with backlash b: spring S behind the flank, damping in contact, which never pulls",
    "|S| = k ( |Δ| − frac(b|2) ) , T = S + D , |D| ≤ |S|",
    "Modelica Standard Library 4.0, Rotational.Components.ElastoBacklash",
)


def elastic_formulas(motion: ElasticMotion) -> list[Formula]:
    """Equations of motion and the torque of a shaft."""
    return [_STATION, _CRANK, _TORQUE, *([_BACKLASH] if motion.backlash.any() else [])]


def elastic_papers(motion: ElasticMotion) -> tuple[str, ...]:
    """Where the formulas are from."""
    return (_SOURCE,)


def elastic_assumptions(machine: Machine, motion: ElasticMotion) -> Iterator[str]:
    """What is taken for granted of shafts and gearbox, and how the motion was found."""
    yield from _of_train() if machine.has_mounted_mechanisms else _of_drive()
    for note in motion.notes:
        yield f"Elastic driveline: {note}."
    yield (
        "The steady motion of the elastic driveline is the periodic solution, by Newton's method on the "
        f"cycle with {motion.steps} steps: relative error {number(motion.accuracy, 1)}."
    )


def _of_train() -> Iterator[str]:
    """What is taken for granted of a train."""
    yield (
        "Elastic driveline: discs, motors and cranks are rigid; shafts, couplings and elastic meshes between "
        "them have stiffness and viscous damping, and neither inertia nor backlash; every mechanism has its "
        "inertia and loads at every crank angle and speed, where the twists have its crank."
    )


def _of_drive() -> Iterator[str]:
    """What is taken for granted of a driveline that [drive] describes."""
    yield (
        "Elastic driveline: motor, gearbox and crank are rigid; the shafts between them have stiffness or a "
        "torque curve, viscous damping and backlash as given, and no inertia; the mechanism has its inertia "
        "and loads at every crank angle and speed."
    )
    yield "Elastic driveline: the losses of the gearbox are taken from the torque of the motor."


def run_up_assumptions(run_up: ElasticRunUp) -> Iterator[str]:
    """How the run-up was integrated, and how well its energy balances."""
    motion = run_up.motion
    explicit = motion.steps - motion.steps_implicit
    yield (
        f"The run-up of the elastic driveline is integrated in time, {explicit} steps by DOP853 and "
        f"{motion.steps_implicit} by Radau IIA: energy-balance residual {number(motion.energy_error, 1)}."
    )
