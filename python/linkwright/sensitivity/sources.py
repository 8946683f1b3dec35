"""What can be differentiated: results of each analysis with their derivatives by entries of the machine.

| responses | by |
| --- | --- |
| ``steady_state.…`` | Newton's step in dual numbers at the solution (`linkwright.drive.gradient`) |
| ``run_up.…``, ``run_down.…`` | the variational equation (`linkwright.drive.gradient_in_time`) |
| ``free_vibration.natural_frequencies.1`` | Rayleigh's quotient (`linkwright.torsion.gradient.modes`) |
| ``free_vibration.mode_shapes.1.DISC`` | all modes, or the dynamic stiffness (there too) |
| ``forced_vibration.shaft_torque_vibratory.SHAFT`` | the adjoint (`linkwright.torsion.gradient.forced`) |
| ``forced_vibration.shaft_torque_max.SHAFT`` | there too |
| ``turning_moment.…`` | integrals of the torques' derivatives (`linkwright.turning.gradient`) |
| ``pumping_unit.…`` | the transfer functions of the beam (`linkwright.pumping.gradient`) |
| ``rod_rotator.…`` | places of the stroke, the slope of the lever (`linkwright.pumping.rotator_gradient`) |
| ``topper.…`` | closed forms, and conditions of the worst head (`linkwright.topping.gradient`) |
| ``cam.CAM.…`` | the law and the contact in tangents (`linkwright.cam.gradient`) |
| ``cam_force.CAM.…`` | the same, and Hertz' formula (`linkwright.cam.dynamics.gradient`) |
| ``linkage.ELEMENT.…`` | the motion at fixed crank angles (`linkwright.linkages.gradient`) |
| ``forces.…``, ``forces.reaction_max.PAIR`` | the equilibrium (`linkwright.kinetostatics.gradient`) |
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from linkwright.drive.gradient import steady_tangents
from linkwright.drive.model.motor import ConstantSpeedMotor
from linkwright.drive.steady_state import SteadyState
from linkwright.kernel.errors import InputError, cut
from linkwright.kernel.numerics.tangent import Tangent
from linkwright.kernel.quantities import Label, declared, shown
from linkwright.machine.machine import Machine
from linkwright.machine.tangents import Derivatives, directions


@dataclass(frozen=True)
class Source:
    """Responses of an analysis with their derivatives by `variables`, those of the entries asked for that
    have some.

    `words` and `units` by response; `ties`, `refused` and `missing`, responses without derivatives, with
    their reasons; `usual` are the responses that are given if none is named; `lost` are entries by which the
    move of a kink was not found, each with the crank angle of the kink [rad].
    """

    variables: tuple[str, ...]
    tangents: Mapping[str, Tangent]
    words: Mapping[str, str]
    units: Mapping[str, str]
    ties: Mapping[str, str]
    refused: Mapping[str, str]
    usual: Sequence[str] = field(default=())
    missing: Mapping[str, str] = field(default_factory=dict)
    lost: Mapping[str, float] = field(default_factory=dict)


def usual_analysis(machine: Machine) -> str:
    """The analysis whose results are differentiated if none is named."""
    motor = None if machine.drive is None else machine.drive.motor
    if motor is not None and not isinstance(motor, ConstantSpeedMotor):
        return "steady_state"
    if machine.train is not None or (machine.drive is not None and machine.drive.twists):
        return "free_vibration"
    own = {
        "turning_moment": machine.turning_moment,
        "topper": machine.topper,
        "pumping_unit": machine.pumping_unit,
        "cam": machine.mechanism.cams or None,
    }
    last = "linkage" if motor is None else "steady_state"
    return next((name for name, part in own.items() if part is not None), last)


def source(machine: Machine, analysis: str, variables: Sequence[str]) -> Source:
    """Results of an analysis along entries of a machine. Raises what the analysis raises."""
    return SOURCES[analysis](machine, variables)


def _steady(machine: Machine, variables: Sequence[str]) -> Source:
    """Scalars of steady motion."""
    program = directions(machine, variables)
    steady = steady_tangents(machine, program)
    listed = [name for name, (_, mark) in declared(SteadyState).items() if isinstance(mark, Label)]
    values = {name: getattr(steady.state, name) for name in listed}
    tangents = {name: value for name, value in values.items() if isinstance(value, Tangent)}
    nothing = _nothing(tangents, steady.rounding)
    missing = dict.fromkeys(sorted(nothing), "it is zero within rounding error")
    missing |= {name: _BETWEEN for name in _OF_MOTOR if name not in tangents}
    tangents = {name: value for name, value in tangents.items() if name not in nothing}
    marks = {name: shown(SteadyState, name) for name in tangents}
    return Source(
        program.variables,
        {f"steady_state.{name}": value for name, value in tangents.items()},
        {f"steady_state.{name}": f"{mark.word} {mark.symbol}".strip() for name, mark in marks.items()},
        {f"steady_state.{name}": mark.unit for name, mark in marks.items()},
        {f"steady_state.{name}": reason for name in tangents if (reason := _tie(name, steady.ties))},
        program.refused,
        [f"steady_state.{name}" for name in tangents],
        {f"steady_state.{name}": why for name, why in missing.items()},
        steady.lost,
    )


# Extremes of the motor, and why one has no derivative.
_OF_MOTOR = ("torque_motor_min", "torque_motor_max", "power_motor_max")
_BETWEEN = "the extreme occurs at a speed between minimum and maximum, such as the breakdown speed"

# Ratio → what it is a ratio of.
_RATIOS = {
    "cyclic_load_factor": ("torque_motor_rms", "torque_motor_mean"),
    "efficiency": ("energy_load", "energy_motor"),
}


def _nothing(tangents: Mapping[str, Tangent], rounding: Mapping[str, float]) -> set[str]:
    """Scalars that are zero but for rounding, and ratios of them; one that nothing moves stays zero."""
    nothing = {
        name
        for name, least in rounding.items()
        if name in tangents and abs(tangents[name].value) <= least and tangents[name].d.any()
    }
    return nothing | {ratio for ratio, of in _RATIOS.items() if nothing & {*of} and ratio in tangents}


def _constant_energy(machine: Machine, variables: Sequence[str]) -> Source:
    """Measures of speed fluctuation at constant kinetic energy."""
    from linkwright.drive.evenness import ConstantEnergy
    from linkwright.drive.gradient_at_constant_energy import constant_energy_tangents

    return _of_scalars("constant_energy", ConstantEnergy, constant_energy_tangents(machine, variables))


def _run_up(machine: Machine, variables: Sequence[str]) -> Source:
    """Time, revolutions and peak speed of the run-up."""
    from linkwright.drive.gradient_in_time import run_up_tangents
    from linkwright.drive.run_up import RunUp

    return _of_scalars("run_up", RunUp, run_up_tangents(machine, variables))


def _run_down(machine: Machine, variables: Sequence[str]) -> Source:
    """Time and revolutions of the run-down."""
    from linkwright.drive.gradient_in_time import run_down_tangents
    from linkwright.drive.run_up import RunDown

    return _of_scalars("run_down", RunDown, run_down_tangents(machine, variables))


# Extremes → what is made of them.
_MADE_OF = {
    "speed": (
        *("speed_mean_extremes", "unevenness", "unevenness_time", "motion_coefficient"),
        *("motion_coefficient_time", "dynamism", "torque_motor_min", "torque_motor_max", "power_motor_max"),
    ),
    "acceleration": ("dynamism", "dynamism_time", "motion_coefficient", "motion_coefficient_time"),
}


def _tie(name: str, ties: Mapping[str, str]) -> str:
    """Why a scalar of the motion has only one-sided derivatives; empty if it has one."""
    for extreme, reason in ties.items():
        if name == extreme or name in _MADE_OF[extreme.partition("_")[0]]:
            return f"{extreme.replace('_', ' ')}: {reason}"
    return ""


def _free(machine: Machine, variables: Sequence[str]) -> Source:
    """Natural frequencies and mode shapes."""
    from linkwright.torsion.gradient.modes import mode_tangents

    tangents = mode_tangents(machine, variables)
    frequencies = {
        f"free_vibration.natural_frequencies.{i}": tangent
        for i, tangent in tangents.natural_frequencies.items()
    }
    shapes = {
        f"free_vibration.mode_shapes.{i}.{disc}": tangent
        for (i, disc), tangent in tangents.mode_shapes.items()
    }
    words = {name: f"natural frequency of mode {name.rsplit('.', 1)[-1]}" for name in frequencies}
    words |= {
        f"free_vibration.mode_shapes.{i}.{disc}": f"amplitude of {disc} in mode {i}"
        for i, disc in tangents.mode_shapes
    }
    units = dict.fromkeys(frequencies, "Hz") | dict.fromkeys(shapes, "")
    ties = {f"free_vibration.natural_frequencies.{i}": reason for i, reason in tangents.ties.items()}
    ties |= {
        f"free_vibration.mode_shapes.{i}.{disc}": tangents.shape_ties[i]
        for i, disc in tangents.mode_shapes
        if i in tangents.shape_ties
    }
    missing = {
        f"free_vibration.mode_shapes.{i}.{disc}": reason for (i, disc), reason in tangents.missing.items()
    }
    return Source(
        *(tangents.variables, frequencies | shapes, words, units, ties, tangents.refused),
        usual=list(frequencies),
        missing=missing,
    )


def _forced(machine: Machine, variables: Sequence[str]) -> Source:
    """Largest torques of shafts over the speeds."""
    from linkwright.torsion.gradient.forced import forced_tangents

    forced = forced_tangents(machine, variables)
    kinds = {"vibratory": "shaft_torque_vibratory", "greatest": "shaft_torque_max"}
    said = {"vibratory": "largest vibratory torque of", "greatest": "largest torque of"}
    tangents, words, ties = {}, {}, {}
    for kind, quantity in kinds.items():
        for shaft, tangent in getattr(forced, kind).items():
            name = f"forced_vibration.{quantity}.{shaft}"
            tangents[name], words[name] = tangent, f"{said[kind]} {shaft} over the speeds"
            if reason := forced.ties.get(f"{kind}.{shaft}"):
                ties[name] = reason
    units = dict.fromkeys(tangents, "N m")
    return Source(forced.variables, tangents, words, units, ties, forced.refused, list(tangents))


def _forces(machine: Machine, variables: Sequence[str]) -> Source:
    """Largest forces and torques in the motion of the machine."""
    from linkwright.kinetostatics.gradient import force_tangents
    from linkwright.kinetostatics.result import Forces

    derived = force_tangents(machine, variables)
    pairs = [name for name in (*derived.tangents, *derived.missing) if name.startswith("reaction_max.")]
    words = {name: f"maximum force of {name.partition('.')[2]}" for name in pairs}
    return _of_scalars("forces", Forces, derived, words, dict.fromkeys(pairs, "N"))


def _linkage(machine: Machine, variables: Sequence[str]) -> Source:
    """Strokes, swings, time ratios and transmission angles."""
    from linkwright.linkages.cycle import ElementMotion
    from linkwright.linkages.gradient import linkage_tangents

    derived = linkage_tangents(machine, variables)
    marks = {name: shown(ElementMotion, name.rpartition(".")[2]) for name in derived.tangents}
    words = {name: f"{mark.word} of {name.rpartition('.')[0]}" for name, mark in marks.items()}
    return _of_scalars("linkage", ElementMotion, derived, words, {k: mark.unit for k, mark in marks.items()})


def _turning(machine: Machine, variables: Sequence[str]) -> Source:
    """Fluctuation of energy, flywheel and rim of a turning-moment diagram."""
    from linkwright.turning.diagram import TurningMomentDiagram
    from linkwright.turning.gradient import turning_tangents

    return _of_scalars("turning_moment", TurningMomentDiagram, turning_tangents(machine, variables))


def _cams(machine: Machine, variables: Sequence[str]) -> Source:
    """Motion and geometry of all cams."""
    from linkwright.cam.gradient import cam_tangents
    from linkwright.cam.profile.profile import CamProfile, the_cam, unit_in

    names = list(machine.mechanism.cams) or [the_cam(machine)[0]]
    alone = {name: cam_tangents(machine, name, variables) for name in names}
    refused = {entry: why for one in alone.values() for entry, why in one.refused.items()}
    kept = tuple(entry for entry in variables if entry not in refused)
    parts = []
    for name, one in alone.items():
        units = {
            key: unit_in(shown(CamProfile, key).unit, machine.mechanism.cams[name]) for key in one.tangents
        }
        parts.append(_of_scalars(f"cam.{name}", CamProfile, one.only(kept), units=units))
    return _joined(kept, parts, refused)


def _cam_forces(machine: Machine, variables: Sequence[str]) -> Source:
    """Normal force and contact pressure of all cams."""
    from linkwright.cam.dynamics.gradient import cam_force_tangents
    from linkwright.cam.dynamics.loaded import LoadedCam
    from linkwright.cam.profile.profile import the_cam

    names = list(machine.mechanism.cams) or [the_cam(machine)[0]]
    alone = {name: cam_force_tangents(machine, name, variables) for name in names}
    refused = {entry: why for one in alone.values() for entry, why in one.refused.items()}
    kept = tuple(entry for entry in variables if entry not in refused)
    parts = [_of_scalars(f"cam_force.{name}", LoadedCam, one.only(kept)) for name, one in alone.items()]
    return _joined(kept, parts, refused)


def _pumping(machine: Machine, variables: Sequence[str]) -> Source:
    """Stroke, torque factors and motion of the polished rod."""
    from linkwright.pumping.gear_torque import GearTorque
    from linkwright.pumping.gradient import pumping_tangents
    from linkwright.pumping.unit import PumpingUnitMotion

    derived = pumping_tangents(machine, variables)
    gear = [name for name in derived.tangents if name.startswith("gear.")]
    marks = {name: shown(GearTorque, name.partition(".")[2]) for name in gear}
    words = {name: f"{mark.word} {mark.symbol}".strip() for name, mark in marks.items()}
    units = {name: mark.unit for name, mark in marks.items()}
    return _of_scalars("pumping_unit", PumpingUnitMotion, derived, words, units)


def _rotator(machine: Machine, variables: Sequence[str]) -> Source:
    """Lengths, swing, transfer functions, days and forces of the rotator of a rod string."""
    from linkwright.pumping.rod_rotator import RodRotatorMotion
    from linkwright.pumping.rotator_gradient import rotator_tangents

    return _of_scalars("rod_rotator", RodRotatorMotion, rotator_tangents(machine, variables))


def _topper(machine: Machine, variables: Sequence[str]) -> Source:
    """Lengths, shares left, speeds and torques of the knife of a topper."""
    from linkwright.topping.gradient import topper_tangents
    from linkwright.topping.topper import TopperStudy

    return _of_scalars("topper", TopperStudy, topper_tangents(machine, variables))


def _joined(variables: tuple[str, ...], parts: Sequence[Source], refused: Mapping[str, str]) -> Source:
    """Several results of one kind."""

    def merged(field: str) -> dict[str, Any]:
        return {name: value for part in parts for name, value in getattr(part, field).items()}

    usual = [name for part in parts for name in part.usual]
    tangents, words, units, ties = (merged(field) for field in ("tangents", "words", "units", "ties"))
    return Source(variables, tangents, words, units, ties, refused, usual, merged("missing"), merged("lost"))


def _of_scalars(
    prefix: str,
    kind: type,
    derived: Derivatives,
    words: Mapping[str, str] | None = None,
    units: Mapping[str, str] | None = None,
) -> Source:
    """Scalars of a result, called as they are declared, and others by `words` and `units`."""
    marks = {name: shown(kind, name) for name in derived.tangents if name not in (words or {})}
    words = {name: f"{mark.word} {mark.symbol}".strip() for name, mark in marks.items()} | dict(words or {})
    units = {name: mark.unit for name, mark in marks.items()} | dict(units or {})
    listed = [f"{prefix}.{name}" for name in derived.tangents]
    return Source(
        derived.variables,
        {f"{prefix}.{name}": value for name, value in derived.tangents.items()},
        {f"{prefix}.{name}": word for name, word in words.items()},
        {f"{prefix}.{name}": unit for name, unit in units.items()},
        {f"{prefix}.{name}": reason for name, reason in derived.ties.items()},
        derived.refused,
        listed,
        {f"{prefix}.{name}": reason for name, reason in derived.missing.items()},
        derived.lost,
    )


# Analysis → its results with derivatives.
SOURCES: dict[str, Callable[[Machine, Sequence[str]], Source]] = {
    "steady_state": _steady,
    "constant_energy": _constant_energy,
    "run_up": _run_up,
    "run_down": _run_down,
    "free_vibration": _free,
    "forced_vibration": _forced,
    "cam": _cams,
    "linkage": _linkage,
    "forces": _forces,
    "turning_moment": _turning,
    "pumping_unit": _pumping,
    "rod_rotator": _rotator,
    "topper": _topper,
    "cam_force": _cam_forces,
}


def chosen(listed: Collection[str], asked: str) -> list[str]:
    """Responses that a name means: its own, all that begin with it, or of every cam where it names none."""
    if asked in listed:
        return [asked]
    first, _, rest = asked.partition(".")
    below = [name for name in listed if name.startswith(f"{asked}.")]
    return below or [name for name in listed if rest and name.split(".")[::2] == [first, rest]]


def analysis_of(response: str) -> str:
    """The analysis that a response is from.

    Raises InputError: none that can be differentiated.
    """
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
