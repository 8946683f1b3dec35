"""What must be known of the motion before the first revolution: sides, branches, change points, starts.

| pending | is found by |
| --- | --- |
| side of a joint given by its place | where that lies when the mechanism is assembled |
| continuous angle of a link | its turns per revolution of the crank, and the middle of its swing about them |
| change points of a dyad | the radicand's zeros, found exactly, and its series there |
| start of a group | its motion, followed step by step over the revolution |

They are settled in build order, each with what stands before it.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from linkwright import _core
from linkwright.kernel.arrays import Floats, Integers
from linkwright.kernel.errors import AssemblyError, InputError
from linkwright.kernel.numerics.tangent import primal
from linkwright.machine.program.change_points import folding, in_line, stored, undecided, undecided_error
from linkwright.machine.program.mechanism import MechanismProgram
from linkwright.machine.program.motion import WIDTHS, link_motion, motion, point_motion
from linkwright.machine.program.numbers import table
from linkwright.machine.program.places import Continuous, Foldable, Pending, PendingGroup, Side
from linkwright.machine.program.smooth_laws import LOOK, gap_in_law

# First row of all parameters, which of them vary, and their values over the rows.
Columns = tuple[Floats, Integers, Floats]


# Largest swing of a link about its mean turning that leaves its angle unambiguous, in radians.
_SWING_MAX = 1.98 * np.pi

# Crank angle at which the side of a rocker or a slider is given [rad]: just after zero, where it may have a
# change point.
_JUST_AFTER = 1e-7

# A joint's place this near to the line of its bars, over their length, says nothing of its side.
_IN_LINE = 1e-9

# Places of a joint closer than this, over the farthest place of its group, are one.
_SAME_PLACE = 1e-6

# A whole number of revolutions is one to this.
_WHOLE = 1e-6

# Most revolutions after which a link is looked for to be back, at angles whose differences no symmetry hides
# [rad], and the difference of directions that is rounding.
_CYCLE_MAX, _REPEATS = 24, 1e-9
_UNEVEN = np.array([0.317, 1.291, 2.053, 3.371, 4.423, 5.687])

# Difference in length of a redundant bar, over its length, that counts as rounding.
_FITS = 1e-9


class InitialAssembly:
    """Elements and numbers of a mechanism with everything pending filled in."""

    def __init__(self, program: MechanismProgram, columns: Columns, plan: Callable[[], _core.Plan]) -> None:
        self.program = program
        # Numbers beyond these are not described but found here.
        self.n_described = len(program.parameters)
        self.parameters, self.slots, self.values = columns
        self.make_plan = plan
        self.assembled_at = program.mechanism.assembled_at
        self.plan = plan()
        # Crank angle at which the side of a dyad is given, by the slot of its sign; others just after zero.
        self.given_at: dict[int, float] = {}
        # Machines in which a dyad passes an odd number of change points: their motion takes two revolutions.
        self.odd = np.zeros(1, dtype=np.bool_)
        # What is wrong with the first law that has no value at some crank angles.
        self.law_gap: AssemblyError | None = None

    def run(self) -> None:
        """Settles all that is pending, in build order.

        Raises `AssemblyError` if a law cannot be followed, a group does not close where it is assembled, a
        link turns irregularly, or a redundant bar does not fit.
        """
        self._check_laws()
        try:
            for pending in self.program.pending:
                self._fill_in(pending)
            self._check_redundant()
        except AssemblyError as error:
            # What hangs on a law cannot be followed where that has no value.
            raise (self.law_gap or error) from None

    def _fill_in(self, pending: Pending) -> None:
        match pending:
            case Side():
                self._side(pending)
            case Continuous():
                self._continuous(pending)
            case Foldable():
                self._fold(pending)
            case PendingGroup():
                self._follow(pending)

    def _check_laws(self) -> None:
        """A driver's law must have values, and no jump; where it has none is known from then on."""
        for name, driver in self.program.mechanism.laws().items():
            assert driver.law is not None
            gap = gap_in_law(name, driver.law, partial(self._law, self.program.slides[f"{name}.law"]))
            self.law_gap = self.law_gap or gap

    def _law(self, slide: int, angles: Floats) -> Floats:
        """Value and slope of a law, (2, n)."""
        (law,) = motion(self.plan, self.parameters, [_core.Channel.Slide(slide)], angles)
        return np.stack(law[:2])

    def _changed(self, plan: _core.Plan) -> None:
        """Goes on with another plan."""
        self.plan = plan

    def _place(self, point: int, angles: Floats) -> Floats:
        """Place of a point, (2, n)."""
        return point_motion(self.plan, self.parameters, point, angles).place

    def _direction(self, link: int, angles: Floats) -> Floats:
        """Cosine and sine of a link's angle, (2, n)."""
        return link_motion(self.plan, self.parameters, link, angles).direction

    # -- sides -------------------------------------------------------------------------------------------

    def _side(self, pending: Side) -> None:
        """Left of the line from pin to pivot, or ahead along the guide; each machine by itself."""
        x, y = self._assembled(_core.Channel.Point(pending.pin))[:2]
        to = np.stack([column - pin for column, pin in zip(self._drawn(pending.joint), (x, y), strict=True)])
        if pending.pivot is not None:
            u, v = self._assembled(_core.Channel.Point(pending.pivot))[:2] - (x, y)
            side = (u * to[1] - v * to[0]) / np.maximum(np.hypot(u, v), 1e-300)
        else:
            assert pending.guide is not None
            link, angle = pending.guide
            cos, sin = (1.0, 0.0) if link is None else self._assembled(_core.Channel.Link(link))[:2]
            side = (cos * np.cos(angle) - sin * np.sin(angle)) * to[0]
            side += (sin * np.cos(angle) + cos * np.sin(angle)) * to[1]
        is_known = np.abs(side) > _IN_LINE * np.hypot(*to)
        if not is_known[0]:
            raise AssemblyError(
                f"the joint {pending.joint} lies in line with the points that hold it, so its assembly "
                "mode is undetermined; give its position at another crank angle (assembled_at), or "
                "slightly off the line",
                element=pending.joint,
                crank_angle=self.assembled_at,
            )
        # A machine of a batch whose side is not known has no answer, and shows it.
        signs = np.where(is_known, np.sign(side), np.nan)
        if (signs == signs[0]).all():
            self.parameters[pending.slot] = signs[0]
        else:
            self._change(pending.slot, signs)
        self.given_at[pending.slot] = self.assembled_at

    def _drawn(self, name: str) -> tuple[Floats, Floats]:
        """Where a joint is drawn, in every machine."""
        joint = self.program.mechanism.joints[name]
        x, y = (np.ravel(primal(place)) for place in (joint.x, joint.y))
        return x, y

    def _assembled(self, channel: _core.Channel) -> Floats:
        """What the core says of a point or a link where the mechanism is assembled, (numbers, machines)."""
        out = np.empty((self.values.shape[1], WIDTHS[type(channel)], 1))
        at = np.array([self.assembled_at])
        _core.motions(self.plan, self.parameters, self.slots, self.values, at, [channel], out)
        return out[:, :, 0].T

    # -- continuous angles -------------------------------------------------------------------------------

    def _continuous(self, angle: Continuous) -> None:
        """Turns a revolution of the crank, and the middle of the swing about them, in every machine."""
        looks = (2 * np.pi * np.arange(_CYCLE_MAX + 1)[:, None] + _UNEVEN).ravel()
        rows = self._directions(angle.link, looks)
        near = np.broadcast_to(np.ravel(primal(angle.near)), len(rows))
        windings = np.array([self._winding(angle, k, _cycle(row), near[k]) for k, row in enumerate(rows)])
        for slot, column in zip((angle.winding, angle.centre), windings.T, strict=True):
            if len(column) == 1 or (column == column[0]).all():
                if np.isfinite(column[0]):
                    self.parameters[slot] = column[0]
            else:
                self._change(slot, column)

    def _winding(self, angle: Continuous, k: int, cycle: int, near: float) -> tuple[float, float]:
        """Turns of a link per revolution of the crank, and the middle of its swing, in a machine; or NaN."""
        angles = np.linspace(0.0, 2 * np.pi * cycle, LOOK * cycle + 1)
        cos, sin = self._directions(angle.link, angles, k)[0]
        closes = np.isfinite(cos)
        if not closes.any():
            return np.nan, np.nan
        psi = np.unwrap(np.arctan2(sin[closes], cos[closes]))
        winding = 0.0
        if closes.all():
            turned = (psi[-1] - psi[0]) / (2 * np.pi)
            winding = (round(turned) if abs(turned - round(turned)) < _WHOLE else turned) / cycle
        rest = psi - winding * angles[closes]
        if np.ptp(rest) > _SWING_MAX and self.values.shape[1] > 1:
            # A machine of a batch that has no answer, and shows it.
            return np.nan, np.nan
        if np.ptp(rest) > _SWING_MAX:
            raise AssemblyError(
                f"the link {angle.name} swings by {np.degrees(np.ptp(rest)):.0f}° about its mean rotation; "
                "beyond 356° the position of a gear, a rack or a cable on it is ambiguous",
                element=angle.name,
            )
        turns = np.round((near - psi[0]) / (2 * np.pi))
        return winding, 0.5 * (rest.min() + rest.max()) + 2 * np.pi * turns

    def _directions(self, link: int, angles: Floats, row: int | None = None) -> Floats:
        """Cosine and sine of a link's angle in every mechanism, or in that of one row, (rows, 2, n)."""
        slots, values = self._mechanisms()
        values = values if row is None else np.ascontiguousarray(values[:, row : row + 1])
        out = np.empty((values.shape[1], WIDTHS[_core.Channel.Link], len(angles)))
        _core.motions(self.plan, self.parameters, slots, values, angles, [_core.Channel.Link(link)], out)
        return out[:, :2]

    # -- change points -----------------------------------------------------------------------------------

    def _fold(self, dyad: Foldable) -> None:
        """Finds the change points of a dyad in every machine, and gives it their series."""
        line = in_line(self.plan, self.parameters, *self._mechanisms(), dyad.element)
        if not any(line):
            return
        sides = np.broadcast_to(self._column(dyad.sign), len(line))
        signs = np.array(
            [self._sign(dyad, points, side) for points, side in zip(line, sides.tolist(), strict=True)]
        )
        for row, points in enumerate(line):
            at = undecided(points, signs[row])
            if at is not None and len(line) == 1:
                raise undecided_error(dyad.name, at)
            if at is not None:
                # A machine of a batch that has no answer, and shows it.
                line[row], signs[row] = [], np.nan
        self._give_change_points(dyad, line, signs)

    @property
    def motion_varies(self) -> bool:
        """Whether the mechanism varies from machine to machine."""
        return any(slot < self.program.n_own or slot >= self.n_described for slot in self.slots)

    def _mechanisms(self) -> tuple[Integers, Floats]:
        """What varies from one mechanism to the next: where masses and the like vary, nothing."""
        if self.motion_varies:
            return self.slots, self.values
        return np.empty(0, dtype=np.int32), np.empty((0, 1))

    def _sign(self, dyad: Foldable, points: list[_core.InLine], wanted: float) -> float:
        """The side of a dyad, `wanted` at `given_at`, where the product of half-angle sines is positive."""
        given_at = self.given_at.get(dyad.sign, _JUST_AFTER)
        return float(
            wanted * np.sign(np.prod([np.sin((given_at - point.crank_angle) / 2) for point in points]))
        )

    def _column(self, slot: int) -> Floats:
        """A parameter in all machines, or the one that they have in common."""
        varied = np.flatnonzero(self.slots == slot)
        return self.values[varied[0]] if len(varied) else self.parameters[slot : slot + 1]

    def _give_change_points(self, dyad: Foldable, lines: list[list[_core.InLine]], signs: Floats) -> None:
        """Turns a dyad into one with change points."""
        change_points, numbers = stored(lines, len(self.parameters))
        self.program.elements[dyad.element] = folding(self.program.elements[dyad.element], change_points)
        self._add(numbers)
        self._change(dyad.sign, signs)
        self.odd = self.odd | np.array([len(points) % 2 == 1 for points in lines])
        self._changed(self.make_plan())

    def _add(self, columns: Floats) -> None:
        """Appends parameters, a row of values over the machines for each."""
        slots = np.arange(len(self.parameters), len(self.parameters) + len(columns), dtype=np.int32)
        self.program.parameters += columns[:, 0].tolist()
        self.parameters = np.concatenate([self.parameters, columns[:, 0]])
        if columns.shape[1] > 1:
            self.slots = np.concatenate([self.slots, slots])
            self.values = np.concatenate([self.values, columns])

    def _change(self, slot: int, column: Floats) -> None:
        """Sets a parameter that did not vary until now."""
        self.parameters[slot] = column[0]
        if len(column) > 1:
            # Places of joints are no parameters: where they alone vary nothing did until now.
            self.values = np.broadcast_to(self.values, (len(self.values), len(column)))
            self.slots = np.append(self.slots, np.int32(slot))
            self.values = np.concatenate([self.values, column[None]])

    # -- groups ------------------------------------------------------------------------------------------

    def _follow(self, pending: PendingGroup) -> None:
        """Follows a group over the revolution from where it is assembled."""
        near = np.array([place[0] for name in pending.names for place in self._drawn(name)])
        path = _core.follow_group(self.plan, self.parameters, pending.element, self.assembled_at, near)
        if path is None:
            names = " and ".join(pending.names)
            raise AssemblyError(
                f"the joints {names} do not close near their given places at crank angle "
                f"{np.degrees(self.assembled_at):.6g}°; give places from a drawing of that position, or "
                "change the lengths",
                element=pending.names[0],
                crank_angle=self.assembled_at,
            )
        phi, turns = path.crank_angle, path.turns
        span = float(phi[-1] - phi[0])
        cycle = float(turns or max(1, int(np.ceil(span / (2 * np.pi) + _WHOLE))))
        # The last angle of a motion that repeats is the first again.
        knots = (phi / cycle).tolist()
        self.parameters[pending.inverse_turns] = 1.0 / cycle
        starts = [table(knots, place) for joint in zip(path.x, path.y, strict=True) for place in joint]
        self._start_group(pending, starts, repeats=turns is not None)
        self._require_one_place(pending)
        if self.values.shape[1] > 1:
            self._compare_groups(pending, near, starts, repeats=turns is not None)

    def _start_group(self, pending: PendingGroup, starts: list[_core.Table], *, repeats: bool) -> None:
        """Goes on with a group whose closure starts from tables over its cycle."""
        group = self.program.elements[pending.element]
        assert isinstance(group, _core.Element.Group)
        self.program.elements[pending.element] = _core.Element.Group(
            dyad=group.dyad,
            unknowns=group.unknowns,
            bar_points=group.bar_points,
            bars=group.bars,
            conditions=group.conditions,
            starts=starts,
            inverse_turns=group.inverse_turns,
            repeats=repeats,
        )
        self._changed(self.make_plan())

    def _compare_groups(
        self, pending: PendingGroup, near: Floats, starts: list[_core.Table], *, repeats: bool
    ) -> None:
        """Refuse machines that are assembled otherwise than the first, from whose motion all start."""
        followed = self._group_places(pending)
        self._start_group(pending, [table([0.0, 1.0], [place, place]) for place in near], repeats=repeats)
        alone = self._group_places(pending)
        self._start_group(pending, starts, repeats=repeats)
        lost = np.isnan(alone).any(axis=0)
        # A NaN is not below the limit: from the motion of the first no way may lead there.
        apart = ~lost & ~(np.abs(followed - alone).max(axis=0) <= _SAME_PLACE * np.abs(near).max())
        if apart.any():
            row = int(np.argmax(apart))
            raise InputError(
                f"row {row}: the joints {' and '.join(pending.names)} have another assembly mode than in "
                "the first machine; compute such machines one by one"
            )
        if lost.any():
            self._change(
                pending.inverse_turns, np.where(lost, np.nan, self.parameters[pending.inverse_turns])
            )

    def _require_one_place(self, pending: PendingGroup) -> None:
        """Refuse places that vary: they decide how a machine is assembled, which a batch has in common."""
        for name in pending.names:
            if any((place != place[0]).any() for place in self._drawn(name)):
                raise InputError(
                    f"mechanism.joints.{name}: its position selects the assembly mode; compute machines "
                    "that differ in it one by one"
                )

    def _group_places(self, pending: PendingGroup) -> Floats:
        """Where the joints of a group are when it is assembled, (2 joints, machines)."""
        points = [self.program.points[name] for name in pending.names]
        return np.concatenate([self._assembled(_core.Channel.Point(point))[:2] for point in points])

    # -- redundant bars ----------------------------------------------------------------------------------

    def _check_redundant(self) -> None:
        """A redundant bar must fit at every angle; of a batch, in the first machine."""
        mechanism = self.program.mechanism
        for name, bar in mechanism.bars.items():
            if bar.redundant:
                ends = self.program.points[bar.start], self.program.points[bar.end]
                self._check_fit(name, *ends, _first(bar.length))

    def _check_fit(self, name: str, start: int, end: int, length: float) -> None:
        looks = (2 * np.pi * np.arange(_CYCLE_MAX + 1)[:, None] + _UNEVEN).ravel()
        cycle = _cycle((self._place(end, looks) - self._place(start, looks)) / length)
        angles = np.linspace(0.0, 2 * np.pi * cycle, LOOK * cycle + 1)
        u = self._place(end, angles) - self._place(start, angles)
        off = np.abs(np.hypot(*u) - length)
        off = np.where(np.isfinite(off), off, 0.0)
        worst = int(off.argmax())
        if off[worst] > _FITS * length:
            raise AssemblyError(
                f"the redundant bar {name} ({length:g} m) does not fit: at crank angle "
                f"{np.degrees(angles[worst]):.4g}° the distance of its ends differs by {off[worst]:.3g} m "
                "from its length, so the mechanism is locked; correct the length or remove the bar",
                element=name,
                crank_angle=float(angles[worst]),
            )


def _cycle(directions: Floats) -> int:
    """Revolutions after which directions (2, n) are the same at `_UNEVEN` angles again; 1 if none are."""
    turns = np.nan_to_num(directions).reshape(2, _CYCLE_MAX + 1, -1)
    same = np.flatnonzero(np.abs(turns[:, 1:] - turns[:, :1]).max(axis=(0, 2)) <= _REPEATS)
    return int(same[0]) + 1 if len(same) else 1


def _first(value: Any) -> float:
    """A number; of an array over many machines, that of the first."""
    return float(np.ravel(primal(value))[0])
