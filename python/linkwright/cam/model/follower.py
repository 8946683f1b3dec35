"""The follower of a cam in the mechanism: its place at zero lift, and the driver that stands for the cam."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np
from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.cam.model.cam import Cam
from linkwright.kernel.description.base import fault
from linkwright.kernel.units.kinds import LENGTH
from linkwright.linkages.model.element import Crank, FixedPoint, Guide, LinearDriver

if TYPE_CHECKING:
    from linkwright.linkages.model.mechanism import Mechanism


class Sizes(NamedTuple):
    """Dimensions of a cam as the core has them; each a number or an array over many cams."""

    # base_radius, roller_radius, offset, distance, arm: [m].
    base_radius: Any
    roller_radius: Any
    offset: Any
    distance: Any
    arm: Any
    tilt: Any  # [rad]


class TranslatingFollower(LinearDriver):
    """A driver that follows a cam along a line."""

    pushed: ClassVar[bool] = True
    cam: Cam = Field(description="The cam.")

    def follows(self) -> Cam:
        """The cam that it follows."""
        return self.cam


class OscillatingFollower(Crank):
    """A driver that follows a cam about a pivot."""

    pushed: ClassVar[bool] = True
    cam: Cam = Field(description="The cam.")
    turn: float = Field(description="Sense of the angle as the lift grows: -1 for an arm to the left.")

    def follows(self) -> Cam:
        """The cam that it follows."""
        return self.cam


def sizes(cam: Cam, points: Mapping[str, FixedPoint]) -> Sizes:
    """Dimensions of a cam with its follower."""
    distance: Any = 0.0
    if cam.is_oscillating:
        dx, dy = to_arm_pivot(cam, points)
        distance = np.hypot(dx, dy)
    arm = 0.0 if cam.arm_length is None else cam.arm_length
    return Sizes(cam.base, cam.radius_of_roller, cam.offset, distance, arm, cam.face_tilt)


def to_arm_pivot(cam: Cam, points: Mapping[str, FixedPoint]) -> tuple[Any, Any]:
    """From the cam's centre to the follower's pivot, (rows,) [m]."""
    centre, pivot = points.get(cam.pivot or "O"), points[cam.arm_pivot or ""]
    x, y = (0.0, 0.0) if centre is None else (centre.x, centre.y)
    return pivot.x - x, pivot.y - y


def start_of(cam: Cam, size: Sizes) -> Any:
    """Place of the follower at zero lift; NaN where there is none [m or rad]."""
    prime = size.base_radius + size.roller_radius
    with np.errstate(invalid="ignore", divide="ignore"):
        if cam.is_oscillating:
            a, arm = size.distance, size.arm
            if cam.is_roller:
                return np.arccos((a**2 + arm**2 - prime**2) / (2 * a * arm))
            return np.arcsin((size.base_radius + size.offset) / a)
        if cam.is_roller:
            return np.sqrt(prime**2 - size.offset**2)
        return size.base_radius / np.cos(size.tilt)


def follower_of(cam: Cam, points: Mapping[str, FixedPoint]) -> LinearDriver | Crank:
    """The driver that a cam is in the mechanism, unchecked: its numbers may be arrays."""
    size = sizes(cam, points)
    start = start_of(cam, size)
    if not cam.is_oscillating:
        guide = Guide.model_construct(through=cam.pivot, on=None, angle=cam.direction, offset=cam.offset)
        return TranslatingFollower.model_construct(
            guide=guide, start=start, per_turn=None, law=None, constants={}, advance=None, cam=cam
        )
    dx, dy = to_arm_pivot(cam, points)
    turn = -1.0 if cam.side == "left" else 1.0
    phase = np.arctan2(dy, dx) + np.pi + turn * start
    radius = size.distance if cam.arm_length is None else cam.arm_length
    return OscillatingFollower.model_construct(
        radius=radius,
        phase=phase,
        pivot=cam.arm_pivot,
        law=None,
        constants={},
        advance=None,
        cam=cam,
        turn=turn,
    )


def cam_place_faults(mechanism: Mechanism) -> Iterator[InitErrorDetails]:
    """Cams of a mechanism without other faults whose follower does not reach them.

    An offset beyond the prime circle; an arm too short or too long for the base circle, or on its centre.
    """
    points = mechanism.fixed_points()
    for name, cam in mechanism.cams.items():
        size = sizes(cam, points)
        if cam.is_oscillating and np.min(size.distance) < LENGTH.least:
            expected = "another place than the cam's centre"
            yield fault("cams", name, "arm_pivot", found=cam.arm_pivot, expected=expected)
            continue
        start = start_of(cam, size)
        if np.isnan(start).any() or (not cam.is_oscillating and np.any(start <= 0)):
            yield from _unreached(name, cam, size)


def _unreached(name: str, cam: Cam, size: Sizes) -> Iterator[InitErrorDetails]:
    if not cam.is_oscillating:
        prime = size.base_radius + size.roller_radius
        least = np.max(np.abs(size.offset) - size.roller_radius)
        remedy = f"make base_radius larger than {least:.6g} m or the offset smaller"
        expected = f"less than base_radius + roller_radius, {np.min(prime):.6g} m"
        yield fault("cams", name, "offset", found=cam.offset, expected=expected, remedy=remedy)
    elif cam.is_roller:
        low = abs(size.distance - size.arm) - size.roller_radius
        high = size.distance + size.arm - size.roller_radius
        expected = f"between {low:.6g} and {high:.6g} m"
        remedy = f"the arm of {size.arm:.6g} m has its pivot {size.distance:.6g} m from the cam"
        yield fault("cams", name, "base_radius", found=cam.base, expected=expected, remedy=remedy)
    elif size.offset >= size.distance:
        expected = f"less than {size.distance:.6g} m, the distance of the follower's pivot from the cam"
        yield fault("cams", name, "offset", found=cam.offset, expected=expected)
    else:
        expected = f"at most {size.distance - size.offset:.6g} m, or the pivot farther away"
        yield fault("cams", name, "base_radius", found=cam.base, expected=expected)
