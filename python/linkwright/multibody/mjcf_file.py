r"""A machine as MJCF, the model format of MuJoCo.

Loops are closed by ``equality connect``. MuJoCo closes them softly: with the impedance d, the acceleration of
the gap is that of a spring and damper to the share d, and free to the share 1 − d,

.. math:: \ddot r = (1 - d)\,\ddot r_0 - d\,(b \dot r + k r), \qquad b = 2/(d\,T), \quad k = 1/(d\,T)^2

with the time constant T, which follows the time step: T = 4 h. Errors of positions then fall with h².

Source: MuJoCo documentation, *Computation*, "Solver parameters"; *XML reference*.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from xml.etree import ElementTree

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.linkages.model.structure import FRAME
from linkwright.multibody.linear_laws import AtPoint, Joints, Law, Line
from linkwright.multibody.numbers import element, numbers, text_of
from linkwright.multibody.tree import Body, Tree, place_of

# Time constant of the loops over the time step. MuJoCo permits 2 or more; at 4 positions are as exact as at
# 2, and speeds and forces ten times more exact.
TIME_CONSTANT = 4.0

# Impedance of the loops: the largest that MuJoCo permits.
IMPEDANCE = 0.9999

# The same at any gap: both limits, then a width, a middle and a power without effect.
_IMPEDANCES = numbers(IMPEDANCE, IMPEDANCE, 1e-3, 0.5, 2.0)


@dataclass(frozen=True)
class Setting:
    """What a model holds besides the tree."""

    name: str
    step: float  # time step [s]
    gravity: Floats  # (2,) [m/s²]
    armature: float  # inertia on the crankshaft [kg m²]
    masses: Mapping[str, tuple[float, float]]  # mass and inertia of each body, none zero
    laws: tuple[Law, ...]
    speeds: Mapping[str, float]  # of each joint at the start


def mjcf_text(tree: Tree, setting: Setting) -> str:
    """The model as text."""
    root = element(None, "mujoco", model=setting.name)
    element(root, "compiler", angle="radian", inertiafromgeom="false", autolimits="true")
    gravity = numbers(*setting.gravity, 0.0)
    solver = {"solver": "Newton", "iterations": "100", "tolerance": "0", "jacobian": "dense"}
    option = element(root, "option", timestep=numbers(setting.step), integrator="RK4", gravity=gravity)
    option.attrib |= solver
    element(option, "flag", contact="disable")
    default = element(root, "default")
    element(default, "geom", contype="0", conaffinity="0", group="1", rgba="0.4 0.5 0.6 1")
    element(default, "equality", solref=_reference(setting), solimp=_IMPEDANCES)
    _worldbody(tree, setting, element(root, "worldbody"))
    _tendons(tree, setting, element(root, "tendon"))
    _equality(tree, element(root, "equality"))
    _actuators(setting, element(root, "actuator"))
    _start(tree, setting, element(root, "keyframe"))
    return text_of(root)


def _reference(setting: Setting) -> str:
    """Time constant and damping ratio of a constraint: no overshoot."""
    return numbers(TIME_CONSTANT * setting.step, 1.0)


# -- bodies --------------------------------------------------------------------------------------------------


def _worldbody(tree: Tree, setting: Setting, world: ElementTree.Element) -> None:
    made = {FRAME: world}
    size = 0.02 * tree.scene.size
    for body in tree.bodies.values():
        part = made[body.name] = element(
            made[body.parent],
            "body",
            name=body.name,
            pos=numbers(*body.place, 0.0),
            euler=numbers(0.0, 0.0, body.turned),
        )
        _joint(part, body, setting.armature if body.joint == tree.crank else 0.0)
        mass, inertia = setting.masses[body.name]
        # A planar motion asks for the inertia about z alone; one alike about all axes is always possible.
        element(
            part,
            "inertial",
            pos=numbers(*body.centre, 0.0),
            mass=numbers(mass),
            diaginertia=numbers(*3 * [inertia]),
        )
        _picture(part, body, size)
    for name, place, carrier in _sites(tree, setting):
        element(made[carrier], "site", name=name, pos=numbers(*place, 0.0), size=numbers(size))


def _joint(part: ElementTree.Element, body: Body, armature: float) -> None:
    if body.kind == "fixed":
        return
    axis = (0.0, 0.0, 1.0) if body.kind == "hinge" else (*body.axis, 0.0)
    joint = element(part, "joint", name=body.joint, type=body.kind, axis=numbers(*axis))
    if armature:
        joint.set("armature", numbers(armature))


def _picture(part: ElementTree.Element, body: Body, size: float) -> None:
    if body.length:
        ends = numbers(body.start, 0.0, 0.0, body.start + body.length, 0.0, 0.0)
        element(part, "geom", type="capsule", fromto=ends, size=numbers(size))
    else:
        element(part, "geom", type="sphere", size=numbers(1.5 * size))


def _sites(tree: Tree, setting: Setting) -> Iterator[tuple[str, Floats, str]]:
    """Points of the mechanism, and those of loops: name, place in the body's frame, body."""
    structure = tree.scene.structure
    for point, carrier in structure.carriers.items():
        if point:
            yield point, tree.local(carrier, place_of(tree.scene, point)), carrier
    for loop in tree.loops:
        for nth, (body, place) in enumerate(zip(loop.bodies, loop.places, strict=True), 1):
            yield f"{loop.name}.loop{nth}", place, body
    if any(isinstance(law.on, AtPoint) for law in setting.laws):
        yield FRAME, np.zeros(2), FRAME


