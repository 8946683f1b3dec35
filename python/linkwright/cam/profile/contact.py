r"""Contacts of a cam: each a follower that touches a cam, with the curves that follow from it.

| closure | contacts |
| --- | --- |
| spring, groove | one |
| constant diameter or breadth | two on one cam, on opposite sides |
| conjugate | two, each on a cam of its own |

The second follower is fixed to the first, so it falls as that rises: its lift is the stroke less that of the
first. Each contact has its own frame: its follower on the x axis, the cam as it stands where the programme
begins.

With d(θ) the distance of the follower from the cam's centre, two on opposite sides touch one cam at every
angle if the cam has the same diameter

.. math:: d(\theta) + d(\theta + \pi) = b

at every angle (points and rollers: diameter of the pitch curve; flat faces: breadth, d the support
function). So the lift over the second half of the revolution must be that of the first, mirrored: s(θ + π) =
h − s(θ).

References
----------
.. [1] Paper 2, equations (17) to (22): ρ(φ) + ρ(φ + π) = b.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from linkwright.cam.core import CamKernel, CamOffset, Extreme, cam_kernel
from linkwright.cam.laws.motion_law import MotionLaw, Side, combined
from linkwright.cam.model.cam import Cam
from linkwright.cam.model.follower import Sizes, sizes, start_of, to_arm_pivot
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import AssemblyError, ShapeError
from linkwright.kernel.numerics.tangent import cos, primal
from linkwright.linkages.model.element import FixedPoint
from linkwright.linkages.model.topology import ORIGIN


@dataclass(frozen=True)
class Contact:
    """A follower that touches a cam."""

    name: str  # ``"cam"``, or ``"second cam"`` for the second of two contacts
    law: MotionLaw  # lift over the cam angle, minimum value zero [m or rad]
    sizes: Sizes
    kernel: CamKernel  # the same in the core
    start: Any  # place of the follower at zero lift: from the cam's centre [m], or angle of the arm [rad]
    turned: float = 0.0  # angle of the contact's frame against that of the first [rad]


@dataclass(frozen=True)
class CamCurve:
    """A closed curve beside the pitch curve, in its contact's frame."""

    contact: Contact
    away: float  # distance from the pitch curve, outwards [m]

    @property
    def breaks(self) -> tuple[float, ...]:
        """Cam angles between which it is smooth [rad]."""
        return self.contact.law.breaks

    def points(self, phi: Floats, side: Side = "after") -> Floats:
        """Places. ``phi`` (n,): cam angles from the start of the programme [rad] → [m], (n, 2)."""
        return self._at(phi, side).place.T

    def tangents(self, phi: Floats, side: Side = "after") -> Floats:
        """First derivatives by the cam angle. ``phi`` (n,): cam angles [rad] → [m/rad], (n, 2)."""
        return self._at(phi, side).d1.T

    def seconds(self, phi: Floats, side: Side = "after") -> Floats:
        """Second derivatives by the cam angle. ``phi`` (n,): cam angles [rad] → [m/rad²], (n, 2)."""
        return self._at(phi, side).d2.T

    def _at(self, phi: Floats, side: Side) -> CamOffset:
        return self.contact.kernel.curve(phi, self.away, before=side == "before")


class Touch(NamedTuple):
    """Where a follower touches its cam, in the ground's frame."""

    pitch: Floats  # (n, 2): centre of the roller, the edge, or the point of contact under a flat face [m]
    normal: Floats  # (n, 2): unit normal away from the cam: the way the cam pushes


def touch(cam: Cam, contact: Contact, points: dict[str, FixedPoint], crank_angle: Floats) -> Touch:
    """Where a follower touches its cam at crank angles (n,) [rad]: places and normals."""
    angle = crank_angle - cam.phase
    rows = contact.kernel.rows(np.mod(angle, 2 * np.pi))
    turned = frame_angle(cam, points) + contact.turned + turned_by(cam, angle)
    pitch = np.stack(centre_of(cam, points)) + _turned(rows["pitch_x"], rows["pitch_y"], turned)
    return Touch(pitch, _turned(rows["normal_x"], rows["normal_y"], turned))


def centre_of(cam: Cam, points: dict[str, FixedPoint]) -> tuple[Any, Any]:
    """Place of the cam's centre, x and y [m]."""
    centre = points.get(cam.pivot or ORIGIN)
    return (0.0, 0.0) if centre is None else (centre.x, centre.y)


def frame_angle(cam: Cam, points: dict[str, FixedPoint]) -> Any:
    """Direction of the first contact's x axis on the ground [rad]."""
    if not cam.is_oscillating:
        return cam.direction
    return np.arctan2(*to_arm_pivot(cam, points)[::-1])


def turned_by(cam: Cam, angle: Floats) -> Floats:
    """Angle by which a cam has turned when the crankshaft has, (n,) [rad]."""
    return -angle if cam.rotation == "opposite" else angle


