"""Linkwright: how machines move, from the motor through gearbox and shaft to the mechanism and its work.

>>> import linkwright as lw
>>> machine = lw.read("roller_two_carts")
>>> motion = lw.steady_state(machine)
>>> round(motion.unevenness, 4)
0.085

Public names are loaded when they are first used, so that importing the package costs little.
"""

from __future__ import annotations

# What `signal` is made of, in the interpreter itself; `signal` imports enumerations and collections first.
import _signal  # type: ignore[import-not-found]
import os
import sys
from importlib import import_module

# As in `typing`, whose import takes longer than all else here.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from types import FrameType
    from typing import Any, NoReturn


def end_on_the_spot(number: int, frame: FrameType | None) -> NoReturn:
    """End the command line with what a shell reports for a program that was interrupted."""
    os._exit(130)


# An interrupt while the command line starts would end in a traceback through our files. A program that
# imports the package keeps its own ways.
_program = sys.argv[0].replace("\\", "/").split("/")[-1] if sys.argv else ""
_is_ours = _program in {"linkwright", "linkwright.exe"} or (
    _program == "-m" and "linkwright" in sys.orig_argv
)
if _is_ours and _signal.getsignal(_signal.SIGINT) is _signal.default_int_handler:
    _signal.signal(_signal.SIGINT, end_on_the_spot)

__version__ = "0.1.0"

