"""Motor and loads as forces with a linear law, which programs of multibody dynamics have.

    force = constant + per length · length + per speed · speed

The length is that of the line between two points, the travel of a block, a sum of joint angles, or a
coordinate of a point. Weight is an acceleration of all masses; dry friction is its size alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from linkwright.drive.model.drive import Drive
from linkwright.kernel.arrays import Floats
from linkwright.kinetostatics.model import loads
from linkwright.linkages.model.structure import FRAME
from linkwright.multibody.tree import Tree, added


@dataclass(frozen=True)
class Line:
    """Two points that a force pulls together along the line between them."""

    points: tuple[str, str]


@dataclass(frozen=True)
class Joints:
    """A sum of joint coordinates, counted from the initial position, that a torque or force acts on."""

    factors: dict[str, float]  # by joint


@dataclass(frozen=True)
class AtPoint:
    """A force on a point in a direction of the frame, or of the body that carries it."""

    point: str
    direction: Floats  # unit vector (2,)
    is_carried: bool = False  # whether the direction is that of the body


@dataclass(frozen=True)
class Law:
    """A force with a linear law; positive as its coordinate increases."""

    name: str
    on: Line | Joints | AtPoint
    constant: float = 0.0
    per_length: float = 0.0
    per_speed: float = 0.0
    dry: float = 0.0  # size of dry friction
    is_motor: bool = False  # whether the supply switches it


def motor_law(tree: Tree, drive: Drive | None) -> Law | None:
    """The motor at the crank: M = i M₀ − i² (M₀/ω₀) ω; None without one, or with one of constant speed."""
    line = None if drive is None or drive.motor is None else drive.motor.polyline()
    if drive is None or line is None:
        return None
    speeds, torques, is_endless = line
    ratio, torque = float(drive.gearbox.ratio), float(torques[0])
    falls = torque / float(speeds[-1]) if is_endless else 0.0
    on = Joints({tree.crank: 1.0})
    return Law("drive.motor", on, constant=ratio * torque, per_speed=-(ratio**2) * falls, is_motor=True)


def load_laws(tree: Tree, names: Iterable[str]) -> Iterator[Law]:
    """The laws of loads by name, without weight; those that are refused must be left out."""
    for name in names:
        for law in _laws(tree, f"loads.{name}", tree.scene.machine.all_loads[name]):
            # A torque on a body that does not turn does no work.
            if not isinstance(law.on, Joints) or law.on.factors:
                yield law


def _laws(tree: Tree, name: str, load: object) -> Iterator[Law]:
    match load:
        case loads.ConstantForce():
            direction = np.array([np.cos(load.direction), np.sin(load.direction)])
            yield Law(name, AtPoint(load.on, direction, load.along is not None), constant=load.force)
        case loads.ConstantTorque():
            yield Law(name, Joints(tree.turning(load.on)), constant=load.torque)
        case loads.Spring():
            k, free = load.stiffness or 0.0, load.free_length or 0.0
            yield Law(name, Line(load.between), constant=k * free - load.preload, per_length=-k)
        case loads.Damper():
            yield Law(name, Line(load.between), per_speed=-(load.damping or 0.0))
        case loads.TorsionalSpring():
            turning, k = relative_turning(tree, load), load.stiffness
            start = _start_angle(tree, load)
            yield Law(name, Joints(turning), constant=-k * start, per_length=-k)
        case loads.TorsionalDamper():
            yield Law(name, Joints(relative_turning(tree, load)), per_speed=-load.damping_torsional)
        case loads.ViscousFriction(damping=None):
            yield Law(name, Joints(tree.turning(load.on)), per_speed=-(load.damping_torsional or 0.0))
        case loads.ViscousFriction():
            yield from _viscous(tree, name, load)
        case loads.DryFriction(force=None):
            yield Law(name, Joints(tree.turning(load.on)), dry=load.torque or 0.0)
        case loads.DryFriction():
            yield Law(name, Joints({slide_joint(tree, load.on): 1.0}), dry=load.force or 0.0)


def slide_joint(tree: Tree, slide: str) -> str:
    """The joint of the tree that a slide is the coordinate of; empty if it is none."""
    joint = f"{slide}.guide"
    return joint if joint in tree.joints() else ""


def relative_turning(tree: Tree, load: loads.TorsionalSpring | loads.TorsionalDamper) -> dict[str, float]:
    """Angle of a link relative to another, as a sum of joint angles."""
    against = FRAME if load.against is None else load.against
    return added(tree.turning(load.on), tree.turning(against, -1.0))


def _start_angle(tree: Tree, load: loads.TorsionalSpring) -> float:
    """Angle by which a torsional spring is wound at the initial position, within half a revolution."""
    wound = tree.scene.angle(load.on)[0] - tree.scene.angle(load.against)[0] - load.free_angle
    return float(np.arctan2(np.sin(wound), np.cos(wound)))


def _viscous(tree: Tree, name: str, load: loads.ViscousFriction) -> Iterator[Law]:
    """Along a slide one law, on a point one along each axis."""
    damping = -(load.damping or 0.0)
    if joint := slide_joint(tree, load.on):
        yield Law(name, Joints({joint: 1.0}), per_speed=damping)
    else:
        for axis, direction in (("x", np.array([1.0, 0.0])), ("y", np.array([0.0, 1.0]))):
            yield Law(f"{name}.{axis}", AtPoint(load.on, direction), per_speed=damping)
