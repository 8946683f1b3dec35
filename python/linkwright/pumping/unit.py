r"""Beam pumping units: motion of the polished rod, torque factors, counterbalance and torque of the gearbox.

With S the rise of the polished rod and θ the crank angle of API Spec 11E, the torque factor is
:math:`\mathrm{TF} = dS/d\theta`, positive on the upstroke, where the load resists. API gives the same number
as :math:`\frac{RA}{C}\frac{\sin\alpha}{\sin\beta}`; here it is the exact first transfer function of the
mechanism.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError
from linkwright.kernel.numerics.turn_fit import turn_curve
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.linkages.closure import require_full_turn, turn_angles
from linkwright.linkages.kinematics import motion_arrays
from linkwright.linkages.model.mechanism import Mechanism
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine, compile_machine
from linkwright.pumping.gear_torque import GearTorque, gear_torque
from linkwright.pumping.model.unit import BEAM_LINK, PumpingUnit

# API tabulates torque factors and positions of rods at every 15°.
_TABLE = 24


_CRANK_ANGLE = "0 to 2π, by API: from 12 o'clock (class III: 6 o'clock) in the direction of rotation."


@dataclass(frozen=True)
class PumpingUnitMotion(Result):
    """Motion of the polished rod over one revolution of the crank."""

    crank_angle: Annotated[Floats, Label("crank angle", "φ", "rad", _CRANK_ANGLE)]
    rod_position: Annotated[
        Floats, Label("position of rods", "PR", "", "Rise of the polished rod over the stroke.")
    ]
    rod_travel: Annotated[
        Floats, Label("rise of the polished rod", "s", "m", "Above the bottom of the stroke.")
    ]
    torque_factor: Annotated[Floats, Label("torque factor", "TF", "m", "dS/dθ, positive on the upstroke.")]
    torque_factor_d1: Annotated[Floats, Label("derivative of the torque factor", "TF′", "m/rad²")]
    stroke: Annotated[float, Label("stroke of the polished rod", "S", "m", "Exact.", table="pumping_unit")]
    stroke_nominal: Annotated[
        float | None, Label("stroke by the designation", "S_n", "m", table="pumping_unit")
    ]
    torque_factor_max: Annotated[
        float, Label("maximum torque factor, upstroke", "max TF", "m", table="pumping_unit")
    ]
    torque_factor_min: Annotated[
        float, Label("minimum torque factor, downstroke", "min TF", "m", table="pumping_unit")
    ]
    torque_factor_max_angle: Annotated[float, Label("crank angle of the maximum torque factor", "", "rad")]
    torque_factor_min_angle: Annotated[float, Label("crank angle of the minimum torque factor", "", "rad")]
    bottom_angle: Annotated[
        float,
        Label(
            "bottom of the stroke",
            "θ_b",
            "rad",
            "Crank angle where crank and pitman are in line.",
            table="pumping_unit",
            before="torque_factor_max",
        ),
    ]
    top_angle: Annotated[
        float,
        Label(
            "top of the stroke",
            "θ_t",
            "rad",
            "Crank angle where crank and pitman are in line.",
            table="pumping_unit",
            before="torque_factor_max",
        ),
    ]
    upstroke_angle: Annotated[float, Label("angle of the upstroke", "θ_u", "rad", "That the crank turns.")]
    stroke_ratio: Annotated[
        float,
        Label(
            "angle of the upstroke over the downstroke",
            "",
            "",
            table="pumping_unit",
            before="torque_factor_max",
        ),
    ]
    torque_factors: Annotated[tuple[float, ...], About("`torque_factor` [m] at 0°, 15°, …, 345°.")]
    rod_positions: Annotated[tuple[float, ...], About("`rod_position` [–] at the same angles.")]
    speed: Annotated[float | None, Label("design speed of the crank", "ω", "rad/s")]
    rod_velocity: Annotated[
        Floats | None, Label("velocity of the polished rod", "v", "m/s", "Upward, at that speed.")
    ]
    rod_acceleration: Annotated[
        Floats | None, Label("acceleration of the polished rod", "a", "m/s²", "Upward, at that speed.")
    ]
    rod_velocity_max: Annotated[
        float | None, Label("maximum velocity, upward", "v_max", "m/s", table="pumping_unit")
    ]
    rod_velocity_min: Annotated[
        float | None, Label("maximum velocity, downward", "v_min", "m/s", table="pumping_unit")
    ]
    rod_acceleration_max: Annotated[
        float | None, Label("maximum acceleration, upward", "a_max", "m/s²", table="pumping_unit")
    ]
    rod_acceleration_min: Annotated[
        float | None, Label("maximum acceleration, downward", "a_min", "m/s²", table="pumping_unit")
    ]
    gear: Annotated[GearTorque | None, About("Torque of the gearbox, where a load is given.")]


@public
def pumping_unit(machine: Machine, *, n: int = 360) -> PumpingUnitMotion:
    """Motion of the polished rod of a pumping unit, and the torque of its gearbox.

    Parameters
    ----------
    machine : Machine
        A machine with a pumping unit.
    n : int
        Intervals of the revolution for the curves; the other numbers do not depend on it.

    Returns
    -------
    PumpingUnitMotion
        Curves over the revolution, tables at every 15°, extremes.

    Raises
    ------
    InputError
        The machine has no pumping unit.
    AssemblyError
        The crank cannot rotate fully.

    Notes
    -----
    Velocity and acceleration are those at constant speed of the crank, ``drive.speed``.

    References
    ----------
    .. [1] API Spec 11E, 17th ed. 1994, annexes on torque factors.
    .. [2] Takács, Sucker-Rod Pumping Handbook, 2015, 3.7.
    """
    unit = machine.pumping_unit
    if unit is None:
        raise InputError(f"{machine.name} has no [pumping_unit]: expected the description of one")
    rod = PolishedRod.of(machine, unit)
    phi = turn_angles(n)
    travel, factor, factor_d1 = rod.motion(phi)
    table = np.linspace(0.0, 2 * np.pi, _TABLE, endpoint=False)
    at_table = rod.motion(table)
    speed = machine.drive.speed if machine.drive else None
    high, high_at = turn_extreme(lambda at: rod.motion(at)[1], +1)
    low, low_at = turn_extreme(lambda at: rod.motion(at)[1], -1)
    up, ends = (rod.top - rod.bottom) % (2 * np.pi), (rod.bottom, rod.top)
    return PumpingUnitMotion(
        crank_angle=phi,
        rod_position=travel / rod.stroke,
        rod_travel=travel,
        torque_factor=factor,
        torque_factor_d1=factor_d1,
        stroke=rod.stroke,
        stroke_nominal=unit.rating.stroke if unit.rating else None,
        torque_factor_max=high,
        torque_factor_min=low,
        torque_factor_max_angle=high_at,
        torque_factor_min_angle=low_at,
        bottom_angle=rod.bottom,
        top_angle=rod.top,
        upstroke_angle=up,
        stroke_ratio=up / (2 * np.pi - up),
        torque_factors=tuple(at_table[1].tolist()),
        rod_positions=tuple((at_table[0] / rod.stroke).tolist()),
        speed=speed,
        rod_velocity=None if speed is None else factor * speed,
        rod_acceleration=None if speed is None else factor_d1 * speed**2,
        rod_velocity_max=None if speed is None else high * speed,
        rod_velocity_min=None if speed is None else low * speed,
        rod_acceleration_max=_acceleration(rod, speed, +1),
        rod_acceleration_min=_acceleration(rod, speed, -1),
        gear=gear_torque(unit, rod.motion, ends, phi) if unit.load and unit.load.is_given else None,
    )


def _acceleration(rod: PolishedRod, speed: float | None, sign: int) -> float | None:
    if speed is None:
        return None
    return turn_extreme(lambda at: rod.motion(at)[2], sign)[0] * speed**2


@dataclass(frozen=True)
class PolishedRod:
    """The polished rod of a unit as a function of the crank angle."""

    machine: Machine  # the unit alone
    compiled: CompiledMachine
    unit: PumpingUnit
    stroke: float  # [m]
    # bottom, top: crank angles at the ends of the stroke, 0 to 2π [rad].
    bottom: float
    top: float

    @classmethod
    def of(cls, machine: Machine, unit: PumpingUnit) -> PolishedRod:
        """The polished rod of a machine's unit, whatever else the machine holds."""
        alone = machine.with_entries(
            {"mechanism": Mechanism(), "rod_rotator": None, "bodies": {}, "loads": {}, "drive": None}
        )
        compiled = compile_machine(alone)
        require_full_turn(compiled, alone)
        return cls(alone, compiled, unit, float(unit.stroke), *map(float, end_angles(unit)))

    def beam(self, angles: Floats) -> Any:
        """Cosine and sine of the beam's angle and the derivatives of it at crank angles, (4, n)."""
        return motion_arrays(self.compiled, angles, [("links", BEAM_LINK)])[0]

    def motion(self, angles: Floats) -> Floats:
        """Rise above the bottom and its derivatives by the crank angle at crank angles, (3, n) [m]."""
        cosine, sine, d1, d2 = self.beam(angles)
        # Up is counter-clockwise for a beam that points to the right.
        sign = -1.0 if self.unit.is_mirrored else 1.0
        low = self.unit.arm_angle(self.unit.psi_bottom)
        turned = np.arctan2(
            sine * np.cos(low) - cosine * np.sin(low), cosine * np.cos(low) + sine * np.sin(low)
        )
        rise: Floats = sign * self.unit.A * np.stack((turned, d1, d2))
        return rise


def end_angles(unit: PumpingUnit) -> tuple[Any, Any]:
    """Crank angles at the bottom and at the top, crank and pitman in line [rad]."""
    # +1 where the crank points to the pitman's end, else −1.
    side = -1 if unit.is_class_3 else 1
    return _end_angle(unit, unit.psi_bottom, side), _end_angle(unit, unit.psi_top, -side)


def _end_angle(unit: PumpingUnit, psi: Any, sign: int) -> Any:
    x, y = unit.saddle
    arm = unit.arm_angle(psi)
    ex, ey = x + unit.C * np.cos(arm), y + unit.C * np.sin(arm)
    return np.mod(np.arctan2(sign * ey, sign * ex) - unit.crank_phase, 2 * np.pi)


def turn_extreme(of: Callable[[Floats], Floats], sign: int) -> tuple[float, float]:
    """Maximum (+1) or minimum (−1) value of a smooth quantity over the revolution, and its crank angle.

    ``of``: values at crank angles [rad] → the value, and the first crank angle from 0 to 2π that has it
    [rad].
    """
    turn = turn_curve(lambda phi: of(phi)[None], np.array([0.0, 2 * np.pi]), "motion")
    return turn.extreme(sign)
