"""A study: every analysis that a machine allows, what it cannot do, and what its designer should know.

| order | analysis | needs |
| --- | --- | --- |
| 1 | `reduction`, `constant_energy` | a mechanism that closes all round |
| 2 | `steady_state` | a motor |
| 3 | `run_up` | steady motion to settle to |
| 4 | `run_down` | a brake, and steady motion to begin with |
| 5 | `forces` | steady motion to act in |
| 6 | `linkage` | a linkage that closes somewhere |
| 7 | `pumping_unit`, `rod_rotator` | such a unit, such a rotator; nothing of the above |
| 8 | `topper` | a topper; a mechanism that closes if that moves its knife |

What fails becomes a finding, and the study goes on with what does not depend on it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

from linkwright.analysis.cam.faults import cam_cautions
from linkwright.analysis.cam.follower_vibration import FollowerVibration, follower_vibration
from linkwright.analysis.cam.least_sizes import LeastSizes, least_sizes
from linkwright.analysis.cam.loaded import LoadedCam, loaded_cam
from linkwright.analysis.cam.one_mass import one_mass
from linkwright.analysis.cam.profile import CamProfile
from linkwright.analysis.cautions import cautions, has_inertia
from linkwright.analysis.constant_energy import ConstantEnergy, constant_energy_of
from linkwright.analysis.findings import Findings, sentence
from linkwright.analysis.forces import forces
from linkwright.analysis.gear_torque import GearTorque
from linkwright.analysis.kinetostatics.motion import Motion
from linkwright.analysis.kinetostatics.result import Forces
from linkwright.analysis.linkage import Linkage, linkage
from linkwright.analysis.pumping_unit import PumpingUnitMotion, pumping_unit
from linkwright.analysis.reduction import Reduction, reduction
from linkwright.analysis.result import Result, finite
from linkwright.analysis.rod_rotator import RodRotatorMotion, rod_rotator
from linkwright.analysis.run_down import RunDown, run_down
from linkwright.analysis.run_up import RunUp, run_up, start_of
from linkwright.analysis.sound_loads import require_turn
from linkwright.analysis.soundness import sound_cams
from linkwright.analysis.steady_state import SteadyState, steady_state
from linkwright.analysis.step_method import StepMotion, step_method
from linkwright.analysis.topper.cautions import topper_cautions, topper_findings
from linkwright.analysis.topper.topper import TopperStudy, topper
from linkwright.analysis.transient import Transient, transient
from linkwright.analysis.unit_cautions import unit_cautions
from linkwright.engine import compile_machine, drive_inertia
from linkwright.machine import ConstantSpeedMotor, Machine
from linkwright.public import public

# Intervals of the turn for all curves, a quarter of a degree: what the constant-energy limit and the run-up
# ask of the curves that they are given.
_INTERVALS = 1440

# Intervals of the turn for forces, a degree: no line shows more, and four times as many take as much time as
# all the rest.
_INTERVALS_OF_FORCES = 360

# A run-up that failed is followed again for its curve alone: no line shows more than this.
_ATTEMPT_ACCURACY = 1e-6


@dataclass(frozen=True)
class Study:
    """All that is known about a machine.

    Attributes
    ----------
    machine : Machine
        The machine.
    reduction, constant_energy, steady_state, run_up, run_down, step_method, forces : Result or None
        Results by analysis; None where there is none.
    pumping_unit, rotator : Result or None
        Motion of the polished rod and of its rotator.
    topper : TopperStudy or None
        What the knife of a topper cuts.
    linkage : Linkage or None
        Extreme positions, transmission angles and Grashof classes.
    cams : tuple of CamProfile
        Its cams; ``"cam"`` among the results, or ``"cam.NAME"`` if there are several.
    cam_sizes : tuple of LeastSizes
        How small each might be, ``"cam_sizes"``.
    loaded_cams : tuple of LoadedCam
        The same under load, ``"cam_force"``.
    cam_vibrations : tuple of str and FollowerVibration
        Names of the cams whose follower vibrates, and how at the design speed, ``"cam_vibration"``.
    attempt : Transient or None
        The motion from the start to the stall, where the run-up fails on the way.
    findings : tuple of str
        What the machine cannot do, in sentences.
    warnings : tuple of str
        What its designer should know, in sentences.
    """

    machine: Machine
    reduction: Reduction | None = None
    constant_energy: ConstantEnergy | None = None
    steady_state: SteadyState | None = None
    run_up: RunUp | None = None
    run_down: RunDown | None = None
    step_method: StepMotion | None = None
    attempt: Transient | None = None
    forces: Forces | None = None
    pumping_unit: PumpingUnitMotion | None = None
    rotator: RodRotatorMotion | None = None
    topper: TopperStudy | None = None
    linkage: Linkage | None = None
    cams: tuple[CamProfile, ...] = ()
    cam_sizes: tuple[LeastSizes, ...] = ()
    loaded_cams: tuple[LoadedCam, ...] = ()
    cam_vibrations: tuple[tuple[str, FollowerVibration], ...] = ()
    findings: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()

    @property
    def gear_torque(self) -> GearTorque | None:
        """Torque of the gearbox of a pumping unit under its load."""
        return self.pumping_unit.gear if self.pumping_unit else None

    def results(self) -> dict[str, Result]:
        """The results that there are, by analysis."""
        first = ("topper", "linkage", "pumping_unit", "gear_torque", "rotator", "reduction")
        names = (*first, "constant_energy", "steady_state", "step_method", "run_up", "run_down", "forces")
        found: dict[str, Result | None] = {name: getattr(self, name) for name in names}
        single = len(self.cams) == 1
        cams: dict[str, Result] = {"cam" if single else f"cam.{each.name}": each for each in self.cams}
        cams |= {"cam_sizes" if single else f"cam_sizes.{each.name}": each for each in self.cam_sizes}
        cams |= {"cam_force" if single else f"cam_force.{each.name}": each for each in self.loaded_cams}
        cams |= {
            "cam_vibration" if single else f"cam_vibration.{name}": each for name, each in self.cam_vibrations
        }
        return {**cams, **{name: result for name, result in found.items() if result is not None}}

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Name, results, findings and warnings, ready for JSON.

        Parameters
        ----------
        curves : bool
            Whether arrays are included.

        Returns
        -------
        dict
            SI numbers under the names of the results' attributes; None in place of a number that is not
            finite. The findings stand first among the warnings too.
        """
        results = {name: result.to_dict(curves=curves) for name, result in self.results().items()}
        return {
            "machine": self.machine.name,
            "results": finite(results),
            "findings": list(self.findings),
            "warnings": [*self.findings, *self.warnings],
        }