# Public name → module that holds it.
_HOME = {
    "Machine": "machine.machine",
    "addresses": "machine.address",
    "get": "machine.address",
    "motors": "drive.model.catalogue",
    "read_motors": "drive.model.motor_file",
    "pumping_units": "pumping.model.unit_catalogue",
    "replace": "machine.address",
    "read": "machine.read",
    "loads": "machine.read",
    "write": "machine.write",
    "closure": "linkages.closure",
    "kinematics": "linkages.kinematics",
    "motions": "linkages.kinematics",
    "linkage": "linkages.cycle",
    "zero_angle": "linkages.zero",
    "shown_in": "kernel.page.out_units",
    "circuits": "linkages.circuits",
    "coupler_curve": "linkages.coupler_curve",
    "path_error": "linkages.path_error",
    "centrodes": "linkages.centrodes",
    "period_turns": "linkages.period",
    "pose": "linkages.pose",
    "motion": "linkages.motion",
    "reduction": "drive.reduction",
    "constant_energy": "drive.evenness",
    "steady_state": "drive.steady_state",
    "transient": "drive.transient",
    "motion_events": "drive.motion_events",
    "motion_extremes": "drive.motion_events",
    "contact_losses": "kinetostatics.contact_in_time",
    "cycle_motion": "drive.cycle_motion",
    "run_up": "drive.run_up",
    "run_down": "drive.run_up",
    "step_method": "drive.step_method",
    "gradient": "sensitivity.gradient",
    "forces": "kinetostatics.forces",
    "Friction": "kinetostatics.friction",
    "envelope": "kinetostatics.envelope",
    "load_cases": "kinetostatics.envelope",
    "balance": "kinetostatics.balancing",
    "partial_balance": "kinetostatics.balancing",
    "harmonics": "kinetostatics.envelope",
    "shaking_orders": "kinetostatics.shaking_orders",
    "mobility": "linkages.model.mobility",
    "cam_laws": "cam.law_factors",
    "law_factors": "cam.law_factors",
    "cam_profile": "cam.profile.profile",
    "cam_faults": "cam.profile.faults",
    "cam_cautions": "cam.profile.faults",
    "least_sizes": "cam.profile.least_sizes",
    "loaded_cam": "cam.dynamics.loaded",
    "search_cams": "cam.search",
    "OneMass": "cam.dynamics.one_mass",
    "follower_vibration": "cam.dynamics.follower_vibration",
    "vibration_over_speed": "cam.dynamics.follower_vibration",
    "residual_spectrum": "cam.dynamics.residual_vibration",
    "residual_over_speed": "cam.dynamics.residual_vibration",
    "polydyne": "cam.dynamics.polydyne",
    "cam_course": "cam.dynamics.follower_load",
    "FollowerLoad": "cam.dynamics.follower_load",
    "StemGuide": "cam.dynamics.bearing",
    "ArmPivot": "cam.dynamics.bearing",
    "contact_force": "cam.dynamics.contact_force",
    "lift_off": "cam.dynamics.lift_off",
    "least_preload": "cam.dynamics.lift_off",
    "Material": "cam.dynamics.hertz",
    "line_contact": "cam.dynamics.hertz",
    "pumping_unit": "pumping.unit",
    "rod_rotator": "pumping.rod_rotator",
    "turning_moment": "turning.diagram",
    "topper": "topping.topper",
    "topper_field": "topping.field",
    "length_verdict": "topping.verdict",
    "sweep_field": "studies.knives",
    "best_knife": "topping.best.best_knife",
    "free_vibration": "torsion.modes.free",
    "holzer_table": "torsion.modes.holzer",
    "forced_vibration": "torsion.response.forced",
    "torsion_study": "torsion.study",
    "torsion_transient": "torsion.in_time.transient",
    "waterfall": "torsion.in_time.waterfall",
    "shaft_stress": "torsion.response.stress",
    "barred_ranges": "torsion.limits.barred_range",
    "mesh_torques": "torsion.response.mesh_torque",
    "crankshaft_fatigue": "torsion.limits.crank_fatigue",
    "read_measured": "torsion.limits.overlay",
    "engine_diagnosis": "torsion.diagnosis.engine_diagnosis",
    "measured_speed": "torsion.diagnosis.measured_speed",
    "engine_data": "torsion.excitation.engine_torques",
    "damped_vibration": "torsion.modes.damped",
    "campbell": "torsion.modes.campbell",
    "drive_line": "torsion.excitation.drive_line",
    "mechanism_harmonics": "torsion.excitation.drive_line",
    "design_damper": "torsion.damper.damper_design",
    "scheme": "torsion.modes.scheme",
    "station_damping": "torsion.excitation.drive_line",
    "quantities": "app.quantities",
    "study": "app.study",
    "steady_states": "drive.batch",
    "read_study": "studies.read",
    "sweep": "studies.sweep",
    "tolerance": "studies.tolerance",
    "allocate": "studies.allocation",
    "optimise": "studies.optimise",
    "front": "studies.front",
    "evaluate": "studies.engine",
    "fit": "studies.fit",
    "new_study": "studies.read",
    "MeasuredRecord": "studies.record",
    "read_record": "studies.record",
    "required_power": "sizing.power",
    "choose_motor": "sizing.motor",
    "choose_flywheel": "sizing.flywheel",
    "crank_rocker": "synthesis.dead_centre",
    "slider_crank": "synthesis.stroke",
    "function_generator": "synthesis.function_generator",
    "path_generator": "synthesis.path",
    "pose_guide": "synthesis.pose",
    "straight_line": "synthesis.straight_line",
    "straight_lines": "synthesis.straight_line",
    "cam_drawings": "cam.manufacture.drawing",
    "write_drawing": "cam.manufacture.write",
    "read_heading": "app.report.company",
    "write_report": "app.report.page",
    "widget": "studio.widget",
    **dict.fromkeys(
        (
            "AssemblyError",
            "CamError",
            "ConvergenceError",
            "CoreError",
            "ExchangeError",
            "FindingError",
            "FrozenError",
            "InputError",
            "InternalError",
            "LawError",
            "LinkwrightError",
            "MachineError",
            "MachineFileError",
            "ShapeError",
            "StartError",
            "SteadyStateError",
            "SynthesisError",
            "UnitError",
        ),
        "kernel.errors",
    ),
}

__all__ = ["__version__", *_HOME]


