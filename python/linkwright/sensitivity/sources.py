"""What can be differentiated: results of each analysis with their derivatives by entries of the machine.

| responses | by |
| --- | --- |
| ``steady_state.…`` | Newton's step in dual numbers at the solution (`linkwright.drive.gradient`) |
| ``run_up.…``, ``run_down.…`` | the variational equation (`linkwright.drive.gradient_in_time`) |
| ``elastic_motion.…`` | the linearised collocation in dual numbers (`linkwright.driveline.gradient`) |
| ``free_vibration.natural_frequencies.1`` | Rayleigh's quotient (`linkwright.torsion.gradient.modes`) |
| ``free_vibration.mode_shapes.1.DISC`` | all modes, or the dynamic stiffness (there too) |
| ``forced_vibration.shaft_torque_vibratory.SHAFT`` | the adjoint (`linkwright.torsion.gradient.forced`) |
| ``forced_vibration.shaft_torque_max.SHAFT`` | there too |
| ``turning_moment.…`` | integrals of the torques' derivatives (`linkwright.turning.gradient`) |
| ``pumping_unit.…`` | the transfer functions of the beam (`linkwright.pumping.gradient`) |
| ``rod_string.…`` | sweeps of the string in dual numbers, with its drive (`linkwright.rods.gradient`) |
| ``rod_rotator.…`` | places of the stroke, the slope of the lever (`linkwright.pumping.rotator_gradient`) |
| ``topper.…`` | closed forms, and conditions of the worst head (`linkwright.topping.gradient`) |
| ``cam.CAM.…`` | the law and the contact in tangents (`linkwright.cam.gradient`) |
| ``cam_force.CAM.…`` | the same, and Hertz' formula (`linkwright.cam.dynamics.gradient`) |
| ``axis.AXIS.…``, ``dc_bus.…`` | the equilibrium at samples that move (`linkwright.axes.gradient`) |
| ``linkage.ELEMENT.…`` | the motion at fixed crank angles (`linkwright.linkages.gradient`) |
| ``forces.…``, ``forces.reaction_max.PAIR`` | the equilibrium (`linkwright.kinetostatics.gradient`) |
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace
from typing import Any, get_type_hints

from linkwright.app.subjects import ANALYSES
from linkwright.drive.model.motor import ConstantSpeedMotor
from linkwright.kernel.errors import InputError, cut
from linkwright.kernel.quantities import Label, shown
from linkwright.kernel.result import result_within
from linkwright.machine.analysis import Analysis
from linkwright.machine.machine import Machine
from linkwright.machine.tangents import Derivatives

# Analyses whose results have derivatives, by name.
SOURCES = {analysis.name: analysis for analysis in ANALYSES if analysis.tangents is not None}


def usual_analysis(machine: Machine) -> str:
    """The analysis whose results are differentiated if none is named."""
    motor = None if machine.drive is None else machine.drive.motor
    if motor is not None and not isinstance(motor, ConstantSpeedMotor):
        return "steady_state"
    if machine.twists:
        return "free_vibration"
    own = {
        "turning_moment": machine.turning_moment,
        "topper": machine.topper,
        "pumping_unit": machine.pumping_unit,
        "cam": machine.mechanism.cams or None,
    }
    last = "linkage" if motor is None else "steady_state"
    return next((name for name, part in own.items() if part is not None), last)


def source(machine: Machine, analysis: str, variables: Sequence[str]) -> Derivatives:
    """Results of an analysis along entries of a machine, by name of the response, with words and units.

    Raises what the analysis raises.
    """
    of = SOURCES[analysis]
    derive = of.tangents
    assert derive is not None
    if of.parts is None:
        return _named(of, analysis, derive(machine, variables))
    # Without any part the analysis itself says what is missing.
    names = of.parts(machine) or (None,)
    alone = {name: derive(machine, name, variables) for name in names}
    refused = {entry: why for one in alone.values() for entry, why in one.refused.items()}
    kept = tuple(entry for entry in variables if entry not in refused)
    parts = [_named(of, f"{analysis}.{name}", one.only(kept)) for name, one in alone.items()]
    merged = {
        field: {name: x for part in parts for name, x in getattr(part, field).items()} for field in _NAMED
    }
    lost = {entry: angle for part in parts for entry, angle in part.lost.items()}
    usual = tuple(name for part in parts for name in part.usual or ())
    return Derivatives(kept, **merged, refused=refused, lost=lost, usual=usual)


# Parts of derivatives that are by name of the response.
_NAMED = ("tangents", "ties", "missing", "words", "units")


def _named(of: Analysis, prefix: str, derived: Derivatives) -> Derivatives:
    """Scalars of a result, called as they are declared unless their room says otherwise."""
    kind: type = get_type_hints(of.analyse)["return"]
    marks = {name: _mark(kind, name) for name in derived.tangents if name not in derived.words}
    words = {name: f"{mark.word} {mark.symbol}".strip() for name, mark in marks.items()} | dict(derived.words)
    units = {name: mark.unit for name, mark in marks.items()} | dict(derived.units)
    usual = tuple(derived.tangents) if derived.usual is None else derived.usual
    whole = replace(derived, words=words, units=units)
    prefixed: dict[str, Any] = {
        part: {f"{prefix}.{name}": x for name, x in getattr(whole, part).items()} for part in _NAMED
    }
    return replace(whole, **prefixed, usual=tuple(f"{prefix}.{name}" for name in usual))


def _mark(kind: type, name: str) -> Label:
    """The declaration of a quantity of a result, or of a result within it, ``"gear.work"``."""
    within, _, rest = name.partition(".")
    if not rest:
        return shown(kind, name)
    inner = result_within(kind, within)
    assert inner is not None, name
    return _mark(inner, rest)


def chosen(listed: Collection[str], asked: str) -> list[str]:
    """Responses that a name means: its own, all that begin with it, or of every cam where it names none."""
    if asked in listed:
        return [asked]
    first, _, rest = asked.partition(".")
    parts = {name: name.split(".", 2) for name in listed}
    below = [name for name in listed if name.startswith(f"{asked}.")]
    return below or [name for name in listed if rest and parts[name][::2] == [first, rest]]


def analysis_of(response: str) -> str:
    """The analysis that a response is from. Raises InputError: none that can be differentiated."""
    name = response.partition(".")[0]
    if name not in SOURCES:
        expected = f"one with a derivative, of {', '.join(SOURCES)}"
        raise InputError(f'responses: found "{cut(response)}", expected {expected}')
    return name


# Analyses of a motion in which forces keep contacts.
_IN_CONTACT = ("steady_state", "forces", "cam_force")


def lost_in(machine: Machine, responses: Sequence[str]) -> tuple[str, ...]:
    """Contacts that the machine loses, of whose motion in contact the derivatives are, in sentences."""
    from linkwright.kinetostatics.contact import lost_contacts

    analyses = {name.partition(".")[0] for name in responses}
    return lost_contacts(machine) if analyses.intersection(_IN_CONTACT) else ()