@public
def study(machine: Machine, *, accuracy: float = 1e-10, step: float | None = None) -> Study:
    """Study a machine: reduction, steady motion, run-up, and run-down if there is a brake.

    Parameters
    ----------
    machine : Machine
        The machine; motor, bodies and loads may be missing.
    accuracy : float
        Relative accuracy of the steady speed, 1e-13 to 1e-2.
    step : float, optional
        Step of the crank angle [rad] for the step method beside the exact solution; without it, none.

    Returns
    -------
    Study
        What could be computed, and findings in place of what could not.

    Raises
    ------
    InputError
        The accuracy or the step makes no sense.
    """
    found = Findings()
    cut = found.of(topper, machine) if machine.topper else None
    if machine.is_topper_alone:
        return _topped(Study(machine, findings=found.findings), cut)
    unit = found.of(pumping_unit, machine, n=_INTERVALS) if machine.pumping_unit else None
    rotator = found.of(rod_rotator, machine, n=_INTERVALS) if machine.rod_rotator else None
    moved = found.of(linkage, machine)
    cams, sound = sound_cams(machine, found)
    driven = _moved(machine, found) if _is_motion_alone(machine) else _driven(machine, found, accuracy, step)
    loaded = _loaded(machine, sound, driven.forces, found)
    shaken = tuple(each for cam in cams for each in _vibration(cam, found))
    whole = replace(
        driven,
        pumping_unit=unit,
        rotator=rotator,
        linkage=moved if moved is not None and moved.elements else None,
        cams=cams,
        cam_sizes=tuple(least_sizes(each) for each in cams),
        loaded_cams=loaded,
        cam_vibrations=shaken,
        findings=found.findings,
        warnings=(
            *unit_cautions(machine, unit, rotator),
            *_cam_warnings(cams),
            *driven.warnings,
            *found.warnings,
        ),
    )
    return _topped(whole, cut)


def _topped(known: Study, cut: TopperStudy | None) -> Study:
    """A study with what the knife of its topper cuts."""
    described = known.machine.topper
    if described is None or cut is None:
        return known
    findings = (*known.findings, *topper_findings(described, cut))
    return replace(
        known, topper=cut, findings=findings, warnings=(*topper_cautions(described, cut), *known.warnings)
    )


