"""Words, symbols and units of the results' attributes, and numbers as text."""

from __future__ import annotations

import math
from typing import NamedTuple


class Shown(NamedTuple):
    """How an attribute of a result is shown; an index of the symbol stands after ``_``."""

    word: str
    symbol: str
    unit: str


_RPS, _RPS2, _NM, _KGM2, _J, _W, _S, _RAD = "rad/s", "rad/s²", "N m", "kg m²", "J", "W", "s", "rad"
_M, _N = "m", "N"

SHOWN = {
    "crank_angle": Shown("crank angle", "φ", _RAD),
    "time": Shown("time", "t", _S),
    "crank_time": Shown("time", "t", _S),
    "turns": Shown("turns of the crank", "n", ""),
    "crank_jerk": Shown("jerk of the crank", "dε/dt", "rad/s³"),
    "inertia_reduced": Shown("reduced inertia", "J", _KGM2),
    "inertia_reduced_d1": Shown("derivative of the reduced inertia", "J′", "kg m²/rad"),
    "inertia_min": Shown("least reduced inertia", "J_min", _KGM2),
    "inertia_max": Shown("greatest reduced inertia", "J_max", _KGM2),
    "torque_load": Shown("resisting torque at the crank", "M_r", _NM),
    "torque_dry": Shown("share of dry friction", "M_dry", _NM),
    "torque_load_mean": Shown("mean resisting torque", "M_r,mean", _NM),
    "torque_load_max": Shown("greatest resisting torque", "M_r,max", _NM),
    "viscous": Shown("viscous coefficient at the crank", "c", "N m s/rad"),
    "viscous_mean": Shown("mean viscous coefficient at the crank", "c_mean", "N m s/rad"),
    "speed": Shown("speed of the crank", "ω", _RPS),
    "acceleration": Shown("acceleration of the crank", "ε", _RPS2),
    "speed_min": Shown("least speed", "ω_min", _RPS),
    "speed_max": Shown("greatest speed", "ω_max", _RPS),
    "acceleration_min": Shown("least acceleration", "ε_min", _RPS2),
    "acceleration_max": Shown("greatest acceleration", "ε_max", _RPS2),
    "period": Shown("period of a turn", "T", _S),
    "multiplier": Shown("rest of a disturbance after a turn", "μ", ""),
    "accuracy": Shown("accuracy reached", "", ""),
    "steps": Shown("steps of the finest mesh", "", ""),
    "sweeps": Shown("Newton sweeps", "", ""),
    "torque_motor": Shown("torque of the motor", "M", _NM),
    "torque_drive": Shown("driving torque at the crank", "M_d", _NM),
    "power_motor": Shown("power of the motor", "P", _W),
    "power_drive": Shown("driving power at the crank", "P_d", _W),
    "power_load": Shown("power of the loads", "P_r", _W),
    "power_friction": Shown("power of friction in the pairs", "P_f", _W),
    "power_kinetic": Shown("change of the kinetic energy in time", "dE/dt", _W),
    "power_residual": Shown("rest of the balance of powers", "", _W),
    "shaking_force": Shown("force on the frame", "F_g", "N"),
    "shaking_moment": Shown("moment on the frame about the origin", "M_g", _NM),
    "shaking_force_max": Shown("greatest force on the frame", "F_g,max", "N"),
    "torque_drive_max": Shown("driving torque of the greatest size", "M_d,max", _NM),
    "energy_motor": Shown("work of the motor in a turn", "A_m", _J),
    "energy_drive": Shown("work at the crank in a turn", "A_d", _J),
    "energy_load": Shown("work taken by the loads in a turn", "A_r", _J),
    "efficiency": Shown("efficiency of the drive over a turn", "η", ""),
    "power_motor_mean": Shown("mean power of the motor", "P_mean", _W),
    "power_motor_max": Shown("greatest power of the motor", "P_max", _W),
    "torque_motor_mean": Shown("mean torque of the motor", "M_mean", _NM),
    "torque_motor_rms": Shown("root mean square torque of the motor", "M_rms", _NM),
    "torque_motor_min": Shown("least torque of the motor", "M_min", _NM),
    "torque_motor_max": Shown("greatest torque of the motor", "M_max", _NM),
    "speed_peak": Shown("greatest speed on the way", "ω_peak", _RPS),
    "angle_end": Shown("crank angle at rest", "φ_end", _RAD),
    "step": Shown("step of the crank angle", "Δφ", _RAD),
    "stroke": Shown("stroke of the polished rod", "S", _M),
    "stroke_nominal": Shown("stroke by the designation", "S_n", _M),
    "rod_position": Shown("position of rods", "PR", ""),
    "rod_travel": Shown("rise of the polished rod", "s", _M),
    "torque_factor": Shown("torque factor", "TF", _M),
    "torque_factor_d1": Shown("derivative of the torque factor", "TF′", "m/rad²"),
    "torque_factor_max": Shown("greatest torque factor, upstroke", "max TF", _M),
    "torque_factor_min": Shown("least torque factor, downstroke", "min TF", _M),
    "bottom_angle": Shown("bottom of the stroke", "θ_b", _RAD),
    "top_angle": Shown("top of the stroke", "θ_t", _RAD),
    "upstroke_angle": Shown("angle of the upstroke", "θ_u", _RAD),
    "stroke_ratio": Shown("angle of the upstroke over the downstroke", "", ""),
    "rod_velocity": Shown("velocity of the polished rod", "v", "m/s"),
    "rod_acceleration": Shown("acceleration of the polished rod", "a", "m/s²"),
    "rod_velocity_max": Shown("greatest velocity, upward", "v_max", "m/s"),
    "rod_velocity_min": Shown("greatest velocity, downward", "v_min", "m/s"),
    "rod_acceleration_max": Shown("greatest acceleration, upward", "a_max", "m/s²"),
    "rod_acceleration_min": Shown("greatest acceleration, downward", "a_min", "m/s²"),
    "rod_load": Shown("load of the polished rod", "W", _N),
    "torque_rod": Shown("torque by the polished rod", "M_W", _NM),
    "torque_counterbalance": Shown("torque by the counterbalance", "M_C", _NM),
    "torque_net": Shown("torque of the gearbox", "M_G", _NM),
    "counterbalance": Shown("greatest moment of the counterweights", "M", _NM),
    "counterbalance_effect": Shown("counterbalance effect of the cylinder", "E", _N),
    "torque_net_up": Shown("greatest torque of the gearbox, upstroke", "M_G,up", _NM),
    "torque_net_down": Shown("greatest torque of the gearbox, downstroke", "M_G,down", _NM),
    "torque_net_min": Shown("least torque of the gearbox", "M_G,min", _NM),
    "torque_net_mean": Shown("mean torque of the gearbox", "M_G,mean", _NM),
    "torque_net_rms": Shown("root mean square torque of the gearbox", "M_G,rms", _NM),
    "cyclic_load_factor": Shown("cyclic load factor", "CLF", ""),
    "gear_load": Shown("greatest torque over the rating", "", ""),
    "load_max": Shown("greatest load of the polished rod", "W_max", _N),
    "work": Shown("work of the polished rod in a stroke", "A", _J),
    "link_angle": Shown("angle of the link", "φ_4", _RAD),
    "lever_angle": Shown("angle of the lever", "φ_5", _RAD),
    "link_transfer": Shown("transfer function of the link", "φ_4′", ""),
    "lever_transfer": Shown("transfer function of the lever", "φ_5′", ""),
    "link_transfer_d1": Shown("second transfer function of the link", "φ_4″", ""),
    "lever_transfer_d1": Shown("second transfer function of the lever", "φ_5″", ""),
    "diagonal": Shown("distance from pin to hanger", "l_d", _M),
    "link_arm": Shown("arm of the link about the hanger", "", _M),
    "link_length": Shown("length of the link", "l_4", _M),
    "lever_length": Shown("length of the lever", "l_5", _M),
    "lever_turns_per_cycle": Shown("turns of the lever in a turn of the crank", "", ""),
    "lever_swing": Shown("range of the lever's angle", "", _RAD),
    "transfer_min": Shown("least transfer function of the lever", "min φ_5′", ""),
    "transfer_max": Shown("greatest transfer function of the lever", "max φ_5′", ""),
    "lever_speed": Shown("speed of the lever", "ω_5", _RPS),
    "lever_acceleration": Shown("acceleration of the lever", "ε_5", _RPS2),
    "string_speed": Shown("speed of the rod string", "ω_s", _RPS),
    "string_acceleration": Shown("acceleration of the rod string", "ε_s", _RPS2),
    "string_turn_days": Shown("days for a turn of the rod string", "", ""),
    "worm_turns_per_cycle": Shown("turns of the worm in a turn of the crank", "", ""),
    "worm_torque": Shown("torque at the worm", "M_w", _NM),
    "link_force": Shown("force in the link", "F_4", _N),
    "link_force_max": Shown("greatest force in the link", "F_4,max", _N),
    "phase": Shown("phase of the knife", "φ", _RAD),
    "length_by_phase": Shown("length that heads need in a phase", "L", _M),
    "uncut_by_phase": Shown("share of the head that is left in a phase", "", ""),
    "edge_place": Shown("place along the edge from its middle", "", _M),
    "edge_use": Shown("mean way through a head", "", _M),
    "frequency": Shown("strokes to and fro in a second", "f", "1/s"),
    "knife_speed": Shown("mean speed across the row", "v_h", "m/s"),
    "knife_speed_max": Shown("greatest speed across the row", "ẏ_max", "m/s"),
    "knife_acceleration_max": Shown("greatest acceleration of the knife", "ÿ_max", "m/s²"),
    "strokes_per_head": Shown("strokes over a head", "", ""),
    "travel_along": Shown("travel along the row", "S_x", _M),
    "travel_across": Shown("travel across the row", "S_y", _M),
    "time_along": Shown("time of the travel along the row", "t_x", _S),
    "time_across": Shown("time of the travel across the row", "t_y", _S),
    "slicing_ratio_min": Shown("least draw-cut ratio", "", ""),
    "slicing_ratio_mean": Shown("mean draw-cut ratio", "", ""),
    "slicing_ratio_max": Shown("greatest draw-cut ratio", "", ""),
    "cutting_speed_min": Shown("least cutting speed", "", "m/s"),
    "cutting_speed_max": Shown("greatest cutting speed", "", "m/s"),
    "least_advance": Shown("least advance normal to the edge", "u_n,min", "m/s"),
    "knife_mass": Shown("mass of the knife", "m", "kg"),
    "inertia_force_max": Shown("greatest inertia force of the knife", "m ÿ_max", _N),
    "drive_torque_max": Shown("greatest driving torque", "M_max", _NM),
    "drive_torque_min": Shown("least driving torque", "M_min", _NM),
    "drive_torque_mean": Shown("mean driving torque", "M_mean", _NM),
    "drive_power_mean": Shown("mean power", "P_mean", _W),
    "unevenness": Shown("coefficient of unevenness", "δ", ""),
    "dynamism": Shown("coefficient of dynamism", "H", ""),
    "motion_coefficient": Shown("generalised coefficient of motion", "k_p", ""),
}


