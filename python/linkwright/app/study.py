"""A study: every analysis that a machine allows, what it cannot do, and what its designer should know.

| order | analysis | needs |
| --- | --- | --- |
| 1 | `turning_moment` | such a diagram |
| 1 | `topper` | a topper; a mechanism that closes if that moves its knife |
| 2 | `pumping_unit`, `rod_rotator` | such a unit, such a rotator |
| 3 | `linkage` | a linkage that closes somewhere |
| 4 | cams | cams |
| 5 | drive | bodies, loads or a motor |
| 6 | `forces` | steady motion to act in |

What fails becomes a finding, and the study goes on with what does not depend on it. A subject is imported
when the machine has its table.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

from linkwright.drive.cycle_motion import CycleMotion, cycle_motion_of
from linkwright.drive.sound_loads import require_turn
from linkwright.drive.steady_state import SteadyState, require_accuracy
from linkwright.drive.step_method import whole_steps
from linkwright.drive.study import INTERVALS, DriveStudy, drive_study, has_motor
from linkwright.kernel.findings import Findings
from linkwright.kernel.public import public
from linkwright.kernel.result import Result, finite
from linkwright.kinetostatics.collect import LEAVES
from linkwright.kinetostatics.contact_in_time import contact_losses
from linkwright.kinetostatics.forces import forces
from linkwright.kinetostatics.motion import Motion
from linkwright.kinetostatics.result import Forces
from linkwright.linkages.cautions import linkage_cautions
from linkwright.linkages.closure import is_screw
from linkwright.linkages.cycle import Linkage, linkage
from linkwright.linkages.idle_parts import idle_parts
from linkwright.linkages.law_jumps import law_cautions, shaft_of_laws
from linkwright.linkages.whole_cycle import over_whole_cycle
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine
from linkwright.machine.program.drive_line import drive_inertia

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.cam.dynamics.follower_vibration import FollowerVibration
    from linkwright.cam.dynamics.loaded import LoadedCam
    from linkwright.cam.profile.least_sizes import LeastSizes
    from linkwright.cam.profile.profile import CamProfile
    from linkwright.pumping.gear_torque import GearTorque
    from linkwright.pumping.rod_rotator import RodRotatorMotion
    from linkwright.pumping.unit import PumpingUnitMotion
    from linkwright.topping.model.topper import Topper
    from linkwright.topping.topper import TopperStudy
    from linkwright.turning.diagram import TurningMomentDiagram

# Intervals of the revolution for forces, a degree: no line shows more, and four times as many take as much
# time as all the rest.
_INTERVALS_OF_FORCES = 360


@dataclass(frozen=True)
class Study(DriveStudy):
    """All that is known about a machine, its drive first.

    Attributes
    ----------
    forces : Forces or None
        Forces along the steady motion.
    pumping_unit, rotator : Result or None
        Motion of the polished rod and of its rotator.
    topper : TopperStudy or None
        What the knife of a topper cuts.
    turning_moment : TurningMomentDiagram or None
        Fluctuation of energy of a turning-moment diagram, and its flywheel.
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
    findings : tuple of str
        What the machine cannot do, in sentences.
    accuracy : float
        Relative accuracy of the steady speed.
    """

    forces: Forces | None = None
    pumping_unit: PumpingUnitMotion | None = None
    rotator: RodRotatorMotion | None = None
    topper: TopperStudy | None = None
    turning_moment: TurningMomentDiagram | None = None
    linkage: Linkage | None = None
    cams: tuple[CamProfile, ...] = ()
    cam_sizes: tuple[LeastSizes, ...] = ()
    loaded_cams: tuple[LoadedCam, ...] = ()
    cam_vibrations: tuple[tuple[str, FollowerVibration], ...] = ()
    findings: tuple[str, ...] = ()
    accuracy: float = field(default=1e-10, repr=False)

    @cached_property
    @public
    def motion(self) -> CycleMotion | None:
        """Motion of every point, link and slide over the cycle; computed when it is first asked for."""
        if self.linkage is None:
            return None
        return cycle_motion_of(self.machine, self.linkage, self.steady_state, self.accuracy)

    @property
    def gear_torque(self) -> GearTorque | None:
        """Torque of the gearbox of a pumping unit under its load."""
        return self.pumping_unit.gear if self.pumping_unit else None

    @property
    def knife(self) -> tuple[Topper, TopperStudy] | None:
        """The topper with what its knife cuts; None without one."""
        described, cut = self.machine.topper, self.topper
        return None if described is None or cut is None else (described, cut)

    def results(self) -> dict[str, Result]:
        """The results that there are, by analysis."""
        first = ("turning_moment", "topper", "linkage", "motion", "pumping_unit", "gear_torque", "rotator")
        names = (
            *first,
            "reduction",
            "constant_energy",
            "steady_state",
            "step_method",
            "run_up",
            "run_down",
            "forces",
        )
        results: dict[str, Result | None] = {name: getattr(self, name) for name in names}
        if self.linkage is not None and not self.linkage.elements:
            # Followers and other drivers alone: their motion says all.
            results["linkage"] = None
        single = len(self.cams) == 1
        cams: dict[str, Result] = {"cam" if single else f"cam.{cam.name}": cam for cam in self.cams}
        cams |= {"cam_sizes" if single else f"cam_sizes.{size.name}": size for size in self.cam_sizes}
        cams |= {"cam_force" if single else f"cam_force.{cam.name}": cam for cam in self.loaded_cams}
        cams |= {
            "cam_vibration" if single else f"cam_vibration.{name}": vibration
            for name, vibration in self.cam_vibrations
        }
        return {**cams, **{name: result for name, result in results.items() if result is not None}}

    def plot(self, *names: str, over: str | None = None) -> Figure:
        """Curves by name as a figure, an axis for each unit; the first figure of the report without names.

        Parameters
        ----------
        *names : str
            Curves as `linkwright plot` lists them, such as ``"ram.velocity"``.
        over : str, optional
            What they run over, such as ``"time"``; the crank angle without it.

        Returns
        -------
        matplotlib.figure.Figure
            A notebook shows it; ``figure.savefig(path)`` writes it.

        Raises
        ------
        InputError
            There is no such curve, or nothing to draw.
        """
        from linkwright.app.plotted import study_figure

        return study_figure(self, names, over)

    def _repr_html_(self) -> str:
        """Failed checks, warnings and all results, as a notebook shows them."""
        from linkwright.kernel.page.notebook import study_html

        return study_html(self, self.results())

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
    require_accuracy(accuracy)
    if step is not None:
        whole_steps(step)
    findings = Findings()
    diagram = _diagram(machine, findings)
    if machine.is_diagram_alone:
        return Study(machine, turning_moment=diagram, findings=findings.findings, warnings=findings.warnings)
    cut = _cut(machine, findings)
    if machine.is_topper_alone:
        return _topped(Study(machine, turning_moment=diagram, findings=findings.findings), cut)
    unit, rotator = _pumped(machine, findings)
    moved = findings.of(linkage, machine)
    if moved is not None:
        findings.add(idle_parts(machine))
        findings.warn((*linkage_cautions(moved), *law_cautions(machine), *shaft_of_laws(machine)))
        if moved.closure.turns_fully and machine.drive is not None and machine.drive.motor is not None:
            findings.of(over_whole_cycle, compile_machine(machine))
    result = _turned(machine, findings, accuracy, step)
    result = replace(
        result,
        pumping_unit=unit,
        rotator=rotator,
        turning_moment=diagram,
        linkage=moved if moved is not None and _has_outputs(machine, moved) else None,
        accuracy=accuracy,
    )
    result = _with_cams(result, findings)
    _losses_in_time(result, findings)
    warnings = (*_of_units(result), *result.warnings, *findings.warnings)
    return _topped(replace(result, findings=findings.findings, warnings=warnings), cut)


def _diagram(machine: Machine, findings: Findings) -> TurningMomentDiagram | None:
    """The turning-moment diagram of a shaft."""
    if machine.turning_moment is None:
        return None
    from linkwright.turning.diagram import turning_moment

    diagram = findings.of(turning_moment, machine)
    if diagram is not None:
        findings.warn(diagram.warnings)
    return diagram


def _cut(machine: Machine, findings: Findings) -> TopperStudy | None:
    """What the knife of a topper cuts."""
    if machine.topper is None:
        return None
    from linkwright.topping.topper import topper

    return findings.of(topper, machine)


def _topped(known: Study, cut: TopperStudy | None) -> Study:
    """A study with what the knife of its topper cuts."""
    described = known.machine.topper
    if described is None or cut is None:
        return known
    from linkwright.topping.cautions import topper_cautions, topper_findings

    return replace(
        known,
        topper=cut,
        findings=(*known.findings, *topper_findings(described, cut)),
        warnings=(*topper_cautions(described, cut), *known.warnings),
    )


def _pumped(machine: Machine, findings: Findings) -> tuple[PumpingUnitMotion | None, RodRotatorMotion | None]:
    """The polished rod and the rotator of a pumping unit."""
    if machine.pumping_unit is None:
        return None, None
    from linkwright.pumping.cautions import unit_findings
    from linkwright.pumping.rod_rotator import rod_rotator
    from linkwright.pumping.unit import pumping_unit

    unit = findings.of(pumping_unit, machine, n=INTERVALS)
    findings.add(unit_findings(unit) if unit is not None else ())
    return unit, findings.of(rod_rotator, machine, n=INTERVALS) if machine.rod_rotator else None


def _of_units(known: Study) -> tuple[str, ...]:
    """What the user of a pumping unit or of a rotator should know."""
    if known.machine.pumping_unit is None:
        return ()
    from linkwright.pumping.cautions import unit_cautions

    return unit_cautions(known.machine, known.pumping_unit, known.rotator)


def _with_cams(known: Study, findings: Findings) -> Study:
    """A study with what is known of its cams."""
    machine = known.machine
    if not machine.mechanism.cams:
        return known
    from linkwright.cam.profile.least_sizes import least_sizes
    from linkwright.cam.study import cam_vibrations, cam_warnings, loaded_cams, sound_cams

    cams, sound = sound_cams(machine, findings)
    return replace(
        known,
        cams=cams,
        cam_sizes=tuple(least_sizes(cam) for cam in cams),
        loaded_cams=loaded_cams(machine, sound, known.forces, findings),
        cam_vibrations=cam_vibrations(cams, findings),
        warnings=(*cam_warnings(cams), *known.warnings),
    )


def _losses_in_time(known: Study, findings: Findings) -> None:
    """Followers and cables that lose contact in the run-up or run-down, though not in steady motion."""
    floating = {cam.name for cam in known.loaded_cams if cam.force_min < 0}
    for what, of in (("run-up", known.run_up), ("run-down", known.run_down)):
        losses = findings.beside_of(contact_losses, known.machine, of.motion) if of else None
        lost = [loss for loss in losses or () if not (loss.kind == "cam" and loss.name in floating)]
        findings.about(f"{what}: ").add(loss.sentence() for loss in lost)


def _turned(machine: Machine, findings: Findings, accuracy: float, step: float | None) -> Study:
    """A linkage by its dimensions alone, or what follows from bodies, loads and drive."""
    if _is_motion_alone(machine):
        # The travel of a screw ends, which is no fault of it.
        (findings.beside_of if is_screw(machine) else findings.of)(require_turn, machine)
        alone = "The machine has no masses, loads or motor: only its motion is computed."
        return Study(machine, warnings=() if machine.pumping_unit else (alone,))
    driven = drive_study(machine, findings, accuracy, step)
    steady = driven.steady_state
    # Angles without an answer for forces are no fault of the motion: they are said as warnings.
    borne = findings.beside_of(_forces, machine, steady) if steady else None
    return Study(**vars(driven), forces=borne)


def _has_outputs(machine: Machine, moved: Linkage) -> bool:
    """Whether anything moves that does not turn with the crankshaft: dyads, or a driver such as a cam's."""
    own = machine.linkage
    laws = any(crank.follows() is not None or crank.law is not None for crank in own.cranks.values())
    return bool(moved.elements or own.linear_drivers or laws)


def _is_motion_alone(machine: Machine) -> bool:
    """Whether there is nothing but motion to compute: no masses, no loads, no motor."""
    inertia = 0.0 if machine.drive is None else drive_inertia(machine.drive)
    return not (machine.bodies or machine.loads or has_motor(machine) or inertia)


def _forces(machine: Machine, steady: SteadyState) -> Forces:
    """Forces along the steady motion, at some angles; the analysis of cams finds followers that leave."""
    some = slice(None, None, INTERVALS // _INTERVALS_OF_FORCES)
    curves = (steady.crank_angle, steady.speed, steady.acceleration, steady.time)
    borne = forces(machine, Motion(*(curve[some] for curve in curves)))
    return replace(borne, findings=tuple(text for text in borne.findings if not text.startswith(LEAVES)))
