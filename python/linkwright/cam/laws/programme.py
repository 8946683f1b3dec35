"""A programme: sections one after the other over one revolution of the cam, and how smoothly they meet.

What a section does not say of its ends follows from its neighbours: a dwell rests, constant velocity has its
slope, and what one side of a joint says counts for both. What nobody says is rest.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from linkwright.cam.laws.boundary import Boundary, or_none
from linkwright.cam.laws.motion_law import MotionLaw, joined
from linkwright.cam.laws.piece import Piece
from linkwright.kernel.errors import InputError
from linkwright.kernel.numerics.tangent import Tangent, primal, total

TURN = 2 * math.pi

# Angles add to a revolution, and lifts to zero, within this share; what is left of it is shared out.
CLOSES = 1e-9

# A jump below this share of the maximum value of its derivative is rounding.
_ROUNDING = 1e-9

# Orders of the derivatives whose jumps are stated.
ORDERS = 5
NAMES = ("lift", "velocity", "acceleration", "jerk", "fourth derivative")


@dataclass(frozen=True)
class Section:
    """One section of a programme.

    Attributes
    ----------
    angle : float
        Of the cam over the section [rad].
    lift : float
        Change over the section [m or rad].
    shape : callable or None
        Gives x(z) of the task; None for a dwell.
    steady : bool
        Whether its velocity is constant.
    velocity_start, velocity_end : float or None
        First derivative by the cam angle at the ends [m or rad, per rad]; None if it says nothing.
    acceleration_start, acceleration_end : float or None
        Second derivative at the ends [m or rad, per rad²]; None if it says nothing.
    """

    angle: float
    lift: float = 0.0
    shape: Callable[[Boundary], MotionLaw] | None = None
    steady: bool = False
    velocity_start: float | None = None
    velocity_end: float | None = None
    acceleration_start: float | None = None
    acceleration_end: float | None = None

    def velocity(self, end: str) -> float | None:
        """What it says of its velocity at its start or its end."""
        if self.shape is None:
            return 0.0
        said: float | None = getattr(self, f"velocity_{end}")
        return self.lift / self.angle if self.steady else said

    def acceleration(self, end: str) -> float | None:
        """What it says of its acceleration; a dwell and constant velocity leave it to their neighbours."""
        said: float | None = getattr(self, f"acceleration_{end}")
        return None if self.steady or self.shape is None else said


@dataclass(frozen=True)
class Joint:
    """Where two sections meet.

    Attributes
    ----------
    angle : float
        Cam angle [rad].
    jumps : tuple of float
        Jump of each derivative from order 0 to 4, from the section before to the one after [m or rad, per
        rad to the order]; zero where it is continuous.
    """

    angle: float
    jumps: tuple[float, ...]

    @property
    def order(self) -> int:
        """Order of the highest derivative up to which all are continuous; −1 if the lift itself jumps."""
        return next((i for i, jump in enumerate(self.jumps) if jump), len(self.jumps)) - 1

    def words(self, unit: str = "m") -> str:
        """How smooth it is, such as "continuous up to the acceleration; the jerk jumps by 0.2 m/rad³"."""
        n = self.order + 1
        if n == len(self.jumps):
            return f"continuous up to the {NAMES[-1]}"
        per = ("", "/rad", "/rad²", "/rad³", "/rad⁴")[n]
        jump = f"the {NAMES[n]} jumps by {self.jumps[n]:.4g} {unit}{per}"
        return f"continuous up to the {NAMES[n - 1]}; {jump}" if n else jump


@dataclass(frozen=True)
class Programme:
    """The motion of a follower over one revolution of the cam.

    Attributes
    ----------
    law : MotionLaw
        Lift over the cam angle from 0 to exactly 2π, beginning and ending with 0.
    joints : tuple of Joint
        At the start of each section; the first is where the revolution closes.
    tasks : tuple of Boundary
        What each section had to do, by its own z.
    """

    law: MotionLaw
    joints: tuple[Joint, ...]
    tasks: tuple[Boundary, ...]


def programme(sections: Sequence[Section]) -> Programme:
    """The programme of sections in their order, closed.

    What rounding leaves of the revolution is shared by all angles in proportion, and what it leaves of the
    lift is taken from the largest lift. Raises `InputError` if angles or lifts do not close, `LawError` if a
    law cannot meet its boundary values.
    """
    closed = _closed(sections)
    tasks = boundaries(closed)
    ends = [total(section.angle for section in closed[:i]) for i in range(len(closed))] + [TURN]
    laws = []
    for i, (section, task) in enumerate(zip(closed, tasks, strict=True)):
        start = total(section.lift for section in closed[:i])
        law = section_law(section, task).scaled(1.0, start)
        laws.append(law.placed(ends[i], ends[i + 1] - ends[i]))
    law = joined(laws)
    full = MotionLaw((*law.breaks[:-1], TURN), law.pieces)
    return Programme(full, joints(full.primal, list(map(primal, ends[:-1]))), tuple(tasks))


def section_law(section: Section, task: Boundary) -> MotionLaw:
    """x(z) of one section, from 0 to 1, beginning with 0; a dwell stays at 0."""
    dwell = MotionLaw((0.0, 1.0), (Piece((0.0,)),))
    return dwell if section.shape is None else section.shape(task)


def boundaries(sections: Sequence[Section]) -> list[Boundary]:
    """What each section has to do, by its own z."""
    tasks = []
    for i, here in enumerate(sections):
        before, after = sections[i - 1], sections[(i + 1) % len(sections)]
        velocities = [
            or_none(_said(here.velocity(a), other.velocity(b))) for a, other, b in _ends(before, after)
        ]
        bends = [_said(here.acceleration(a), other.acceleration(b)) for a, other, b in _ends(before, after)]
        tasks.append(
            Boundary(
                here.lift,
                *(v * here.angle for v in velocities),
                *(None if a is None else a * here.angle**2 for a in bends),
            )
        )
    return tasks


def joints(law: MotionLaw, places: Sequence[float]) -> tuple[Joint, ...]:
    """How smooth a periodic law is at some of its breaks."""
    jumps = []
    for order in range(ORDERS):
        after = law.at(np.array(places), order, "after")
        before = law.at(np.array([law.end if x == law.start else x for x in places]), order, "before")
        u = np.linspace(0.0, 1.0, 9)
        scale = max(float(np.abs(piece.at(u)).max()) for piece in law.derivative(order).pieces)
        jump = after - before
        jumps.append(np.where(np.abs(jump) > _ROUNDING * scale, jump, 0.0))
    columns = np.array(jumps).T.tolist()
    return tuple(Joint(float(x), tuple(row)) for x, row in zip(places, columns, strict=True))


def _ends(before: Section, after: Section) -> tuple[tuple[str, Section, str], ...]:
    """Each end of a section with the neighbour there and the neighbour's end."""
    return (("start", before, "end"), ("end", after, "start"))


