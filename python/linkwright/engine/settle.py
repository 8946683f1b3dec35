"""What has to be known of a mechanism's motion before it can be computed at any angle.

| pending | is settled by |
| --- | --- |
| side of a joint given by its place | where that lies when the mechanism is assembled |
| continuous angle of a link | its turns in a turn of the crank, and the middle of its swing about them |
| change points of a dyad | the radicand's zeros, found exactly, and its series there |
| start of a group | its motion, followed step by step over the turn |

They are settled in build order, each with what stands before it.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright import _core
from linkwright.engine.driver_law import require_smooth
from linkwright.engine.elements import Continuous, Foldable, Pending, Rows, Side, Solved
from linkwright.errors import AssemblyError

Floats = NDArray[np.float64]

# Angles of a look at a radicand or a link over the turn.
_LOOK = 720

# A radicand above this share of its greatest at all those angles has no zero between them: a parabola that
# touches zero is below a hundred-thousandth at the nearest.
_NEAR_ZERO = 1e-3

# Largest swing of a link about its mean turning that leaves its angle unambiguous, in radians.
_SWING_MAX = 1.98 * np.pi

# Farthest from a change point that its series is used [rad]: there the direct root has lost some 1/δ² = 1e3
# of its digits in its slope. Nearer, where its last terms would be more than this share of the first.
_REACH = 0.03
_LAST_TERM = 1e-15

# Angles between two of the look, and the distance over the length of the links at which pin and pivot meet.
_FINE = 401
_MEETS = 1e-4

# A joint's place this near to the line of its bars, over their length, says nothing of its side.
_IN_LINE = 1e-9

# A whole number of turns is one to this.
_WHOLE = 1e-6

# Difference in length of a redundant bar, over its length, that counts as rounding.
_FITS = 1e-9


class Settled:
    """Rows, tables and numbers of a mechanism with everything pending filled in."""

    def __init__(
        self, rows: Rows, parameters: Floats, plan: Callable[[], _core.Plan], assembled_at: float
    ) -> None:
        self.rows = rows
        self.parameters = parameters
        self.make_plan = plan
        self.assembled_at = assembled_at
        self.plan = plan()
        # Radicands over the turn, as long as nothing has changed since.
        self.gaps: Floats | None = None

    def run(self) -> None:
        """Settles all that is pending, in build order.

        Raises
        ------
        AssemblyError
            A law cannot be followed, a group does not close where it is assembled, a link turns irregularly,
            or a redundant bar does not fit.
        """
        self._check_laws()
        for each in self.rows.pending:
            self._settle(each)
        self._check_redundant()

    def _settle(self, each: Pending) -> None:
        match each:
            case Side():
                self._side(each)
            case Continuous():
                self._continuous(each)
            case Foldable():
                self._fold(each)
            case Solved():
                self._follow(each)

    def _check_laws(self) -> None:
        """A driver's law must have a value everywhere, and no jump."""
        mechanism = self.rows.mechanism
        laws = {name: crank.law for name, crank in mechanism.cranks.items()}
        laws |= {name: driver.law for name, driver in mechanism.linear_drivers.items()}
        for name, law in laws.items():
            if law is not None:
                require_smooth(name, law, partial(self._law, self.rows.slides[f"{name}.law"]))

    def _law(self, slide: int, angles: Floats) -> Floats:
        """Value and slope of a law, (2, n)."""
        return self._motion(2, slide, angles)[:2]

    def _changed(self, plan: _core.Plan) -> None:
        """Goes on with another plan."""
        self.plan, self.gaps = plan, None

    def _motion(self, kind: int, index: int, angles: Floats) -> Floats:
        """Numbers of a point (6), link (4) or slide (3) at crank angles."""
        width = (6, 4, 3)[kind]
        out = np.empty((width, len(angles)))
        what = np.array([[kind, index]], dtype=np.int32)
        none = np.empty(0, dtype=np.int32)
        _core.motions(self.plan, self.parameters, none, np.empty((0, 1)), angles, what, out.reshape(-1))
        return out

    # -- sides -------------------------------------------------------------------------------------------

    def _side(self, each: Side) -> None:
        """Left of the line from pin to pivot, or ahead along the guide."""
        at = np.array([self.assembled_at])
        joint = self.rows.mechanism.joints[each.joint]
        x, y = self._motion(0, each.pin, at)[:2, 0]
        to = np.array([_first(joint.x) - x, _first(joint.y) - y])
        if each.pivot is not None:
            u, v = self._motion(0, each.pivot, at)[:2, 0] - (x, y)
            side = (u * to[1] - v * to[0]) / max(np.hypot(u, v), 1e-300)
        else:
            assert each.guide is not None
            link, angle = each.guide
            cos, sin = (1.0, 0.0) if link == self.rows.frame else self._motion(1, link, at)[:2, 0]
            direction = np.array(
                [cos * np.cos(angle) - sin * np.sin(angle), sin * np.cos(angle) + cos * np.sin(angle)]
            )
            side = float(direction @ to)
        if abs(side) <= _IN_LINE * float(np.hypot(*to)):
            raise AssemblyError(
                f"the joint {each.joint} is given in line with what holds it, so its side is not known; give "
                "its place at another crank angle (assembled_at), or a little aside",
                element=each.joint,
                crank_angle=self.assembled_at,
            )
        self.parameters[each.slot] = 1.0 if side > 0 else -1.0
        self.gaps = None

    # -- continuous angles -------------------------------------------------------------------------------

    def _continuous(self, each: Continuous) -> None:
        """Turns a turn of the crank, and the middle of the swing about them."""
        angles = np.linspace(0.0, 2 * np.pi, _LOOK + 1)
        cos, sin, *_ = self._motion(1, each.link, angles)
        closes = np.isfinite(cos)
        if not closes.any():
            return
        psi = np.unwrap(np.arctan2(sin[closes], cos[closes]))
        at = angles[closes]
        winding = 0.0
        if closes.all():
            winding = (psi[-1] - psi[0]) / (2 * np.pi)
            winding = round(winding) if abs(winding - round(winding)) < _WHOLE else winding
        rest = psi - winding * at
        if np.ptp(rest) > _SWING_MAX:
            raise AssemblyError(
                f"the link {each.name} swings by {np.degrees(np.ptp(rest)):.0f}° about its mean turning; "
                "a gear, a rack or a cable on it has no unambiguous place beyond 356°",
                element=each.name,
            )
        near = _first(each.near)
        turns = np.round((near - psi[0]) / (2 * np.pi))
        self.parameters[each.winding] = winding
        self.parameters[each.centre] = 0.5 * (rest.min() + rest.max()) + 2 * np.pi * turns
        self.gaps = None

    # -- change points -----------------------------------------------------------------------------------

    def _fold(self, each: Foldable) -> None:
        """Finds the change points of a dyad, and gives its row their series."""
        if any(slot < self.rows.n_own for slot in self.rows.varying):
            # Rows of a batch have their change points elsewhere, and most have none.
            return
        angles = np.linspace(0.0, 2 * np.pi, _LOOK + 1)[:-1]
        if self.gaps is None:
            self.gaps = _core.gaps(self.plan, self.parameters, angles)
        gaps = self.gaps[each.gap]
        size = np.abs(gaps).max()
        if np.isnan(size):
            size = np.nanmax(np.abs(gaps)) if np.isfinite(gaps).any() else 0.0
        elif gaps.min() > _NEAR_ZERO * size:
            return
        lowest = (gaps <= np.roll(gaps, 1)) & (gaps <= np.roll(gaps, -1)) & (np.abs(gaps) < _NEAR_ZERO * size)
        element = sum(row[0] != 0 for row in self.rows.rows[: each.row])
        found: dict[float, list[float]] = {}
        for near in angles[lowest]:
            if self._coincide(self.rows.rows[each.row], float(near)):
                # The direction from pin to pivot is lost there: no series carries the motion on.
                return
            point = _core.change_point(self.plan, self.parameters, element, float(near))
            if point is not None and not any(_turns_apart(point[0], other) < _WHOLE for other in found):
                found[point[0]] = point[1]
        if found:
            self._give_change_points(each, found)

    def _coincide(self, row: list[int], near: float) -> bool:
        """Whether the pin of a dyad RRR passes over its pivot about an angle of the look."""
        if row[0] != 3:
            return False
        angles = near + np.linspace(-1.0, 1.0, _FINE) * 2 * np.pi / _LOOK
        u = self._motion(0, row[5], angles)[:2] - self._motion(0, row[6], angles)[:2]
        lengths = self.parameters[row[7]] + self.parameters[row[8]]
        return bool(np.hypot(*u).min() < _MEETS * lengths)

    def _give_change_points(self, each: Foldable, found: dict[float, list[float]]) -> None:
        """Turns the row of a dyad into one with change points.

        The given side is that at small positive crank angles.
        """
        at = np.array(sorted(found))
        just_after = 1e-7
        # A side that varies from row to row does not exist.
        wanted = self.parameters[each.sign]
        sign = wanted * np.sign(np.prod(np.sin((just_after - at) / 2)))
        self.parameters[each.sign] = sign
        row = [*_folding_row(self.rows.rows[each.row], self.rows.frame), len(at)]
        numbers: list[float] = []
        for phi in at:
            angles = (np.cos(phi), np.sin(phi), np.cos(phi / 2), np.sin(phi / 2))
            numbers += [*angles, _reach(np.array(found[phi])), *found[phi]]
        row += list(range(len(self.parameters), len(self.parameters) + len(numbers)))
        self.parameters = np.concatenate([self.parameters, numbers])
        self.rows.parameters += numbers
        self.rows.rows[each.row] = row
        self._changed(self.make_plan())

    # -- groups ------------------------------------------------------------------------------------------

    def _follow(self, each: Solved) -> None:
        """Follows a group over the turn from where it is assembled."""
        element = sum(row[0] != 0 for row in self.rows.rows[: each.row])
        joints = [self.rows.mechanism.joints[name] for name in each.names]
        near = np.array([_first(value) for joint in joints for value in (joint.x, joint.y)])
        path = _core.follow_group(self.plan, self.parameters, element, self.assembled_at, near)
        if path is None:
            names = " and ".join(each.names)
            raise AssemblyError(
                f"the joints {names} do not close near their given places at crank angle "
                f"{np.degrees(self.assembled_at):.6g}°; give places from a drawing of that position, or "
                "change the lengths",
                element=each.names[0],
                crank_angle=self.assembled_at,
            )
        phi, places, turns = path
        span = float(phi[-1] - phi[0])
        cycle = float(turns or max(1, int(np.ceil(span / (2 * np.pi) + _WHOLE))))
        # The last angle of a motion that repeats is the first again.
        for table, place in zip(each.tables, places, strict=True):
            self.rows.tables[table] = (list(phi / cycle), list(place))
        self.parameters[each.inverse_turns] = 1.0 / cycle
        self.rows.rows[each.row][3] = int(turns is not None)
        self._changed(self.make_plan())

    # -- redundant bars ----------------------------------------------------------------------------------

    def _check_redundant(self) -> None:
        """A redundant bar must fit at every angle; of a batch, in the first machine."""
        mechanism = self.rows.mechanism
        for name, bar in mechanism.bars.items():
            if bar.redundant:
                ends = self.rows.points[bar.start], self.rows.points[bar.end]
                self._check_fit(name, *ends, _first(bar.length))

    def _check_fit(self, name: str, start: int, end: int, length: float) -> None:
        angles = np.linspace(0.0, 2 * np.pi, _LOOK + 1)
        u = self._motion(0, end, angles)[:2] - self._motion(0, start, angles)[:2]
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


def _reach(series: Floats) -> float:
    """How far from a change point its series is used [rad]: as far as its last terms are rounding."""
    last = np.arange(len(series) - 3, len(series))
    share = _LAST_TERM * abs(series[0]) / np.maximum(np.abs(series[last]), 1e-300)
    return float(min(_REACH, (share ** (1.0 / last)).min()))


def _first(value: Any) -> float:
    """A number; of an array over many machines, that of the first."""
    return float(np.ravel(value)[0])


def _folding_row(row: list[int], frame: int) -> list[int]:
    """The row of a dyad as one with change points; a rod on a fixed guide becomes one on any guide."""
    kind, *entries = row
    if kind == 3:
        return [11, *entries]
    if kind == 5:
        return [15, *entries]
    point, link, slide, gap, pin, through, rod, inverse, offset, cos, sin, sign = entries
    return [15, point, link, slide, gap, pin, through, frame, cos, sin, offset, rod, inverse, sign]


def _turns_apart(a: float, b: float) -> float:
    """Distance of two angles on the circle [rad]."""
    return abs((a - b + np.pi) % (2 * np.pi) - np.pi)
