"""The tree of a machine as URDF, the model format of robotics.

URDF has no loops: joints follow the crank by the table of `transmission`. A joint that follows one other in
proportion, as gears do, has a ``mimic`` besides.

Source: URDF XML specification, http://wiki.ros.org/urdf/XML.
"""

from __future__ import annotations

from collections.abc import Mapping
from xml.etree import ElementTree

from linkwright.kernel.arrays import Floats
from linkwright.linkages.model.structure import FRAME
from linkwright.multibody.numbers import element, numbers, text_of
from linkwright.multibody.transmission import Transmission
from linkwright.multibody.tree import Body, Coupling, Tree

# The root of the tree, by the convention of ROS (REP 105).
BASE = "base_link"

# Share of its range by which a slide may leave it, and effort and speed that URDF asks for: no limits.
_MARGIN, _NO_LIMIT = 1e-6, 1e9


def urdf_text(tree: Tree, name: str, masses: Mapping[str, tuple[float, float]], motion: Transmission) -> str:
    """The tree as text; `masses`: mass and inertia of each body; `motion`: its joints over a cycle."""
    root = element(None, "robot", name=name)
    loops = ", ".join(loop.name for loop in tree.loops)
    if loops:
        root.append(
            ElementTree.Comment(f" Loops that the transmission table closes: {loops} ".replace("--", "- -"))
        )
    element(root, "link", name=BASE)
    for body in tree.bodies.values():
        _link(root, body, *masses[body.name])
    mimics = dict(_mimic(coupling) for coupling in tree.couplings if len(coupling.factors) == 2)
    for body in tree.bodies.values():
        joint = _joint(root, body)
        if body.kind == "slide":
            _limits(joint, motion.joints[body.joint].position)
        if body.joint in mimics:
            other, factor = mimics[body.joint]
            element(joint, "mimic", joint=other, multiplier=numbers(factor), offset="0")
    return text_of(root)


def _link(root: ElementTree.Element, body: Body, mass: float, inertia: float) -> None:
    link = element(root, "link", name=body.name)
    inertial = element(link, "inertial")
    element(inertial, "origin", xyz=numbers(*body.centre, 0.0), rpy="0 0 0")
    element(inertial, "mass", value=numbers(mass))
    moments = {axis: numbers(inertia) for axis in ("ixx", "iyy", "izz")}
    element(inertial, "inertia", **moments, ixy="0", ixz="0", iyz="0")


def _joint(root: ElementTree.Element, body: Body) -> ElementTree.Element:
    kinds = {"hinge": "continuous", "slide": "prismatic", "fixed": "fixed"}
    joint = element(root, "joint", name=body.joint or f"{body.name}.fixed", type=kinds[body.kind])
    element(joint, "parent", link=BASE if body.parent == FRAME else body.parent)
    element(joint, "child", link=body.name)
    element(joint, "origin", xyz=numbers(*body.place, 0.0), rpy=numbers(0.0, 0.0, body.turned))
    if body.kind != "fixed":
        axis = (0.0, 0.0, 1.0) if body.kind == "hinge" else (*body.axis, 0.0)
        element(joint, "axis", xyz=numbers(*axis))
    return joint


def _limits(joint: ElementTree.Element, travel: Floats) -> None:
    """The range of a slide over a cycle, which URDF asks for."""
    low, high = float(travel.min()), float(travel.max())
    margin = _MARGIN * (high - low)
    limit = {"lower": numbers(low - margin), "upper": numbers(high + margin)}
    element(joint, "limit", **limit, effort=numbers(_NO_LIMIT), velocity=numbers(_NO_LIMIT))


def _mimic(coupling: Coupling) -> tuple[str, tuple[str, float]]:
    """The first joint of a coupling, the one that it follows, and their ratio."""
    (follower, own), (leader, other) = coupling.factors.items()
    return follower, (leader, -other / own)
