"""Motion generation: a linkage whose coupler passes through two or three given poses.

A point a of the body is at Z_i = p_i + a e^{iθ_i} in pose i. A link can hold it if its places lie on a circle
about the link's fixed pivot. Of three places this circle is the only one; of two, any point on their
mid-normal is a centre, and the angle that the link turns through chooses it.

Source: Hartenberg, Denavit, Kinematic Synthesis of Linkages, 1964; Erdman, Sandor, Mechanism Design: Analysis
and Synthesis: two and three prescribed positions by geometric construction.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np

from linkwright.kernel.arrays import Complexes, Floats
from linkwright.kernel.errors import SynthesisError
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.linkages.kinematics import motions
from linkwright.machine.machine import Machine
from linkwright.synthesis.four_bar import FourBar, cross, side_of
from linkwright.synthesis.slider_pose import guide_slider
from linkwright.synthesis.task import FixedPivot, MovingPoint, PoseTask
from linkwright.synthesis.verification import (
    TransmissionResult,
    least_transmission,
    listed,
    require_met,
    travel,
    way,
)

# Three places whose triangle is flatter than this lie on a straight line: the circle through them is a
# million times larger than they are apart.
_FLAT = 1e-6

# Places nearer than this share of the poses' extent are one place.
_SAME = 1e-9

SOURCE = "Synthesised by linkwright for given poses"


@dataclass(frozen=True)
class PoseGuide(TransmissionResult):
    """A linkage whose coupler passes through given poses."""

    remedy: ClassVar[str] = "choose other points of the body"

    linkage: Annotated[str, About('``"four-bar"`` or ``"slider-crank"``.')]
    type: Annotated[str, About("Which links turn fully.")]
    frame: Annotated[float | None, Label("length of the frame", "", "m", "Of a four-bar.")]
    crank: Annotated[float, Label("length of the crank", "", "m")]
    coupler: Annotated[float, Label("length of the coupler", "", "m")]
    rocker: Annotated[float | None, Label("length of the rocker", "", "m", "Of a four-bar.")]
    offset: Annotated[float | None, Label("offset of the guide", "", "m", "Of a slider-crank.")]
    direction: Annotated[str, About("In which the crank turns through the poses.")]
    transmission_angle_min: Annotated[
        float, Label("minimum transmission angle", "μ_min", "rad", "From the first pose to the last.")
    ]
    pose_error: Annotated[
        float,
        Label("maximum position error of the body's origin", "", "m", "In the machine analysed again."),
    ]
    angle_error: Annotated[
        float, Label("maximum deviation of the body's rotation", "", "rad", "From pose to pose.")
    ]
    crank_angles: Annotated[Floats, Label("crank angles of the poses", "", "rad")]
    machine: Annotated[Machine, About("The linkage; its point ``P`` is the body's origin.")]


@public
def pose_guide(task: PoseTask) -> PoseGuide:
    """Find the linkage whose coupler passes through given poses.

    Parameters
    ----------
    task : PoseTask
        Two or three poses, and the points of the body at which links hold it.

    Returns
    -------
    PoseGuide
        The linkage, verified by analysing it again.

    Raises
    ------
    SynthesisError
        A centre at infinity, poses on different branches or circuits, or met in another order.

    References
    ----------
    .. [1] Hartenberg, Denavit, Kinematic Synthesis of Linkages, 1964.
    """
    task = with_moving_points(task)
    assert task.crank_point is not None
    places = body_places(task, task.crank_point)
    crank_pivot = centre(places, task.crank_point, "crank_point")
    if task.linkage == "slider-crank":
        return _slider_guide(task, places, crank_pivot)
    return _rocker_guide(task, places, crank_pivot)


def body_places(task: PoseTask, point: MovingPoint) -> Complexes:
    """Places of a point of the body in the poses, (n,) [m]."""
    poses = task.poses
    origin = np.asarray(poses.x) + 1j * np.asarray(poses.y)
    return origin + complex(point.x, point.y) * np.exp(1j * np.asarray(poses.angle))


def with_moving_points(task: PoseTask) -> PoseTask:
    """Points of the body for given pivots: seen from the body, three places of a pivot are on a circle."""
    points = {
        f"{name}_point": _pin_about(task, pivot, f"{name}_pivot")
        for name, pivot in (("crank", task.crank_pivot), ("rocker", task.rocker_pivot))
        if pivot is not None
    }
    return task.model_copy(update=points) if points else task


def _pin_about(task: PoseTask, pivot: FixedPivot, key: str) -> MovingPoint:
    """The point of the body that keeps its distance from a fixed pivot in three poses."""
    poses = task.poses
    from_origin = complex(pivot.x, pivot.y) - (np.asarray(poses.x) + 1j * np.asarray(poses.y))
    seen: Complexes = from_origin * np.exp(-1j * np.asarray(poses.angle))
    reach = np.abs(seen - seen.mean()).max()
    if reach <= _SAME * max(1e-3, np.abs(seen).max()):
        raise SynthesisError(f"{key}: the body only turns about this pivot; choose another one")
    u, v = seen[1] - seen[0], seen[2] - seen[0]
    if abs(cross(u, v)) <= _FLAT * reach**2:
        raise SynthesisError(
            f"{key}: seen from the body, this pivot moves along a straight line, so that its pin is "
            "infinitely far; choose another pivot"
        )
    pin = _circumcentre(seen)
    return MovingPoint(x=pin.real, y=pin.imag)


def _circumcentre(places: Complexes) -> complex:
    u, v = places[1] - places[0], places[2] - places[0]
    return complex(places[0] + 1j * (v * abs(u) ** 2 - u * abs(v) ** 2) / (-2 * cross(u, v)))


def centre(places: Complexes, point: MovingPoint, key: str) -> complex:
    """Centre of the circle through the places of a point.

    `places` (n,): two or three places [m]; `point`: the point; the rotation of its link chooses the centre of
    two places. Returns: the centre [m]. Raises SynthesisError: places that coincide, or lie on a straight
    line.
    """
    reach = np.abs(places - places.mean()).max()
    apart = min(abs(places[i] - places[i - 1]) for i in range(len(places)))
    if apart <= _SAME * max(1e-3, np.abs(places).max()):
        raise SynthesisError(
            f"{key} is at the same place in two poses, ({places[0].real:.6g}, {places[0].imag:.6g}) m: it "
            "may be a fixed pivot, not a crank pin; choose another point of the body"
        )
    if len(places) == 2:
        assert point.turn is not None
        chord = places[1] - places[0]
        return complex(places.mean() + 0.5j * chord / np.tan(0.5 * point.turn))
    u, v = places[1] - places[0], places[2] - places[0]
    area = cross(u, v)
    if abs(area) <= _FLAT * reach**2:
        raise SynthesisError(
            f"the three places of {key} lie on a straight line to {abs(area) / (2 * reach):.3g} m, so the "
            "centre of its link "
            'is infinitely far; choose another point of the body, or a slider (linkage = "slider-crank")'
        )
    return _circumcentre(places)


def _rocker_guide(task: PoseTask, pins: Complexes, crank_pivot: complex) -> PoseGuide:
    assert task.rocker_point is not None
    joints = body_places(task, task.rocker_point)
    rocker_pivot = centre(joints, task.rocker_point, "rocker_point")
    if abs(joints[0] - pins[0]) <= _SAME * np.abs(pins[0] - crank_pivot):
        raise SynthesisError("crank_point and rocker_point are one point; choose two different points")
    if abs(rocker_pivot - crank_pivot) <= _SAME * abs(pins[0] - crank_pivot):
        raise SynthesisError(
            "both fixed pivots fall on one place: the body only turns about it; choose other points of the "
            "body"
        )
    sides = [side_of(a, rocker_pivot, b) for a, b in zip(pins, joints, strict=True)]
    if len(set(sides)) > 1:
        raise SynthesisError(
            f"the poses lie on different branches: the joint is on the {', '.join(sides)} of the line from "
            "pin to rocker pivot in turn, and the linkage must be taken apart between them; choose other "
            "points of the body"
        )
    bar = FourBar(
        crank_pivot,
        rocker_pivot,
        abs(pins[0] - crank_pivot),
        abs(joints[0] - pins[0]),
        abs(joints[0] - rocker_pivot),
        sides[0],
        float(np.angle(pins[0] - crank_pivot)),
    )
    angles = _travelled(task, bar.gap, pins, crank_pivot, f"a {bar.type}")
    origin = (body_origin(task) - pins[0]) / np.exp(1j * np.angle(joints[0] - pins[0]))
    machine = bar.machine(task.name or "Four-bar through poses", points={"P": origin}, source=SOURCE)
    mu = least_transmission(bar.transmission_angle, angles[0], angles[-1])
    errors = _errors(task, machine, angles, "B.coupler")
    lengths = (bar.frame, bar.crank, bar.coupler, bar.rocker, None)
    return PoseGuide("four-bar", bar.type, *lengths, way(angles), mu, *errors, angles, machine)


def _slider_guide(task: PoseTask, pins: Complexes, crank_pivot: complex) -> PoseGuide:
    guide = guide_slider(task, pins, crank_pivot)
    angles = _travelled(task, guide.gap, pins, crank_pivot, "a slider-crank")
    origin = (body_origin(task) - pins[0]) / np.exp(1j * np.angle(guide.slider - pins[0]))
    machine = guide.machine(task.name or "Slider-crank through poses", origin, SOURCE)
    mu = least_transmission(guide.transmission_angle, angles[0], angles[-1])
    errors = _errors(task, machine, angles, "B.rod")
    lengths = (None, guide.crank, guide.rod, None, guide.offset)
    return PoseGuide("slider-crank", guide.type, *lengths, way(angles), mu, *errors, angles, machine)


def body_origin(task: PoseTask) -> complex:
    """Place of the body's origin in the first pose [m]."""
    return complex(task.poses.x[0], task.poses.y[0])