def _loaded(
    machine: Machine, cams: tuple[CamProfile, ...], borne: Forces | None, found: Findings
) -> tuple[LoadedCam, ...]:
    """The cams that can be made under load; a follower that leaves its cam is a finding."""
    speed = None if machine.drive is None else machine.drive.speed
    if not (machine.bodies or machine.loads) or (borne is None and speed is None):
        return ()
    along = None if borne is not None else speed
    loaded = [found.of(loaded_cam, machine, each, along) for each in cams]
    return tuple(each for each in loaded if each is not None)


def _vibration(profile: CamProfile, found: Findings) -> Iterator[tuple[str, FollowerVibration]]:
    """Vibration of a follower at the design speed; strikes and loss of contact are findings."""
    train, speed = profile.cam.train, profile.speed
    leaps = any(joint.order < 0 for joint in profile.cam.motion.joints)
    if train is None or not speed or leaps:
        return
    about = found.about(f"cam {profile.name}: ")
    shaken = about.of(follower_vibration, profile.cam.lift, one_mass(train), abs(speed))
    if shaken is not None:
        yield profile.name, shaken


def _cam_warnings(cams: tuple[CamProfile, ...]) -> tuple[str, ...]:
    return tuple(sentence(text) for each in cams for text in cam_cautions(each))


def _is_motion_alone(machine: Machine) -> bool:
    """Whether there is nothing but motion to compute: no masses, no loads, no motor."""
    inertia = 0.0 if machine.drive is None else drive_inertia(machine.drive)
    return not (machine.bodies or machine.loads or _has_motor(machine) or inertia)


def _moved(machine: Machine, found: Findings) -> Study:
    """A linkage by its dimensions alone."""
    found.of(require_turn, machine)
    alone = "The machine has no masses, loads or motor: its motion alone is computed."
    return Study(machine, warnings=() if machine.pumping_unit else (alone,))


def _driven(machine: Machine, found: Findings, accuracy: float, step: float | None) -> Study:
    """What follows from bodies, loads and drive."""
    reduced = found.of(reduction, machine, n=_INTERVALS)
    if reduced is None:
        return Study(machine)
    # Without inertia at some angle there is no energy to stay constant.
    limit = constant_energy_of(reduced, compile_machine(machine).first()) if has_inertia(reduced) else None
    if not _has_motor(machine):
        return Study(machine, reduced, limit, warnings=cautions(machine, reduced, None))
    steady = found.of(steady_state, machine, accuracy=accuracy, n=_INTERVALS)
    started, attempt = _run_up(machine, steady, found)
    stopped = found.of(run_down, machine, steady=steady) if steady and _has_brake(machine) else None
    stepped = found.of(step_method, machine, step=step) if step is not None else None
    # Angles without an answer for forces are no fault of the motion: they are said as warnings.
    borne = found.beside_of(_forces, machine, steady) if steady else None
    return Study(
        machine,
        reduced,
        limit,
        steady,
        started,
        stopped,
        stepped,
        attempt,
        borne,
        warnings=cautions(machine, reduced, steady),
    )


def _forces(machine: Machine, steady: SteadyState) -> Forces:
    """Forces along the steady motion, at some of its angles."""
    some = slice(None, None, _INTERVALS // _INTERVALS_OF_FORCES)
    curves = (steady.crank_angle, steady.speed, steady.acceleration, steady.time)
    return forces(machine, Motion(*(curve[some] for curve in curves)))


def _run_up(
    machine: Machine, steady: SteadyState | None, found: Findings
) -> tuple[RunUp | None, Transient | None]:
    """The run-up, or how far it comes."""
    if _keeps_speed(machine):
        return None, None
    if steady is None:
        # Without steady motion nothing says when it has run up, but it may be that it cannot even start.
        found.of(start_of, machine)
        return None, _attempt(machine, found)
    started = found.of(run_up, machine, steady=steady)
    return started, None if started else _attempt(machine, found)


def _attempt(machine: Machine, found: Findings) -> Transient | None:
    """The motion from the start to the stall; None if it never moves or cannot be followed."""
    options = machine.run_up
    start = {"angle": options.angle_start, "speed": options.speed_start, "turns": options.turns_max}
    motion = found.of(transient, machine, accuracy=_ATTEMPT_ACCURACY, **start)
    return motion if motion is not None and motion.turns > 0 else None


def _has_motor(machine: Machine) -> bool:
    return machine.drive is not None and machine.drive.motor is not None


def _has_brake(machine: Machine) -> bool:
    return machine.drive is not None and machine.drive.brake is not None


def _keeps_speed(machine: Machine) -> bool:
    return machine.drive is not None and isinstance(machine.drive.motor, ConstantSpeedMotor)
