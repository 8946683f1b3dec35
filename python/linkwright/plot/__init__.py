"""Figures of results: functions that take results and return a matplotlib `Figure`; they compute nothing.

| module | draws |
| --- | --- |
| `reduction` | reduced inertia and torque over a turn |
| `steady` | speed, acceleration, torque and power over a turn and over time |
| `motor` | the motor's characteristic, and the part of it that steady motion uses |
| `run_up` | speed from the start to steady motion |
| `pumping_unit` | polished rod, torque of the gearbox, lever of a rotator |
| `cam` | lift diagrams, profile, pressure angle, curvature, contact force |
| `linkage` | transmission angles, coupler curves with the links |
| `forces` | driving torque, reactions, hodographs, load cases |
| `motion_laws` | motion laws and their derivatives, several in one picture |
| `cam_dynamics` | contact force, pressure and vibration of cams and followers |
| `torsion` | mode shapes of trains |
| `campbell` | Campbell's diagram of a train |
| `damper` | response of a train with the best damper |
| `torsion_forced` | forced vibration of trains over their speeds |
| `torsion_transient` | manoeuvres of trains over time, waterfalls |
| `torsion_scheme` | equivalent schemes of trains, by `scheme_layout`, `scheme_page`, `scheme_words` |
| `topper`, `topper_view` | knives of toppers over the phase, and from above |
| `topper_lengths` | lengths of their edges, and for which heads published ones do |
| `topper_field`, `topper_sweep` | fields of roots under a topper; its knife varied, the best one |
| `compare` | steady motion of several machines in one picture |
| `style` | colours, fonts, axes |
| `svg` | a figure as SVG text, or as PNG |

matplotlib is imported when the first figure is drawn.
"""

from linkwright.plot.cam import (
    cam_figure,
    cam_force_figure,
    curvature_figure,
    lift_figure,
    pressure_angle_figure,
)
from linkwright.plot.cam_dynamics import (
    contact_force_figure,
    pressure_figure,
    residual_figure,
    vibration_figure,
)
from linkwright.plot.campbell import campbell_figure
from linkwright.plot.compare import compare_figure
from linkwright.plot.damper import damper_figure
from linkwright.plot.forces import cases_figure, forces_figure, hodograph_figure, polar_figure
from linkwright.plot.linkage import coupler_figure, transmission_figure
from linkwright.plot.motion_laws import motion_laws_figure
from linkwright.plot.motor import motor_figure
from linkwright.plot.pumping_unit import gear_torque_figure, polished_rod_figure, rotator_figure
from linkwright.plot.reduction import reduction_figure
from linkwright.plot.run_up import attempt_figure, run_up_figure
from linkwright.plot.steady import speed_figure, time_figure, torque_figure
from linkwright.plot.svg import png, svg
from linkwright.plot.topper import edge_use_figure, phase_figure, slicing_figure
from linkwright.plot.topper_field import field_haulm_figure, field_length_figure, field_share_figure
from linkwright.plot.topper_lengths import length_chart_figure, verdict_figure
from linkwright.plot.topper_sweep import best_knife_figure, sweep_figures
from linkwright.plot.topper_view import top_view_figure
from linkwright.plot.torsion import modes_figure
from linkwright.plot.torsion_forced import (
    heat_figure,
    orders_figure,
    shaft_torques_figure,
    stress_figure,
    torsion_unevenness_figure,
)
from linkwright.plot.torsion_scheme import scheme_figure
from linkwright.plot.torsion_transient import transient_figure, waterfall_figure

__all__ = [
    "attempt_figure",
    "best_knife_figure",
    "cam_figure",
    "cam_force_figure",
    "campbell_figure",
    "cases_figure",
    "compare_figure",
    "contact_force_figure",
    "coupler_figure",
    "curvature_figure",
    "damper_figure",
    "edge_use_figure",
    "field_haulm_figure",
    "field_length_figure",
    "field_share_figure",
    "forces_figure",
    "gear_torque_figure",
    "heat_figure",
    "hodograph_figure",
    "length_chart_figure",
    "lift_figure",
    "modes_figure",
    "motion_laws_figure",
    "motor_figure",
    "orders_figure",
    "phase_figure",
    "png",
    "polar_figure",
    "polished_rod_figure",
    "pressure_angle_figure",
    "pressure_figure",
    "reduction_figure",
    "residual_figure",
    "rotator_figure",
    "run_up_figure",
    "scheme_figure",
    "shaft_torques_figure",
    "slicing_figure",
    "speed_figure",
    "stress_figure",
    "svg",
    "sweep_figures",
    "time_figure",
    "top_view_figure",
    "torque_figure",
    "torsion_unevenness_figure",
    "transient_figure",
    "transmission_figure",
    "verdict_figure",
    "vibration_figure",
    "waterfall_figure",
]
