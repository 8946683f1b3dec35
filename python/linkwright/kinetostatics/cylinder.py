r"""A cylinder over the cycle: force, pressure in each chamber, flow and power.

The force F on the rod, positive outwards, is an unknown of the equilibrium of all members
(`linkwright.kinetostatics.forces`); at speed zero it is what holds each position. With the areas A₁ of the
bore side and A₂ of the rod side, the chamber that the load does not press on is open to the tank at p_b:

.. math:: F = p_1 A_1 - p_2 A_2, \qquad \min(p_1, p_2) = p_b, \qquad Q_i = A_i \dot L, \qquad P = F \dot L
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError
from linkwright.kernel.findings import Findings
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.reader.numbers import degrees, quantity
from linkwright.kernel.result import Result
from linkwright.kinetostatics.forces import forces
from linkwright.kinetostatics.model.cylinder_loads import push_of
from linkwright.kinetostatics.motion import has_speed
from linkwright.kinetostatics.result import Forces
from linkwright.linkages.closure import closure, turn_angles
from linkwright.linkages.kinematics import kinematics_of
from linkwright.linkages.model.cylinder import Cylinder
from linkwright.machine.analysis import Results
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine

# Share of a length by which rounding may pass a limit; of a cycle time by which two speeds differ.
_ROUNDING, _SAME_TIME = 1e-9, 1e-3

# Angles of a revolution at which lengths are looked at.
_ANGLES = 720


@dataclass(frozen=True)
class CylinderForce(Result):
    """A cylinder over the crank angle."""

    crank_angle: Annotated[Floats, Label("crank angle", "φ", "rad")]
    time: Annotated[Floats, Label("time", "t", "s")]
    length: Annotated[Floats, Label("length", "L", "m", "From trunnion to rod eye.")]
    velocity: Annotated[Floats, Label("velocity of the rod", "v", "m/s", "Positive outwards.")]
    force: Annotated[
        Floats, Label("force on the rod", "F", "N", "Positive outwards; seal friction included.")
    ]
    power: Annotated[Floats, Label("power of the cylinder", "P", "W", "Negative where the load drives it.")]
    name: Annotated[str, About("The cylinder's.")]
    pressure_bore: Annotated[
        Floats | None, Label("pressure on the bore side", "p₁", "Pa", "None without a bore.")
    ] = None
    pressure_rod: Annotated[Floats | None, Label("pressure on the rod side", "p₂", "Pa")] = None
    flow_bore: Annotated[
        Floats | None, Label("flow into the bore side", "Q₁", "m³/s", "Negative out of it.")
    ] = None
    flow_rod: Annotated[Floats | None, Label("flow out of the rod side", "Q₂", "m³/s")] = None
    findings: Annotated[tuple[str, ...], About("Limits of the length that are exceeded, in sentences.")] = ()

    @property
    def length_min(self) -> Annotated[float, Label("minimum length", "L_min", "m")]:
        """Among the angles."""
        return float(np.nanmin(self.length))

    @property
    def length_max(self) -> Annotated[float, Label("maximum length", "L_max", "m")]:
        """Among the angles."""
        return float(np.nanmax(self.length))

    @property
    def stroke(self) -> Annotated[float, Label("stroke used", "H", "m")]:
        """Difference of both."""
        return self.length_max - self.length_min

    @property
    def velocity_max(self) -> Annotated[float, Label("peak velocity of the rod", "v_max", "m/s")]:
        """With its sign."""
        return _peak(self.velocity)

    @property
    def force_max(self) -> Annotated[float, Label("maximum force on the rod", "F_max", "N")]:
        """With its sign: push."""
        return float(np.nanmax(self.force))

    @property
    def force_min(self) -> Annotated[float, Label("minimum force on the rod", "F_min", "N")]:
        """With its sign: negative is pull."""
        return float(np.nanmin(self.force))

    @property
    def pressure_max(self) -> Annotated[float | None, Label("maximum pressure", "p_max", "Pa")]:
        """Of both chambers; None without a bore."""
        if self.pressure_bore is None or self.pressure_rod is None:
            return None
        return float(np.nanmax([self.pressure_bore, self.pressure_rod]))

    @property
    def flow_max(self) -> Annotated[float | None, Label("peak flow of the pump", "Q_max", "m³/s")]:
        """Into the chamber that grows; None without a bore."""
        if self.flow_bore is None or self.flow_rod is None:
            return None
        return float(np.nanmax(np.maximum(self.flow_bore, -self.flow_rod)))

    @property
    def power_max(self) -> Annotated[float, Label("peak power of the cylinder", "P_max", "W")]:
        """With its sign."""
        return _peak(self.power)


def _peak(values: Floats) -> float:
    """The value of the peak, with its sign."""
    return float(values[np.nanargmax(np.abs(values))])


@public
def cylinder_force(machine: Machine, name: str | None = None, motion: Forces | None = None) -> CylinderForce:
    """Force, pressures, flow and power of a cylinder over the cycle.

    Parameters
    ----------
    machine : Machine
    name : str, optional
        Name of the cylinder; not needed if there is one.
    motion : Forces, optional
        Forces along a motion. Without it: along the motion of the machine, or at rest at every angle where
        nothing says how fast it is.

    Returns
    -------
    CylinderForce
        Over the crank angle.

    Raises
    ------
    InputError
        No such cylinder.
    FindingError
        The mechanism does not close over the cycle, or has no forces.

    Notes
    -----
    Pressures are above that of the surroundings. The oil is incompressible, and no leakage counts.
    """
    cylinders = machine.mechanism.cylinders
    if name is None and len(cylinders) == 1:
        (name,) = cylinders
    if name not in cylinders:
        found = "none" if name is None else f'"{name}"'
        raise InputError(f"cylinder: found {found}, expected one of {', '.join(cylinders) or 'no cylinders'}")
    return _duty(machine, name, forces_of_cylinders(machine) if motion is None else motion)


def forces_of_cylinders(machine: Machine) -> Forces:
    """Forces along the motion of a machine: of its drive, or its flow; else at rest at every angle."""
    return forces(machine, speed=None if has_speed(machine) else 0.0)


def _duty(machine: Machine, name: str, known: Forces) -> CylinderForce:
    cylinder = machine.mechanism.cylinders[name]
    slide = kinematics_of(compile_machine(machine), known.crank_angle, [("slides", name)]).slides[name]
    velocity = slide.d1 * known.speed
    force = known.drives[name] if cylinder.drives else force_of(cylinder, slide.position, velocity)
    chambers = dict[str, Any]()
    if cylinder.areas is not None:
        (bore, rod), pressures = cylinder.areas, pressures_of(cylinder, force)
        chambers = dict(zip(("pressure_bore", "pressure_rod"), pressures, strict=True))
        chambers |= {"flow_bore": bore * velocity, "flow_rod": rod * velocity}
    return CylinderForce(
        crank_angle=known.crank_angle,
        time=known.time,
        length=slide.position,
        velocity=velocity,
        force=force,
        power=force * velocity,
        name=name,
        findings=tuple(_beyond(name, cylinder, known.crank_angle, slide.position)),
        **chambers,
    )


def force_of(cylinder: Cylinder, length: Any, velocity: Any) -> Any:
    """Force of a cylinder that is no driver, without the friction of its seals."""
    force = 0.0 * length
    if cylinder.areas is not None:
        force = force + push_of(cylinder, cylinder.pressure or 0.0, cylinder.pressure_rod or 0.0)
    pull = cylinder.preload + (cylinder.stiffness or 0.0) * (length - (cylinder.free_length or 0.0))
    return force - pull - (cylinder.damping or 0.0) * velocity


def pressures_of(cylinder: Cylinder, force: Any) -> tuple[Any, Any]:
    """Pressure on the bore side and on the rod side that make a force."""
    if not cylinder.drives:
        still = 0.0 * force
        return still + (cylinder.pressure or 0.0), still + (cylinder.pressure_rod or 0.0)
    assert cylinder.areas is not None
    bore, rod = cylinder.areas
    back = cylinder.back_pressure
    pushed = (force + back * rod) / bore
    is_pushed = pushed >= back
    pulled = (back * bore - force) / rod
    return np.where(is_pushed, pushed, back + 0.0 * pushed), np.where(is_pushed, back + 0.0 * pushed, pulled)


def _beyond(name: str, cylinder: Cylinder, angles: Floats, length: Floats) -> list[str]:
    """Limits of the length that are exceeded: where and by how much."""
    found = []
    for limit, sign, word in ((cylinder.length_max, 1, "above"), (cylinder.length_min, -1, "below")):
        if limit is None:
            continue
        excess = sign * (length - limit)
        at = int(np.nanargmax(excess))
        if excess[at] > _ROUNDING * limit:
            key = "length_max" if sign > 0 else "length_min"
            found.append(
                f"the cylinder {name} is {1e3 * excess[at]:.4g} mm {word} {key}, {quantity(limit, 'm')}, at "
                f"a crank angle of {degrees(float(angles[at]))}: choose one with a longer stroke, or "
                "other points"
            )
    return found


def made_cylinders(known: Results, findings: Findings) -> dict[str, CylinderForce]:
    """All cylinders of a machine; the analysis of the linkage says why it does not close."""
    machine = known.machine
    if not closure(machine).turns_fully:
        return {}
    along = known.forces or findings.beside_of(forces_of_cylinders, machine)
    if along is None:
        return {}
    made = {name: findings.of(_duty, machine, name, along) for name in machine.mechanism.cylinders}
    return {name: duty for name, duty in made.items() if duty is not None}


def check_cylinders(machine: Machine, findings: Findings) -> Iterator[str]:
    """Whether cylinders keep within their lengths."""
    closed = closure(machine)
    cylinders = machine.mechanism.cylinders
    if not closed.turns_fully:
        return
    angles = turn_angles(_ANGLES, closed.turns or 1)
    motion = kinematics_of(compile_machine(machine), angles, [("slides", name) for name in cylinders])
    for name, cylinder in cylinders.items():
        findings.add(_beyond(name, cylinder, angles, motion.slides[name].position))
    yield "cylinders: length_min, length_max"


def cylinder_warnings(machine: Machine) -> list[str]:
    """Flows that belong to another speed than the drive's."""
    speed = None if machine.drive is None else machine.drive.speed
    found = []
    for name, cylinder in machine.mechanism.cylinders.items():
        if cylinder.flow is None or speed is None:
            continue
        turn = 2 * np.pi / speed
        if abs(cylinder.cycle / turn - 1) > _SAME_TIME:
            found.append(
                f"The flow of the cylinder {name} is given for a cycle of {quantity(cylinder.cycle, 's')}, "
                f"and a revolution of the drive takes {quantity(turn, 's')}: the flow is larger or smaller "
                "in this ratio"
            )
    return found