def _turned(x: Floats, y: Floats, angle: Floats) -> Floats:
    """Vectors turned by angles, (n, 2)."""
    sin, cos = np.sin(angle), np.cos(angle)
    return np.stack((cos * x - sin * y, sin * x + cos * y), axis=-1)


# Kinds of entries of one machine: nearly all.
_PLAIN = frozenset((float, int, str, bool, type(None)))


def contacts(cam: Cam, points: dict[str, FixedPoint], name: str = "cam") -> tuple[Contact, ...]:
    """The one or two contacts of a cam; `name` for errors.

    Raises `AssemblyError` if the second follower does not reach its cam, `ShapeError` for dimensions that
    vary from machine to machine.
    """
    size = sizes(cam, points)
    if any(
        type(dimension) not in _PLAIN and np.ndim(dimension)
        for dimension in (*size, *(value for _, value in cam if not isinstance(value, tuple)))
    ):
        raise ShapeError(
            f"the profile of cam {name} is that of one machine, and the entries describe several"
        )
    first = _contact("cam", cam, cam.lift, size, left=cam.side == "left")
    if cam.has_opposite:
        return first, _contact("second follower", cam, falling(cam), size, turned=np.pi)
    if cam.closure == "conjugate":
        return first, _conjugate(cam, first, name)
    return (first,)


def falling(cam: Cam) -> MotionLaw:
    """Lift of a follower on the other side: the stroke less that of the first."""
    return cam.lift.scaled(-1.0, cam.stroke)


def _contact(
    name: str, cam: Cam, law: MotionLaw, size: Sizes, *, left: bool = True, turned: float = 0.0
) -> Contact:
    kernel = cam_kernel(
        law,
        size,
        oscillating=cam.is_oscillating,
        roller=cam.is_roller,
        opposite=cam.rotation == "opposite",
        left=left,
    )
    return Contact(name, law, size, kernel, start_of(cam, size), turned)


def _conjugate(cam: Cam, first: Contact, name: str) -> Contact:
    """Second cam of a conjugate pair; its base circle follows from the distance of the followers."""
    second = cam.second
    assert second is not None
    roller = second.roller_radius or first.sizes.roller_radius
    roller = roller if cam.contact == "roller" else 0.0
    if cam.is_oscillating:
        arm = second.arm_length or first.sizes.arm
        start = (second.angle or 0.0) - first.start - cam.stroke
        a = first.sizes.distance
        prime = np.sqrt(a**2 + arm**2 - 2 * a * arm * np.cos(start)) if start > 0 else -1.0
        size = first.sizes._replace(base_radius=prime - roller, roller_radius=roller, arm=arm)
        turned = 0.0
    else:
        start = (second.distance or 0.0) - first.start - cam.stroke
        prime = np.hypot(start, first.sizes.offset) if start > 0 else -1.0
        size = first.sizes._replace(
            base_radius=prime - roller, roller_radius=roller, offset=-first.sizes.offset
        )
        turned = np.pi
    if size.base_radius <= 0:
        least = first.start + cam.stroke + (0.0 if cam.is_oscillating else roller)
        key, unit = ("angle", "rad") if cam.is_oscillating else ("distance", "m")
        raise AssemblyError(
            f"the second follower of {name} leaves no room for its cam: "
            f"mechanism.cams.{name}.second.{key} must be more than {least:.6g} {unit}",
            element=name,
            crank_angle=cam.phase,
        )
    return _contact("second cam", cam, falling(cam), size, left=cam.side != "left", turned=turned)


# Share of the breadth within which it counts as constant: each of the two lifts is good to some units of
# rounding.
_CONSTANT = 1e-12


@dataclass(frozen=True)
class Opposite:
    """The diameter of a cam between two followers."""

    breadth: float  # distance of the followers [m]
    diameter: MotionLaw  # distance of two followers that touch the cam, over half a revolution [m]
    least: Extreme
    greatest: Extreme

    @property
    def is_constant(self) -> bool:
        """Whether both touch at every angle, within rounding."""
        apart = max(abs(self.least.value - self.breadth), abs(self.greatest.value - self.breadth))
        return apart <= _CONSTANT * self.breadth


def opposite(cam: Cam, contact: Contact) -> Opposite:
    """The diameter over the revolution, with its extremes located exactly."""
    factor: Any = 1.0 if cam.is_roller else cos(cam.face_tilt)
    place = contact.law.scaled(factor, contact.start * factor)
    both = combined((1.0, place), (1.0, place.shifted(np.pi)))
    least, greatest = both.extremes()
    breadth = cam.breadth if cam.breadth is not None else 2 * contact.start + cam.stroke
    return Opposite(
        primal(breadth * factor),
        both,
        Extreme(least.at % np.pi, primal(least.value)),
        Extreme(greatest.at % np.pi, primal(greatest.value)),
    )
