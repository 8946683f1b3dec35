"""What each load does to members and crankshaft.

A load on a point or a link acts from outside the machine. A load along a slide acts between what slides and
the body of its guide, a spring between the members that carry its ends.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.formula import NUMBERS, parse
from linkwright.kernel.errors import FindingError
from linkwright.kernel.numerics.formula_value import value
from linkwright.kernel.numerics.tangent import on_lines, primal
from linkwright.kinetostatics.model import loads
from linkwright.kinetostatics.places import Scene, dot, unit
from linkwright.kinetostatics.wrench import Wrenches, masses
from linkwright.linkages.model.structure import FRAME
from linkwright.machine.machine import Machine
from linkwright.machine.program.loads import gas_column


def formula_wrenches(scene: Scene, load: loads.FormulaLoad) -> Wrenches:
    """What a load by a formula does. Raises FindingError: the formula has no value at some crank angle."""
    with np.errstate(all="ignore"):
        force = value(parse(load.text), _names(scene, load)) * np.ones(scene.n)
    if not np.isfinite(force).all():
        at = np.degrees(scene.motion.crank_angle[int(np.argmin(np.isfinite(force)))])
        raise FindingError(f'the formula "{load.text}" on {load.on} has no value at crank angle {at:.4g}°')
    if load.torque is not None:
        return Wrenches(scene).couple(load.on, force)
    if load.direction is None and load.along is None:
        return Wrenches(scene).along_slide(load.on, force)
    direction = unit(scene.angle(load.along) + (0.0 if load.direction is None else load.direction))
    return Wrenches(scene).at_point(load.on, force[:, None] * direction)


def _names(scene: Scene, load: loads.FormulaLoad) -> dict[str, Any]:
    motion = scene.motion
    names: dict[str, Any] = {
        **NUMBERS,
        # Whole revolutions, which do not vary.
        "phi": motion.crank_angle % primal(load.cycle),
        "omega": motion.speed,
        "t": motion.time,
    }
    link = load.on if load.torque is not None else load.along
    if link is not None:
        psi = scene.angle(link)
        names |= {"psi": np.arctan2(np.sin(psi), np.cos(psi)), "psi_dot": scene.angle(link, 1) * motion.speed}
    if load.torque is None:
        place, velocity = scene.point(load.on), scene.point(load.on, 1) * motion.speed[:, None]
        names |= {"x": place[:, 0], "y": place[:, 1], "vx": velocity[:, 0], "vy": velocity[:, 1]}
        names["v"] = np.hypot(velocity[:, 0], velocity[:, 1])
        if load.direction is None and load.along is None:
            slide = scene.kinematics.slides[load.on]
            names |= {"s": slide.position, "v": slide.d1 * motion.speed}
    return names | dict(load.constants)


# Speed, over the crank's times the size of the mechanism, below which dry friction has no direction.
_STANDS = 1e-12


@dataclass
class AppliedLoad:
    """A load at all crank angles."""

    wrenches: Wrenches  # on members and frame
    resisting: Floats  # (n,): torque against the crankshaft itself [N m]


def applied(scene: Scene, load: Any) -> AppliedLoad:
    """What a load does. Returns: forces and moments on the members, and torque on the crankshaft."""
    on_crankshaft: dict[type, Callable[[Scene, Any], Floats]] = {
        loads.TorqueAngle: _torque_over_angle,
        loads.TorqueSpeed: _over_speed,
    }
    on_members: dict[type, Callable[[Scene, Any], Wrenches]] = {
        loads.DryFriction: _dry,
        loads.ViscousFriction: _viscous,
        loads.ConstantForce: _force,
        loads.ConstantTorque: _torque,
        loads.Gravity: _weight,
        loads.Spring: _spring,
        loads.Damper: _damper,
        loads.GasSpring: _gas,
        loads.TorsionalSpring: _torsional_spring,
        loads.TorsionalDamper: _torsional_damper,
        loads.ForcePosition: _over_position,
        loads.ForceAngle: _force_over_angle,
        loads.TorqueSwing: _over_swing,
        loads.FormulaLoad: formula_wrenches,
    }
    kind = type(load)
    if kind in on_crankshaft:
        return AppliedLoad(Wrenches(scene), on_crankshaft[kind](scene, load))
    return AppliedLoad(on_members[kind](scene, load), np.zeros(scene.n))


def together(scene: Scene, sources: Iterable[AppliedLoad]) -> AppliedLoad:
    """The sum of several loads."""
    applied = AppliedLoad(Wrenches(scene), scene.zeros(scene.n))
    for source in sources:
        applied.wrenches.add(source.wrenches)
        applied.resisting += source.resisting
    return applied


def _sense(rate: Floats, size: float, scene: Scene) -> Floats:
    sign: Floats = np.where(np.abs(rate) > _STANDS * size, np.sign(rate), 0.0) * np.sign(scene.motion.speed)
    return sign


def _dry(scene: Scene, load: loads.DryFriction) -> Wrenches:
    if load.torque is not None:
        return Wrenches(scene).couple(load.on, -load.torque * _sense(scene.angle(load.on, 1), 1.0, scene))
    assert load.force is not None
    if load.on in scene.kinematics.slides:
        rate = scene.kinematics.slides[load.on].d1
        return Wrenches(scene).along_slide(load.on, -load.force * _sense(rate, scene.size, scene))
    path = scene.point(load.on, 1)
    speed = np.hypot(path[:, 0], path[:, 1])
    sense = _sense(speed, scene.size, scene) / np.where(speed > 0, speed, 1.0)
    return Wrenches(scene).at_point(load.on, -load.force * sense[:, None] * path)


def _viscous(scene: Scene, load: loads.ViscousFriction) -> Wrenches:
    speed = scene.motion.speed
    if load.damping_torsional is not None:
        return Wrenches(scene).couple(load.on, -load.damping_torsional * scene.angle(load.on, 1) * speed)
    assert load.damping is not None
    if load.on in scene.kinematics.slides:
        return Wrenches(scene).along_slide(
            load.on, -load.damping * scene.kinematics.slides[load.on].d1 * speed
        )
    return Wrenches(scene).at_point(load.on, -load.damping * scene.point(load.on, 1) * speed[:, None])


def _force(scene: Scene, load: loads.ConstantForce) -> Wrenches:
    return Wrenches(scene).at_point(load.on, load.force * unit(scene.angle(load.along) + load.direction))


def _torque(scene: Scene, load: loads.ConstantTorque) -> Wrenches:
    return Wrenches(scene).couple(load.on, load.torque * np.ones(scene.n))


def gravity(machine: Machine, left_out: Collection[str] = ()) -> Floats:
    """Acceleration of gravity, all such loads together, (2,) [m/s²]."""
    own = (load for name, load in machine.all_loads.items() if name not in left_out)
    return sum((_fall(load) for load in own if isinstance(load, loads.Gravity)), np.zeros(2))


def _fall(load: loads.Gravity) -> Any:
    return load.acceleration * np.stack([np.cos(load.direction), np.sin(load.direction)])


def _weight(scene: Scene, load: loads.Gravity) -> Wrenches:
    fall = _fall(load)
    wrenches = Wrenches(scene)
    for mass in masses(scene):
        wrenches.force(mass.member, np.broadcast_to(mass.mass * fall, (scene.n, 2)), mass.centre)
    return wrenches


def along_line(scene: Scene, between: tuple[str, str], pull: Callable[[Floats, Floats], Floats]) -> Wrenches:
    """A pull on two points towards each other, by the distance [m] and the speed of parting [m/s]."""
    first, second = between
    u = scene.point(second) - scene.point(first)
    length = np.hypot(u[:, 0], u[:, 1])
    e = u / np.where(length > 0, length, 1.0)[:, None]
    parting = dot(e, scene.point(second, 1) - scene.point(first, 1)) * scene.motion.speed
    force = pull(length, parting)[:, None] * e
    wrenches = Wrenches(scene).force(scene.carrier(first), force, scene.point(first))
    return wrenches.force(scene.carrier(second), -force, scene.point(second))


def _spring(scene: Scene, load: loads.Spring) -> Wrenches:
    if load.length is not None and load.force is not None:
        x, y = load.length, load.force
        return along_line(scene, load.between, lambda length, _: on_lines(length, x, y))
    k, free = (0.0 if x is None else x for x in (load.stiffness, load.free_length))
    return along_line(scene, load.between, lambda length, _: load.preload + k * (length - free))


def _damper(scene: Scene, load: loads.Damper) -> Wrenches:
    if load.velocity is not None and load.force is not None:
        x, y = load.velocity, load.force
        return along_line(scene, load.between, lambda _, parting: on_lines(parting, x, y))
    c = 0.0 if load.damping is None else load.damping
    return along_line(scene, load.between, lambda _, parting: c * parting)


def _gas(scene: Scene, load: loads.GasSpring) -> Wrenches:
    """p Vⁿ is kept: F = −F₁ (h/(h − way))ⁿ (docs/loads.md)."""
    h = gas_column(load)

    def pull(length: Floats, _: Floats) -> Floats:
        rest = h - (load.length_extended - length)
        if (rest <= 0).any():
            at = float(np.degrees(scene.motion.crank_angle[int(rest.argmin())]))
            raise FindingError(
                f"the gas spring between {' and '.join(load.between)} is pressed in by all of its gas at "
                f"crank angle {at:.4g}°; make length_compressed smaller or place it elsewhere"
            )
        force: Floats = -load.force_extended * (h / rest) ** load.exponent
        return force

    return along_line(scene, load.between, pull)


def _against(scene: Scene, load: loads.TorsionalSpring | loads.TorsionalDamper, torque: Floats) -> Wrenches:
    """A torque on a link, and the opposite one on what it holds on to."""
    return Wrenches(scene).couple(load.on, torque).couple(load.against or FRAME, -torque)


def _torsional_spring(scene: Scene, load: loads.TorsionalSpring) -> Wrenches:
    turned = scene.angle(load.on) - scene.angle(load.against) - load.free_angle
    return _against(scene, load, -load.stiffness * np.arctan2(np.sin(turned), np.cos(turned)))


def _torsional_damper(scene: Scene, load: loads.TorsionalDamper) -> Wrenches:
    rate = (scene.angle(load.on, 1) - scene.angle(load.against, 1)) * scene.motion.speed
    return _against(scene, load, -load.damping_torsional * rate)


def _over_position(scene: Scene, load: loads.ForcePosition) -> Wrenches:
    slide = scene.kinematics.slides[load.on]
    sense = _sense(slide.d1, scene.size, scene)
    ahead = on_lines(slide.position, load.position, load.forward)
    behind = on_lines(slide.position, load.position, load.return_) if load.return_ else 0.0 * ahead
    return Wrenches(scene).along_slide(load.on, np.where(sense > 0, -ahead, np.where(sense < 0, behind, 0.0)))


def _over_swing(scene: Scene, load: loads.TorqueSwing) -> Wrenches:
    sense = _sense(scene.angle(load.on, 1), 1.0, scene)
    # Within half a revolution to both sides of the middle of the table.
    middle = 0.5 * (load.angle[0] + load.angle[-1])
    turned = scene.angle(load.on) - middle
    angle = middle + np.arctan2(np.sin(turned), np.cos(turned))
    ahead = on_lines(angle, load.angle, load.forward)
    behind = on_lines(angle, load.angle, load.return_) if load.return_ else 0.0 * ahead
    return Wrenches(scene).couple(load.on, np.where(sense > 0, -ahead, np.where(sense < 0, behind, 0.0)))


def _over_angle(scene: Scene, load: loads.OverCrankAngle, values: Sequence[float]) -> Floats:
    at: Floats = on_lines(scene.motion.crank_angle, *load.points(values), period=primal(load.cycle))
    return at


def _torque_over_angle(scene: Scene, load: loads.TorqueAngle) -> Floats:
    return _over_angle(scene, load, load.torque)


def _force_over_angle(scene: Scene, load: loads.ForceAngle) -> Wrenches:
    return Wrenches(scene).along_slide(load.on, _over_angle(scene, load, load.force))


def _over_speed(scene: Scene, load: loads.TorqueSpeed) -> Floats:
    speed = scene.motion.speed
    torque: Floats = on_lines(np.abs(speed), load.speed, load.torque) * np.sign(speed)
    return torque
