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

SHOWN = {
    "crank_angle": Shown("crank angle", "φ", _RAD),
    "time": Shown("time", "t", _S),
    "crank_time": Shown("time", "t", _S),
    "turns": Shown("turns of the crank", "n", ""),
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


def degrees(angle: float) -> str:
    """An angle in radians as text in degrees."""
    return f"{math.degrees(angle):.5g}°".replace("-", "−")


def pretty_unit(unit: str) -> str:
    """A unit as it is printed: ``kg m^2`` becomes ``kg m²``."""
    return unit.replace("^2", "²").replace("^3", "³")
