r"""Derivatives of what is known of a cam by the numbers of its description: sizes, sections and their laws.

The law is worked out a second time with tangents, and with it the contact where a quantity is largest:

.. math:: \frac{\mathrm d}{\mathrm dp} \max_\theta f = \left.\frac{\partial f}{\partial p}\right|_{\theta^*}

at a fixed angle inside a piece, along the joint where the extreme sits on one (envelope theorem). Where two
extremes tie and follow an entry differently, there are only one-sided derivatives.

The angles of the sections add to a revolution and their lifts to zero: by the entry of one section alone, the
others give way in proportion to their sizes. A change of several entries that keeps both sums has the
derivative that the sum of theirs says.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np

from linkwright.cam.core import CamKernel
from linkwright.cam.laws.motion_law import MotionLaw, Side
from linkwright.cam.model.cam import Cam
from linkwright.cam.profile.contact import Contact, contacts, opposite
from linkwright.cam.profile.profile import CamProfile, cam_profile, in_time, radius_beside, unit_in
from linkwright.kernel.arrays import Bools, Floats
from linkwright.kernel.numerics.extreme import TIE_OF_SOLVED, apart, degrees
from linkwright.kernel.numerics.tangent import Tangent, lifted, primal, variables_of
from linkwright.kernel.quantities import shown
from linkwright.machine.address import get
from linkwright.machine.machine import Machine
from linkwright.machine.tangents import Derivatives, followed, scalars_of

# Their places are looked for.
_TIE = TIE_OF_SOLVED

# Angles in a piece of the law at which a curve is looked at; the shortest pieces still show their extremes.
_LOOK = 90

# How far a rival may seem to stay below the extreme before it is looked at more closely, as a share of the
# range: far more than the angles above leave.
_DOUBT = 1e-2

# Places of a level curve whose derivatives are compared.
_COMPARED = 24

# Rounds of Newton's method for the place of an extreme, and share of the interval for the bend there.
_ROUNDS, _ASIDE = 8, 1e-3

# Share of the interval by which it keeps off its ends: far less than the bend's.
_OFF_JOINT = 1e-6

# An angle this near to a joint [rad] is the joint; joints are good to rounding.
_AT_JOINT = 1e-11

_PLACE = "only the extreme value is differentiated, not its location"


def cam_tangents(machine: Machine, name: str, variables: Sequence[str]) -> Derivatives:
    """Scalars of a cam by some entries of its machine. Raises what `cam_profile` raises."""
    profile = cam_profile(machine, name)
    refused: dict[str, str] = {}
    ties: dict[str, str] = {}
    # Only these have a part in the profile; the others leave it as it is.
    own: Sequence[str] = [entry for entry in variables if entry.startswith(("mechanism.", "drive."))]

    # What cannot be followed is found on the way to the contacts, which takes little.
    own, _ = followed(machine, own, lambda along: _touching(along, name)[0].start, refused)
    scale = np.array([abs(float(get(machine, entry))) or 1.0 for entry in own])

    def scalars(along: Machine) -> dict[str, Any]:
        of_cam = _Scalars(along, profile, ties, scale)
        return {key: of_cam.of(key) for key in _SCALARS if getattr(profile, key) is not None}

    known, numbers = followed(machine, own, scalars, refused)
    listed = tuple(entry for entry in variables if entry not in refused)
    tangents = scalars_of(profile, numbers, known, listed)
    missing = {key: _PLACE for key in _PLACES if getattr(profile, key) is not None}
    cam = machine.mechanism.cams[profile.name]
    units = {key: unit_in(shown(CamProfile, key).unit, cam) for key in tangents}
    return Derivatives(listed, tangents, dict(ties), missing, refused, units=units)


_PLACES = ("pressure_angle_max_angle", "curvature_radius_min_angle")

_SCALARS = (
    *("stroke", "velocity_max", "acceleration_max", "jerk_max", "speed_constant"),
    *("base_radius", "prime_radius", "pressure_angle_max"),
    *("curvature_radius_min", "curvature_radius_convex_min", "curvature_radius_concave_min"),
    *("diameter_min", "diameter_max", "face_min", "face_max", "speed"),
)


def _touching(machine: Machine, name: str) -> tuple[Contact, ...]:
    """The contacts of a cam."""
    mechanism = machine.mechanism
    return contacts(mechanism.cams[name], mechanism.fixed_points(), name)


@dataclass(frozen=True)
class _Curve:
    """A quantity over the cam angle, on either side of joints, that is looked at for its maximum.

    `of`: angles, fixed or moving, and side → its values with derivatives; `law`: whose joints it has;
    `plain`, `plain_law`: the same of the cam without tangents. Their joints are one by one those of the law,
    but for rounding.
    """

    of: Callable[[Any, Side], Any]
    law: MotionLaw
    plain: Callable[[Any, Side], Any]
    plain_law: MotionLaw

    def looked_at(self) -> tuple[Floats, Bools, Floats]:
        """Angles in every piece, its ends from inside, which are from before, and the values there."""
        breaks = self.plain_law.breaks
        angles = np.concatenate([np.linspace(*ends, _LOOK + 1) for ends in pairwise(breaks)])
        before = np.tile(np.arange(_LOOK + 1) == _LOOK, len(breaks) - 1)
        values = np.empty(len(angles))
        values[~before] = self.plain(angles[~before], "after")
        values[before] = self.plain(angles[before], "before")
        return angles, before, values

    def slope(self, angles: Floats) -> Floats:
        """Derivative by the cam angle inside the pieces."""
        value = self.plain(Tangent(angles, np.ones((len(angles), 1))), "after")
        slope: Floats = value.d[:, 0]
        return slope

    def tangent(self, angle: float, side: Side) -> Tangent:
        """The value at an angle with its derivatives; at a joint along with it."""
        joints = np.array(self.plain_law.breaks)
        k = int(np.argmin(np.abs(joints - angle)))
        place = self.law.breaks[k] if abs(joints[k] - angle) < _AT_JOINT else angle
        n = variables_of((place,)) or self.law.variables or 1
        return lifted(self.of(lifted(place, n).reshape(1), side), n)[0]


class _Scalars:
    """The scalars of a cam that is described with tangents; places of extremes are those of its profile."""

    def __init__(self, machine: Machine, profile: CamProfile, ties: dict[str, str], scale: Floats) -> None:
        self.cam: Cam = machine.mechanism.cams[profile.name]
        self.touching = _touching(machine, profile.name)
        self.profile, self.ties, self.scale = profile, ties, scale
        self.design_speed: Any = machine.design_speed

    def of(self, name: str) -> Any:
        """A scalar of the profile by its name."""
        sizes = self.touching[0].sizes
        match name:
            case "speed":
                return self.design_speed
            case "base_radius":
                return sizes.base_radius
            case "prime_radius":
                return sizes.base_radius + sizes.roller_radius
            case "stroke":
                # Both ends of it are dwells or turning points of the programme.
                lift = self._of_law(self.cam.lift, 0)
                return sum(self._greatest(name, lift, sign) for sign in (-1.0, 1.0))
            case "velocity_max" | "acceleration_max" | "jerk_max":
                order = 1 + ("velocity_max", "acceleration_max", "jerk_max").index(name)
                peak = self._largest_in_size(name, [self._of_law(self.cam.lift, order)])
                return in_time(peak, order, self.design_speed)
            case "speed_constant":
                slopes = [abs(slope) for slope in self.cam.motion.steady_velocities]
                slopes.sort(key=lambda slope: -float(primal(slope)))
                self._compare(name, slopes, "the velocities of two sections")
                return in_time(slopes[0], 1, self.design_speed)
            case "pressure_angle_max":
                curves = [self._of_contact(k, "pressure_angle") for k in range(len(self.touching))]
                return self._largest_in_size(name, curves)
            case "diameter_min" | "diameter_max":
                diameter = opposite(self.cam, self.touching[0]).diameter
                return self._end(name, self._of_law(diameter, 0))
            case "face_min" | "face_max":
                return self._end(name, self._of_contact(0, "along"))
        return self._radius(name)

    def _radius(self, name: str) -> Any:
        """Minimum radius of curvature of the profile of its convex parts, its concave ones, or both."""
        convex, concave = self.profile.curvature_radius_convex_min, self.profile.curvature_radius_concave_min
        is_convex = name == "curvature_radius_convex_min"
        if name == "curvature_radius_min":
            is_convex = convex is not None and (concave is None or convex <= concave)
            if convex is not None and concave is not None and abs(convex - concave) <= _TIE * abs(convex):
                self.ties[name] = "a convex and a concave part have the same radius"
        if not self.cam.is_roller:
            return -self._greatest(name, self._of_contact(0, "bend"), -1.0)
        sign, radii = (1.0 if is_convex else -1.0), []
        for k, contact in enumerate(self.touching):
            # Curvature is largest where the radius is smallest; behind an inflection it has the other sign.
            bend = self._greatest(name, self._of_contact(k, "bend"), sign)
            if primal(bend) > 0:
                radii.append(radius_beside(sign * bend, contact.sizes.roller_radius, sign))
        radii.sort(key=lambda radius: float(primal(radius)))
        self._compare(name, radii, "the radii at both contacts")
        return radii[0]

    # -- curves and their extremes -----------------------------------------------------------------------

    def _of_law(self, law: MotionLaw, order: int) -> _Curve:
        both = [(lambda phi, side, law=law: law.at(phi, order, side), law) for law in (law, law.primal)]
        return _Curve(*both[0], *both[1])

    def _of_contact(self, k: int, row: str) -> _Curve:
        touching = (self.touching[k], self.profile.flanks[k].contact)
        both = [(partial(_row, contact.kernel, row), contact.law) for contact in touching]
        return _Curve(*both[0], *both[1])

    def _largest_in_size(self, name: str, curves: Sequence[_Curve]) -> Any:
        """The extreme of curves that is largest in size, positive."""
        ends = [self._extreme(curve, sign) for curve in curves for sign in (1.0, -1.0)]
        ends.sort(key=lambda end: -float(primal(end[0])))
        if ends[0][1]:
            self.ties[name] = ends[0][1]
        self._compare(name, [value for value, _ in ends], "two peaks, of either sign or contact,")
        return ends[0][0]

    def _end(self, name: str, curve: _Curve) -> Any:
        """The minimum or maximum of a curve, as the name says."""
        sign = 1.0 if name.endswith("_max") else -1.0
        return sign * self._greatest(name, curve, sign)

    def _greatest(self, name: str, curve: _Curve, sign: float) -> Any:
        """The maximum of sign times a curve with its derivatives; a tie is listed under a name."""
        value, tie = self._extreme(curve, sign)
        self.ties |= {name: tie} if tie else {}
        return value

    def _extreme(self, curve: _Curve, sign: float) -> tuple[Any, str]:
        """The maximum of sign times a curve with its derivatives, and where else it is reached, in words."""
        places = _peaks(curve, sign)
        first = sign * curve.tangent(*places[0])
        size = float(np.abs(curve.looked_at()[2]).max())
        for phi, side in places[1:]:
            if self._differ(first, sign * curve.tangent(phi, side), size):
                both = " and ".join(map(degrees, (places[0][0], phi)))
                return first, f"the extreme occurs at cam angles θ = {both}"
        return first, ""

    def _compare(self, name: str, extremes: Sequence[Any], what: str) -> None:
        """A tie of the first of some extremes, which counts, with another one."""
        top = float(primal(extremes[0]))
        rivals = [other for other in extremes[1:] if abs(float(primal(other)) - top) <= _TIE * abs(top)]
        if any(self._differ(extremes[0], other, abs(top)) for other in rivals):
            self.ties[name] = f"{what} are equal"

    def _differ(self, one: Any, other: Any, size: float) -> bool:
        """Whether two extremes of a curve of some size follow an entry differently."""
        d, e = (x.d if isinstance(x, Tangent) else np.zeros(1) for x in (one, other))
        scale = self.scale if max(len(d), len(e)) == len(self.scale) else 1.0
        return bool(apart(np.stack(np.broadcast_arrays(d, e)), size / scale).any())


def _row(kernel: CamKernel, name: str, phi: Any, side: Side) -> Any:
    """A row of a contact at angles."""
    return kernel.rows(phi, before=side == "before")[name]


def _peaks(curve: _Curve, sign: float) -> list[tuple[float, Side]]:
    """Places where sign times a curve is largest, the largest first, and those where it is as large."""
    angles, before, values = curve.looked_at()
    values = sign * values
    span, top = float(np.ptp(values)), float(values.max())
    places: list[tuple[float, float, Side]] = []
    for i in np.flatnonzero(values >= top - _DOUBT * span):
        near = [k for k in (i - 1, i + 1) if 0 <= k < len(values) and angles[k] != angles[i]]
        if any(values[k] > values[i] for k in near):
            continue
        side: Side = "before" if before[i] else "after"
        places.append((float(values[i]), float(angles[i]), side))
        if any(values[k] < values[i] for k in near):
            # Beside a joint the curve may rise further before it falls to the next angle.
            ends = sorted(float(angles[k]) for k in (*near, i))
            place = _inside(curve, ends[0], ends[-1], float(angles[i]))
            places.append((sign * float(curve.plain(np.array([place]), "after")[0]), place, "after"))
    top = max(value for value, _, _ in places)
    high = [place for place in places if place[0] >= top - _TIE * span]
    high.sort(key=lambda place: (-place[0], place[1]))
    # Of a curve that is level some places stand for all.
    level = high[1 :: max(1, len(high) // _COMPARED)]
    return [(angle, side) for _, angle, side in (high[0], *level)]


def _inside(curve: _Curve, low: float, high: float, start: float) -> float:
    """Where the slope of a curve is zero between two angles of a piece, by Newton's method."""
    aside = _ASIDE * (high - low)
    # At a joint the slope is that of the next piece.
    low, high = low + _OFF_JOINT * (high - low), high - _OFF_JOINT * (high - low)
    angle = float(np.clip(start, low, high))
    for _ in range(_ROUNDS):
        around = np.clip([angle - aside, angle, angle + aside], low, high)
        slopes = curve.slope(around)
        bend = (slopes[2] - slopes[0]) / (around[2] - around[0])
        if bend == 0.0 or not np.isfinite(bend):
            break
        angle = float(np.clip(angle - slopes[1] / bend, low, high))
    return angle