def _said(own: float | None, other: float | None) -> float | None:
    """What a section says of its end, else what its neighbour says."""
    return other if own is None else own


def _closed(sections: Sequence[Section]) -> list[Section]:
    """The sections with what rounding leaves of revolution and lift shared out."""
    turn = total(section.angle for section in sections)
    left = total(section.lift for section in sections)
    largest = max(range(len(sections)), key=lambda i: abs(sections[i].lift))
    if abs(turn - TURN) > CLOSES * TURN:
        raise InputError(
            f"the angles of a programme add to {math.degrees(primal(turn)):.10g}°, expected 360°"
        )
    if abs(left) > CLOSES * abs(sections[largest].lift):
        raise InputError(f"the lifts of a programme add to {left:.10g}, expected 0")
    closed = [replace(section, angle=section.angle * TURN / turn) for section in sections]
    if isinstance(left, Tangent):
        # Of a lift that an entry changes alone, all give way in proportion to their sizes.
        lifts: Any = sum(abs(section.lift) for section in sections)
        rest: Any = Tangent(0.0, left.d)
        shares = [primal(abs(section.lift) / lifts) if lifts else 0.0 for section in sections]
        closed = [
            replace(section, lift=section.lift - share * rest)
            for section, share in zip(closed, shares, strict=True)
        ]
        left = left.value
    if left:
        closed[largest] = replace(closed[largest], lift=closed[largest].lift - left)
    return closed