# -- loops, loads, start -------------------------------------------------------------------------------------


def _equality(tree: Tree, part: ElementTree.Element) -> None:
    for loop in tree.loops:
        element(part, "connect", name=loop.name, site1=f"{loop.name}.loop1", site2=f"{loop.name}.loop2")
    for coupling in tree.couplings:
        element(part, "tendon", name=coupling.name, tendon1=coupling.name)


def _tendons(tree: Tree, setting: Setting, part: ElementTree.Element) -> None:
    sums = {coupling.name: coupling.factors for coupling in tree.couplings}
    for law in setting.laws:
        if isinstance(law.on, Line):
            spatial = element(part, "spatial", name=law.name)
            for point in law.on.points:
                element(spatial, "site", site=point)
        elif isinstance(law.on, Joints) and not law.is_motor:
            sums[law.name] = law.on.factors
    dry = {law.name: law.dry for law in setting.laws if law.dry}
    for name, factors in sums.items():
        fixed = element(part, "fixed", name=name)
        if name in dry:
            softness = {"solreffriction": _reference(setting), "solimpfriction": _IMPEDANCES}
            fixed.attrib |= {"frictionloss": numbers(dry[name]), **softness}
        for joint, factor in factors.items():
            element(fixed, "joint", joint=joint, coef=numbers(factor))


def _actuators(setting: Setting, part: ElementTree.Element) -> None:
    for law in setting.laws:
        if law.dry:
            continue
        values = numbers(law.constant, law.per_length, law.per_speed)
        actuator = element(part, "general", name=law.name)
        if law.is_motor and isinstance(law.on, Joints):
            # The supply is the control: 1 is on, 0 is off.
            actuator.set("joint", next(iter(law.on.factors)))
            actuator.attrib |= {"gaintype": "affine", "gainprm": values}
            continue
        if isinstance(law.on, AtPoint):
            actuator.attrib |= {"site": law.on.point, "gear": numbers(*law.on.direction, 0, 0, 0, 0)}
            if not law.on.is_carried:
                actuator.set("refsite", FRAME)
        else:
            actuator.set("tendon", law.name)
        actuator.attrib |= {"gainprm": "0", "biastype": "affine", "biasprm": values}


def _start(tree: Tree, setting: Setting, part: ElementTree.Element) -> None:
    """The initial position, with the speeds of all joints; the supply is on."""
    joints = tree.joints()
    speeds = [setting.speeds[name] for name in joints]
    controls = [1.0 if law.is_motor else 0.0 for law in setting.laws if not law.dry]
    key = element(part, "key", name="start", qpos=numbers(*[0.0] * len(joints)), qvel=numbers(*speeds))
    if controls:
        key.set("ctrl", numbers(*controls))