def number(value: float | None, digits: int = 5) -> str:
    """A number as text.

    Parameters
    ----------
    value : float or None
        The number; None is a dash.
    digits : int
        Significant digits.

    Returns
    -------
    str
        With a true minus sign, and a power of ten where it is very large or very small.

    Examples
    --------
    >>> number(0.08495914)
    '0.084959'
    >>> number(-1.4051e-08, 3)
    '−1.41·10⁻⁸'
    """
    if value is None or not math.isfinite(value):
        return "–"
    text = f"{value:.{digits}g}"
    if "e" in text and 1 <= abs(value) < _LARGE:
        text = f"{float(text):.0f}"
    if "e" in text:
        head, power = text.split("e")
        text = f"{head}·10{str(int(power)).translate(_RAISED)}"
    return text.replace("-", "−")


# Below this, a number with more places than digits is written out: 20240 W, not 2.024·10⁴ W.
_LARGE = 1e7

_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


# An angle at which links are in line follows from a root: below that of the rounding unit it is zero [rad].
_ROUNDING = 2e-8


def degrees(angle: float) -> str:
    """An angle in radians as text in degrees; what is left of zero by rounding is zero."""
    shown = 0.0 if abs(angle) < _ROUNDING else math.degrees(angle)
    return f"{shown:.5g}°".replace("-", "−")


def pretty_unit(unit: str) -> str:
    """A unit as it is printed: ``kg m^2`` becomes ``kg m²``."""
    return unit.replace("^2", "²").replace("^3", "³")