def __getattr__(name: str) -> Any:
    """Load a public name on first use."""
    if name not in _HOME:
        raise AttributeError(f"module 'linkwright' has no attribute {name!r}")
    value = getattr(import_module(f"linkwright.{_HOME[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """Public names, loaded or not."""
    return sorted(__all__)


if TYPE_CHECKING:
    from linkwright.app.quantities import quantities as quantities
    from linkwright.app.report.company import read_heading as read_heading
    from linkwright.app.report.page import write_report as write_report
    from linkwright.app.study import study as study
    from linkwright.cam.dynamics.bearing import ArmPivot as ArmPivot
    from linkwright.cam.dynamics.bearing import StemGuide as StemGuide
    from linkwright.cam.dynamics.contact_force import contact_force as contact_force
    from linkwright.cam.dynamics.follower_load import FollowerLoad as FollowerLoad
    from linkwright.cam.dynamics.follower_load import cam_course as cam_course
    from linkwright.cam.dynamics.follower_vibration import follower_vibration as follower_vibration
    from linkwright.cam.dynamics.follower_vibration import vibration_over_speed as vibration_over_speed
    from linkwright.cam.dynamics.hertz import Material as Material
    from linkwright.cam.dynamics.hertz import line_contact as line_contact
    from linkwright.cam.dynamics.lift_off import least_preload as least_preload
    from linkwright.cam.dynamics.lift_off import lift_off as lift_off
    from linkwright.cam.dynamics.loaded import loaded_cam as loaded_cam
    from linkwright.cam.dynamics.one_mass import OneMass as OneMass
    from linkwright.cam.dynamics.polydyne import polydyne as polydyne
    from linkwright.cam.dynamics.residual_vibration import residual_over_speed as residual_over_speed
    from linkwright.cam.dynamics.residual_vibration import residual_spectrum as residual_spectrum
    from linkwright.cam.law_factors import cam_laws as cam_laws
    from linkwright.cam.law_factors import law_factors as law_factors
    from linkwright.cam.manufacture.drawing import cam_drawings as cam_drawings
    from linkwright.cam.manufacture.write import write_drawing as write_drawing
    from linkwright.cam.profile.faults import cam_cautions as cam_cautions
    from linkwright.cam.profile.faults import cam_faults as cam_faults
    from linkwright.cam.profile.least_sizes import least_sizes as least_sizes
    from linkwright.cam.profile.profile import cam_profile as cam_profile
    from linkwright.cam.search import search_cams as search_cams
    from linkwright.drive.batch import steady_states as steady_states
    from linkwright.drive.cycle_motion import cycle_motion as cycle_motion
    from linkwright.drive.evenness import constant_energy as constant_energy
    from linkwright.drive.model.catalogue import motors as motors
    from linkwright.drive.model.motor_file import read_motors as read_motors
    from linkwright.drive.motion_events import motion_events as motion_events
    from linkwright.drive.motion_events import motion_extremes as motion_extremes
    from linkwright.drive.reduction import reduction as reduction
    from linkwright.drive.run_up import run_down as run_down
    from linkwright.drive.run_up import run_up as run_up
    from linkwright.drive.steady_state import steady_state as steady_state
    from linkwright.drive.step_method import step_method as step_method
    from linkwright.drive.transient import transient as transient
    from linkwright.kernel.errors import AssemblyError as AssemblyError
    from linkwright.kernel.errors import CamError as CamError
    from linkwright.kernel.errors import ConvergenceError as ConvergenceError
    from linkwright.kernel.errors import CoreError as CoreError
    from linkwright.kernel.errors import ExchangeError as ExchangeError
    from linkwright.kernel.errors import FindingError as FindingError
    from linkwright.kernel.errors import FrozenError as FrozenError
    from linkwright.kernel.errors import InputError as InputError
    from linkwright.kernel.errors import InternalError as InternalError
    from linkwright.kernel.errors import LawError as LawError
    from linkwright.kernel.errors import LinkwrightError as LinkwrightError
    from linkwright.kernel.errors import MachineError as MachineError
    from linkwright.kernel.errors import MachineFileError as MachineFileError
    from linkwright.kernel.errors import ShapeError as ShapeError
    from linkwright.kernel.errors import StartError as StartError
    from linkwright.kernel.errors import SteadyStateError as SteadyStateError
    from linkwright.kernel.errors import SynthesisError as SynthesisError
    from linkwright.kernel.errors import UnitError as UnitError
    from linkwright.kinetostatics.balancing import balance as balance
    from linkwright.kinetostatics.balancing import partial_balance as partial_balance
    from linkwright.kinetostatics.contact_in_time import contact_losses as contact_losses
    from linkwright.kinetostatics.envelope import envelope as envelope
    from linkwright.kinetostatics.envelope import harmonics as harmonics
    from linkwright.kinetostatics.envelope import load_cases as load_cases
    from linkwright.kinetostatics.forces import forces as forces
    from linkwright.kinetostatics.friction import Friction as Friction
    from linkwright.linkages.centrodes import centrodes as centrodes
    from linkwright.linkages.circuits import circuits as circuits
    from linkwright.linkages.closure import closure as closure
    from linkwright.linkages.coupler_curve import coupler_curve as coupler_curve
    from linkwright.linkages.cycle import linkage as linkage
    from linkwright.linkages.kinematics import kinematics as kinematics
    from linkwright.linkages.kinematics import motions as motions
    from linkwright.linkages.model.mobility import mobility as mobility
    from linkwright.linkages.motion import motion as motion
    from linkwright.linkages.path_error import path_error as path_error
    from linkwright.linkages.period import period_turns as period_turns
    from linkwright.linkages.pose import pose as pose
    from linkwright.linkages.zero import zero_angle as zero_angle
    from linkwright.machine.address import addresses as addresses
    from linkwright.machine.address import get as get
    from linkwright.machine.address import replace as replace
    from linkwright.machine.machine import Machine as Machine
    from linkwright.machine.read import loads as loads
    from linkwright.machine.read import read as read
    from linkwright.machine.write import write as write
    from linkwright.pumping.model.unit_catalogue import pumping_units as pumping_units
    from linkwright.pumping.rod_rotator import rod_rotator as rod_rotator
    from linkwright.pumping.unit import pumping_unit as pumping_unit
    from linkwright.sizing.flywheel import choose_flywheel as choose_flywheel
    from linkwright.sizing.motor import choose_motor as choose_motor
    from linkwright.sizing.power import required_power as required_power
    from linkwright.studies.allocation import allocate as allocate
    from linkwright.studies.engine import evaluate as evaluate
    from linkwright.studies.fit import fit as fit
    from linkwright.studies.front import front as front
    from linkwright.studies.knives import sweep_field as sweep_field
    from linkwright.studies.optimise import optimise as optimise
    from linkwright.studies.read import new_study as new_study
    from linkwright.studies.read import read_study as read_study
    from linkwright.studies.record import MeasuredRecord as MeasuredRecord
    from linkwright.studies.record import read_record as read_record
    from linkwright.studies.sweep import sweep as sweep
    from linkwright.studies.tolerance import tolerance as tolerance
    from linkwright.studio.widget import widget as widget
    from linkwright.synthesis.dead_centre import crank_rocker as crank_rocker
    from linkwright.synthesis.function_generator import function_generator as function_generator
    from linkwright.synthesis.path import path_generator as path_generator
    from linkwright.synthesis.pose import pose_guide as pose_guide
    from linkwright.synthesis.straight_line import straight_line as straight_line
    from linkwright.synthesis.straight_line import straight_lines as straight_lines
    from linkwright.synthesis.stroke import slider_crank as slider_crank
    from linkwright.topping.best.best_knife import best_knife as best_knife
    from linkwright.topping.field import topper_field as topper_field
    from linkwright.topping.topper import topper as topper
    from linkwright.topping.verdict import length_verdict as length_verdict
    from linkwright.torsion.damper.damper_design import design_damper as design_damper
    from linkwright.torsion.diagnosis.engine_diagnosis import engine_diagnosis as engine_diagnosis
    from linkwright.torsion.diagnosis.measured_speed import measured_speed as measured_speed
    from linkwright.torsion.excitation.drive_line import drive_line as drive_line
    from linkwright.torsion.excitation.drive_line import mechanism_harmonics as mechanism_harmonics
    from linkwright.torsion.excitation.drive_line import station_damping as station_damping
    from linkwright.torsion.excitation.engine_torques import engine_data as engine_data
    from linkwright.torsion.in_time.transient import torsion_transient as torsion_transient
    from linkwright.torsion.in_time.waterfall import waterfall as waterfall
    from linkwright.torsion.limits.barred_range import barred_ranges as barred_ranges
    from linkwright.torsion.limits.crank_fatigue import crankshaft_fatigue as crankshaft_fatigue
    from linkwright.torsion.limits.overlay import read_measured as read_measured
    from linkwright.torsion.modes.campbell import campbell as campbell
    from linkwright.torsion.modes.damped import damped_vibration as damped_vibration
    from linkwright.torsion.modes.free import free_vibration as free_vibration
    from linkwright.torsion.modes.holzer import holzer_table as holzer_table
    from linkwright.torsion.modes.scheme import scheme as scheme
    from linkwright.torsion.response.forced import forced_vibration as forced_vibration
    from linkwright.torsion.response.mesh_torque import mesh_torques as mesh_torques
    from linkwright.torsion.response.stress import shaft_stress as shaft_stress
    from linkwright.torsion.study import torsion_study as torsion_study
    from linkwright.turning.diagram import turning_moment as turning_moment
