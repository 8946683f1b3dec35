"""What each load does to the members; what the crankshaft feels directly stands apart.

A load on a point or a link acts from outside the machine. A load along a slide acts between what slides and the
body of its guide, a spring between the members that carry its ends.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.analysis.kinetostatics.inertia import masses
from linkwright.analysis.kinetostatics.scene import Scene, dot
from linkwright.analysis.kinetostatics.wrench import Wrenches
from linkwright.machine import (
    ConstantForce,
    ConstantTorque,
    DryFriction,
    ForcePosition,
    Gravity,
    Spring,
    TorqueAngle,
    TorqueSpeed,
    ViscousFriction,
)

Floats = NDArray[np.float64]

# Speed, over the crank's times the size of the mechanism, below which dry friction has no direction.
_STANDS = 1e-12


@dataclass
class Applied:
    """A load at all crank angles.

    Attributes
    ----------
    wrenches : Wrenches
        On members and frame.
    resisting : ndarray, shape (n,)
        Torque against the crankshaft itself [N m].
    """

    wrenches: Wrenches
    resisting: Floats


def applied(scene: Scene, load: Any) -> Applied:
    """What a load does.

    Parameters
    ----------
    scene : Scene
        The machine and its motion.
    load : Load
        One of its loads.

    Returns
    -------
    Applied
        Forces and moments on the members, and torque on the crankshaft.
    """
    on_crankshaft: dict[type, Callable[[Scene, Any], Floats]] = {
        TorqueAngle: _over_angle,
        TorqueSpeed: _over_speed,
    }
    on_members: dict[type, Callable[[Scene, Any], Wrenches]] = {
        DryFriction: _dry,
        ViscousFriction: _viscous,
        ConstantForce: _force,
        ConstantTorque: _torque,
        Gravity: _weight,
        Spring: _spring,
        ForcePosition: _over_position,
    }
    kind = type(load)
    if kind in on_crankshaft:
        return Applied(Wrenches(scene), on_crankshaft[kind](scene, load))
    return Applied(on_members[kind](scene, load), np.zeros(scene.n))


def slide_force(scene: Scene, on: str, force: Floats) -> Wrenches:
    """A force (n,) along a slide on what slides, and its opposite on the guide."""
    pair = scene.structure.pairs[f"{on}.guide"]
    assert pair.guide is not None
    return Wrenches(scene).on_guide(pair, force[:, None] * scene.direction(pair.guide), np.zeros(scene.n))


def _sense(rate: Floats, size: float, scene: Scene) -> Floats:
    """Sign of a speed; zero where it stands."""
    sign: Floats = np.where(np.abs(rate) > _STANDS * size, np.sign(rate), 0.0) * np.sign(scene.motion.speed)
    return sign


def _dry(scene: Scene, load: DryFriction) -> Wrenches:
    if load.torque is not None:
        return Wrenches(scene).couple(load.on, -load.torque * _sense(scene.angle(load.on, 1), 1.0, scene))
    assert load.force is not None
    if load.on in scene.kinematics.slides:
        rate = scene.kinematics.slides[load.on].d1
        return slide_force(scene, load.on, -load.force * _sense(rate, scene.size, scene))
    path = scene.point(load.on, 1)
    speed = np.hypot(path[:, 0], path[:, 1])
    sense = _sense(speed, scene.size, scene) / np.where(speed > 0, speed, 1.0)
    return _on_point(scene, load.on, -load.force * sense[:, None] * path)


def _viscous(scene: Scene, load: ViscousFriction) -> Wrenches:
    speed = scene.motion.speed
    if load.damping_torsional is not None:
        return Wrenches(scene).couple(load.on, -load.damping_torsional * scene.angle(load.on, 1) * speed)
    assert load.damping is not None
    if load.on in scene.kinematics.slides:
        return slide_force(scene, load.on, -load.damping * scene.kinematics.slides[load.on].d1 * speed)
    return _on_point(scene, load.on, -load.damping * scene.point(load.on, 1) * speed[:, None])


def _on_point(scene: Scene, point: str, force: Floats) -> Wrenches:
    """A force (n, 2) on what carries a point."""
    return Wrenches(scene).force(scene.carrier(point), force, scene.point(point))


def _force(scene: Scene, load: ConstantForce) -> Wrenches:
    vector = load.force * np.array([np.cos(load.direction), np.sin(load.direction)])
    return _on_point(scene, load.on, np.broadcast_to(vector, (scene.n, 2)))


def _torque(scene: Scene, load: ConstantTorque) -> Wrenches:
    return Wrenches(scene).couple(load.on, np.full(scene.n, load.torque))


def _weight(scene: Scene, load: Gravity) -> Wrenches:
    fall = load.acceleration * np.array([np.cos(load.direction), np.sin(load.direction)])
    found = Wrenches(scene)
    for each in masses(scene):
        found.force(each.member, np.broadcast_to(each.mass * fall, (scene.n, 2)), each.centre)
    return found


def along_line(scene: Scene, between: tuple[str, str], pull: Callable[[Floats, Floats], Floats]) -> Wrenches:
    """A pull on two points towards each other, by the distance [m] and the speed of parting [m/s]."""
    first, second = between
    u = scene.point(second) - scene.point(first)
    length = np.hypot(u[:, 0], u[:, 1])
    e = u / np.where(length > 0, length, 1.0)[:, None]
    parting = dot(e, scene.point(second, 1) - scene.point(first, 1)) * scene.motion.speed
    force = pull(length, parting)[:, None] * e
    found = Wrenches(scene).force(scene.carrier(first), force, scene.point(first))
    return found.force(scene.carrier(second), -force, scene.point(second))


def _spring(scene: Scene, load: Spring) -> Wrenches:
    return along_line(
        scene, load.between, lambda length, _: load.stiffness * (length - load.free_length)
    )


def _over_position(scene: Scene, load: ForcePosition) -> Wrenches:
    slide = scene.kinematics.slides[load.on]
    sense = _sense(slide.d1, scene.size, scene)
    ahead = np.interp(slide.position, load.position, load.forward)
    behind = np.interp(slide.position, load.position, load.return_) if load.return_ else 0.0 * ahead
    return slide_force(scene, load.on, np.where(sense > 0, -ahead, np.where(sense < 0, behind, 0.0)))


def _over_angle(scene: Scene, load: TorqueAngle) -> Floats:
    torque: Floats = np.interp(scene.motion.crank_angle, load.angle, load.torque, period=2 * np.pi)
    return torque


def _over_speed(scene: Scene, load: TorqueSpeed) -> Floats:
    speed = scene.motion.speed
    torque: Floats = np.interp(np.abs(speed), load.speed, load.torque) * np.sign(speed)
    return torque
