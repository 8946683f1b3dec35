"""Linkwright: how machines move, from the motor through gearbox and shaft to the mechanism and its work.

>>> import linkwright as lw
>>> machine = lw.read("machines/roller_two_carts.toml")
>>> motion = lw.steady_state(machine)
>>> round(motion.unevenness, 4)
0.085

Public names are loaded when they are first used, so that importing the package costs little.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

# Public name → module that holds it.
_HOME = {
    "Machine": "machine",
    "addresses": "machine",
    "get": "machine",
    "motors": "machine",
    "pumping_units": "machine",
    "replace": "machine",
    "read": "files",
    "loads": "files",
    "write": "files",
    "closure": "analysis.closure",
    "kinematics": "analysis.kinematics",
    "motions": "analysis.kinematics",
    "linkage": "analysis.linkage",
    "circuits": "analysis.circuits",
    "coupler_curve": "analysis.coupler_curve",
    "period_turns": "analysis.period",
    "pose": "analysis.pose",
    "motion": "analysis.motion",
    "reduction": "analysis.reduction",
    "constant_energy": "analysis.constant_energy",
    "steady_state": "analysis.steady_state",
    "transient": "analysis.transient",
    "run_up": "analysis.run_up",
    "run_down": "analysis.run_down",
    "step_method": "analysis.step_method",
    "forces": "analysis.forces",
    "Friction": "analysis.kinetostatics.friction",
    "envelope": "analysis.envelope",
    "load_cases": "analysis.envelope",
    "balance": "analysis.balancing",
    "partial_balance": "analysis.counterweight_formulas",
    "harmonics": "analysis.harmonics",
    "mobility": "machine.mobility",
    "cam_laws": "analysis.law_factors",
    "law_factors": "analysis.law_factors",
    "cam_profile": "analysis.cam.profile",
    "cam_faults": "analysis.cam.faults",
    "cam_cautions": "analysis.cam.faults",
    "least_sizes": "analysis.cam.least_sizes",
    "loaded_cam": "analysis.cam.loaded",
    "search_cams": "sweep.cams",
    "OneMass": "analysis.cam.one_mass",
    "follower_vibration": "analysis.cam.follower_vibration",
    "vibration_over_speed": "analysis.cam.follower_vibration",
    "residual_spectrum": "analysis.cam.residual_vibration",
    "residual_over_speed": "analysis.cam.residual_vibration",
    "polydyne": "analysis.cam.polydyne",
    "cam_course": "analysis.cam.follower_load",
    "FollowerLoad": "analysis.cam.follower_load",
    "StemGuide": "analysis.cam.bearing",
    "ArmPivot": "analysis.cam.bearing",
    "contact_force": "analysis.cam.contact_force",
    "lift_off": "analysis.cam.lift_off",
    "least_preload": "analysis.cam.lift_off",
    "Material": "analysis.cam.hertz",
    "line_contact": "analysis.cam.hertz",
    "pumping_unit": "analysis.pumping_unit",
    "rod_rotator": "analysis.rod_rotator",
    "topper": "analysis.topper.topper",
    "topper_field": "analysis.topper.field",
    "length_verdict": "analysis.topper.verdict",
    "sweep_field": "sweep.topper",
    "best_knife": "sizing.topper",
    "free_vibration": "analysis.torsion.free",
    "holzer_table": "analysis.torsion.holzer",
    "forced_vibration": "analysis.torsion.forced",
    "torsion_study": "analysis.torsion.study",
    "torsion_transient": "analysis.torsion.transient",
    "waterfall": "analysis.torsion.waterfall",
    "shaft_stress": "analysis.torsion.stress",
    "barred_ranges": "analysis.torsion.barred_range",
    "mesh_torques": "analysis.torsion.mesh_torque",
    "engine_diagnosis": "analysis.torsion.engine_diagnosis",
    "measured_speed": "analysis.torsion.measured_speed",
    "engine_data": "analysis.torsion.engine_data",
    "damped_vibration": "analysis.torsion.damped",
    "campbell": "analysis.torsion.campbell",
    "drive_line": "analysis.torsion.drive_line",
    "mechanism_harmonics": "analysis.torsion.drive_line",
    "design_damper": "analysis.torsion.damper_design",
    "scheme": "analysis.torsion.scheme",
    "station_damping": "analysis.torsion.drive_line",
    "study": "analysis.study",
    "steady_states": "sweep.batch",
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
    "cam_drawings": "exchange.cam",
    "write_drawing": "exchange.write",
    "write_report": "report",
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
    from linkwright.analysis.balancing import balance as balance
    from linkwright.analysis.cam.bearing import ArmPivot as ArmPivot
    from linkwright.analysis.cam.bearing import StemGuide as StemGuide
    from linkwright.analysis.cam.contact_force import contact_force as contact_force
    from linkwright.analysis.cam.faults import cam_cautions as cam_cautions
    from linkwright.analysis.cam.faults import cam_faults as cam_faults
    from linkwright.analysis.cam.follower_load import FollowerLoad as FollowerLoad
    from linkwright.analysis.cam.follower_load import cam_course as cam_course
    from linkwright.analysis.cam.follower_vibration import follower_vibration as follower_vibration
    from linkwright.analysis.cam.follower_vibration import vibration_over_speed as vibration_over_speed
    from linkwright.analysis.cam.hertz import Material as Material
    from linkwright.analysis.cam.hertz import line_contact as line_contact
    from linkwright.analysis.cam.least_sizes import least_sizes as least_sizes
    from linkwright.analysis.cam.lift_off import least_preload as least_preload
    from linkwright.analysis.cam.lift_off import lift_off as lift_off
    from linkwright.analysis.cam.loaded import loaded_cam as loaded_cam
    from linkwright.analysis.cam.one_mass import OneMass as OneMass
    from linkwright.analysis.cam.polydyne import polydyne as polydyne
    from linkwright.analysis.cam.profile import cam_profile as cam_profile
    from linkwright.analysis.cam.residual_vibration import residual_over_speed as residual_over_speed
    from linkwright.analysis.cam.residual_vibration import residual_spectrum as residual_spectrum
    from linkwright.analysis.circuits import circuits as circuits
    from linkwright.analysis.closure import closure as closure
    from linkwright.analysis.constant_energy import constant_energy as constant_energy
    from linkwright.analysis.counterweight_formulas import partial_balance as partial_balance
    from linkwright.analysis.coupler_curve import coupler_curve as coupler_curve
    from linkwright.analysis.envelope import envelope as envelope
    from linkwright.analysis.envelope import load_cases as load_cases
    from linkwright.analysis.forces import forces as forces
    from linkwright.analysis.harmonics import harmonics as harmonics
    from linkwright.analysis.kinematics import kinematics as kinematics
    from linkwright.analysis.kinematics import motions as motions
    from linkwright.analysis.kinetostatics.friction import Friction as Friction
    from linkwright.analysis.law_factors import cam_laws as cam_laws
    from linkwright.analysis.law_factors import law_factors as law_factors
    from linkwright.analysis.linkage import linkage as linkage
    from linkwright.analysis.motion import motion as motion
    from linkwright.analysis.period import period_turns as period_turns
    from linkwright.analysis.pose import pose as pose
    from linkwright.analysis.pumping_unit import pumping_unit as pumping_unit
    from linkwright.analysis.reduction import reduction as reduction
    from linkwright.analysis.rod_rotator import rod_rotator as rod_rotator
    from linkwright.analysis.run_down import run_down as run_down
    from linkwright.analysis.run_up import run_up as run_up
    from linkwright.analysis.steady_state import steady_state as steady_state
    from linkwright.analysis.step_method import step_method as step_method
    from linkwright.analysis.study import study as study
    from linkwright.analysis.topper.field import topper_field as topper_field
    from linkwright.analysis.topper.topper import topper as topper
    from linkwright.analysis.topper.verdict import length_verdict as length_verdict
    from linkwright.analysis.torsion.barred_range import barred_ranges as barred_ranges
    from linkwright.analysis.torsion.campbell import campbell as campbell
    from linkwright.analysis.torsion.damped import damped_vibration as damped_vibration
    from linkwright.analysis.torsion.damper_design import design_damper as design_damper
    from linkwright.analysis.torsion.drive_line import drive_line as drive_line
    from linkwright.analysis.torsion.drive_line import mechanism_harmonics as mechanism_harmonics
    from linkwright.analysis.torsion.drive_line import station_damping as station_damping
    from linkwright.analysis.torsion.engine_data import engine_data as engine_data
    from linkwright.analysis.torsion.engine_diagnosis import engine_diagnosis as engine_diagnosis
    from linkwright.analysis.torsion.forced import forced_vibration as forced_vibration
    from linkwright.analysis.torsion.free import free_vibration as free_vibration
    from linkwright.analysis.torsion.holzer import holzer_table as holzer_table
    from linkwright.analysis.torsion.measured_speed import measured_speed as measured_speed
    from linkwright.analysis.torsion.mesh_torque import mesh_torques as mesh_torques
    from linkwright.analysis.torsion.scheme import scheme as scheme
    from linkwright.analysis.torsion.stress import shaft_stress as shaft_stress
    from linkwright.analysis.torsion.study import torsion_study as torsion_study
    from linkwright.analysis.torsion.transient import torsion_transient as torsion_transient
    from linkwright.analysis.torsion.waterfall import waterfall as waterfall
    from linkwright.analysis.transient import transient as transient
    from linkwright.exchange.cam import cam_drawings as cam_drawings
    from linkwright.exchange.write import write_drawing as write_drawing
    from linkwright.files import loads as loads
    from linkwright.files import read as read
    from linkwright.files import write as write
    from linkwright.machine import Machine as Machine
    from linkwright.machine import addresses as addresses
    from linkwright.machine import get as get
    from linkwright.machine import motors as motors
    from linkwright.machine import pumping_units as pumping_units
    from linkwright.machine import replace as replace
    from linkwright.machine.mobility import mobility as mobility
    from linkwright.report import write_report as write_report
    from linkwright.sizing.flywheel import choose_flywheel as choose_flywheel
    from linkwright.sizing.motor import choose_motor as choose_motor
    from linkwright.sizing.power import required_power as required_power
    from linkwright.sizing.topper import best_knife as best_knife
    from linkwright.sweep.batch import steady_states as steady_states
    from linkwright.sweep.cams import search_cams as search_cams
    from linkwright.sweep.topper import sweep_field as sweep_field
    from linkwright.synthesis.dead_centre import crank_rocker as crank_rocker
    from linkwright.synthesis.function_generator import function_generator as function_generator
    from linkwright.synthesis.path import path_generator as path_generator
    from linkwright.synthesis.pose import pose_guide as pose_guide
    from linkwright.synthesis.straight_line import straight_line as straight_line
    from linkwright.synthesis.straight_line import straight_lines as straight_lines
    from linkwright.synthesis.stroke import slider_crank as slider_crank