def _travelled(
    task: PoseTask, gap: Callable[[Floats], Floats], pins: Complexes, pivot: complex, what: str
) -> Floats:
    """Crank angles of the poses from zero on, in the direction that passes them in order."""
    directions = np.angle(pins - pivot)
    angles = travel(
        gap, list(directions - directions[0]), task.crank_point.turn if task.crank_point else None
    )
    if angles is None:
        raise SynthesisError(
            f"{what} meets the poses at crank directions {listed(directions)}, and can be driven through "
            "them in order in neither direction: it does not close in between; choose other points of the "
            "body"
        )
    return angles


def _errors(task: PoseTask, machine: Machine, angles: Floats, link: str) -> tuple[float, float]:
    """Errors of the analysed machine in the poses, of place [m] and rotation [rad]; a finding if large."""
    table = motions(machine, angles, points=["P"], links=[link])[0]
    place = np.abs(table[0] + 1j * table[1] - np.asarray(task.poses.x) - 1j * np.asarray(task.poses.y))
    turned = (table[6] + 1j * table[7]) * np.exp(-1j * np.asarray(task.poses.angle))
    error, turning = float(place.max()), float(np.abs(np.angle(turned / turned[0])).max())
    assert task.crank_point is not None
    extent = np.abs(body_places(task, task.crank_point) - body_origin(task)).max()
    require_met("a distance of the body from its poses", 0.0, error, "m", size=float(extent))
    require_met("a turning of the body off its poses", 0.0, turning, "rad", size=1.0)
    return error, turning
