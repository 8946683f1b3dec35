r"""Derivatives of the rotator of a rod string: lengths, swing, transfer functions, days, force in the link.

The lever's angle is a function of the beam's alone. Diagonal, swing and the way of the worm lie between
places of the stroke, at its ends or where the lever turns back, and have the derivative of the curve there
(envelope theorem). The transfer function is that of the beam times the slope

.. math:: \frac{\mathrm d\varphi_5}{\mathrm d\varphi_3} = \pm\lambda' + \frac{s\,c'}{\sin\gamma},
    \qquad c = \cos\gamma = \frac{l_d^2 + l_5^2 - l_4^2}{2\,l_d\,l_5},

with λ the lean of the diagonal and s the side of the joint. At a change point it is 0/0 with a limit: the
curve is smooth there, and so are its derivatives, which are read between angles around it.

The clutch takes the lever along at every place of the beam either on the way up or on the way down, and the
arm of the link depends on the diagonal alone: its force is largest at an extreme of the diagonal.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.numerics.tangent import Tangent
from linkwright.kernel.numerics.tangent_array import TangentArray, lifted, primal
from linkwright.kernel.numerics.turn_fit import turn_curve
from linkwright.machine.machine import Machine
from linkwright.machine.tangents import CHANGE_POINTS, Derivatives, directions, followed
from linkwright.pumping.gradient import RodAlong
from linkwright.pumping.lever import Lever
from linkwright.pumping.model.rod_rotator import RodRotator, diagonal
from linkwright.pumping.model.rotator_lengths import (
    Lengths,
    LeverStroke,
    lengths,
    turning_shares,
    zeros_of_stroke,
)
from linkwright.pumping.model.unit import PumpingUnit
from linkwright.pumping.rod_rotator import DAY, RodRotatorMotion, rod_rotator
from linkwright.pumping.unit import PolishedRod

_UNIT, _ROTATOR = "pumping_unit.", "rod_rotator."

# Extremes this near, as a share of the peak, tie.
_TIE = 1e-10

# Derivatives of an entry that differ by less than this share of the largest do not differ.
_SAME = 1e-8

# Places of a tie closer than this are one [rad].
_APART = 1e-2

# Distance from a change point [rad] within which derivatives are read between angles around it, and how many
# angles: the transfer function of a lever bends within a radian.
_NEAR, _NODES = 0.06, 12

_WHOLE = "it is a whole number of revolutions"
_NO_ARM = "the link loses its arm where it comes into line with the lever"


def rotator_tangents(machine: Machine, variables: Sequence[str]) -> Derivatives:
    """Scalars of a rotator by some entries. Raises what `rod_rotator` raises."""
    result = rod_rotator(machine, n=8)
    assert machine.pumping_unit is not None
    assert machine.rod_rotator is not None
    rod = PolishedRod.of(machine, machine.pumping_unit)
    lever = Lever.of(machine, machine.pumping_unit, machine.rod_rotator)
    own = [name for name in variables if name.startswith((_UNIT, _ROTATOR))]
    program = directions(rod.machine, [name for name in own if name.startswith(_UNIT)])
    refused = dict(program.refused)
    if result.change_points and machine.rod_rotator.link_length is not None:
        refused |= dict.fromkeys(_of_lengths(own), CHANGE_POINTS)
    asked = [name for name in own if name not in refused]
    asked += [name for name in variables if name == "drive.speed"]
    known, parts = followed(machine, asked, _Parts.of, refused)
    values = np.zeros((len(program.values), len(known)))
    for k, name in enumerate(known):
        if name in program.variables:
            values[:, k] = program.values[:, program.variables.index(name)]
    still = _Parts.of(machine)
    scalars = _Scalars(still, parts, RodAlong.of_unit(rod, parts.unit, values), lever, result, known)
    listed = tuple(name for name in variables if name not in refused)
    numbers = scalars.all()

    def tangent(name: str, number: Any) -> Tangent:
        d = dict(zip(known, lifted(number, len(known)).d, strict=True))
        return Tangent(float(getattr(result, name)), np.array([d.get(v, 0.0) for v in listed]))

    tangents = {name: tangent(name, number) for name, number in numbers.items()}
    return Derivatives(listed, tangents, scalars.ties, _missing(result), refused)


def _missing(result: RodRotatorMotion) -> dict[str, str]:
    """Numbers without derivatives, with the reason."""
    missing = {"lever_turns_per_cycle": _WHOLE}
    if result.regime == "continuous":
        missing["worm_turns_per_cycle"] = _WHOLE
    if result.lever_turns_per_cycle:
        missing["lever_swing"] = "the lever rotates fully"
    if result.worm_torque is not None and result.link_force_max is None:
        missing["link_force_max"] = _NO_ARM
    return missing


# Entries of the rotator that do not move it.
_OF_WORM = tuple(f"{_ROTATOR}{key}" for key in ("worm_ratio", "worm_efficiency", "string_torque"))


def _of_lengths(names: Sequence[str]) -> list[str]:
    """Entries by which link and lever come to be in line, or not."""
    sizes = {f"{_UNIT}{key}" for key in (*"ACIPHGR", "cable")}
    return [name for name in names if name in sizes or (name.startswith(_ROTATOR) and name not in _OF_WORM)]


@dataclass(frozen=True)
class _Parts:
    """What a rotator is described by, with derivatives or without."""

    unit: PumpingUnit
    rotator: RodRotator
    lengths: Lengths  # l_4 and l_5 [m]
    speed: Any  # of the crank [rad/s], or None

    @classmethod
    def of(cls, machine: Machine) -> _Parts:
        """Those of a machine; raises where an entry cannot be followed."""
        unit, rotator = machine.pumping_unit, machine.rod_rotator
        assert unit is not None
        assert rotator is not None
        return cls(unit, rotator, lengths(unit, rotator), machine.drive.speed if machine.drive else None)

    @property
    def excess(self) -> Any:
        """l_4² − l_5² [m²]."""
        return self.lengths.link**2 - self.lengths.lever**2

    def stroke(self, shares: Any) -> LeverStroke:
        """Places of the stroke."""
        return LeverStroke.of(self.unit, self.rotator, shares)


@dataclass(frozen=True)
class _Scalars:
    """Scalars of a rotator with derivatives by some entries."""

    still: _Parts
    along: _Parts
    rod: RodAlong
    lever: Lever
    result: RodRotatorMotion
    entries: tuple[str, ...]
    ties: dict[str, str] = field(default_factory=dict)

    def all(self) -> dict[str, Any]:
        """Numbers by name."""
        rotator: Any = self.along.rotator
        result = self.result
        numbers = dict(zip(("link_length", "lever_length"), self.along.lengths, strict=True))
        numbers |= self._diagonal() | self._way()
        numbers |= {f"transfer_{end}": self._transfer(end, sign) for end, sign in (("min", -1), ("max", 1))}
        if result.string_turn_days is not None:
            cycle = 2 * np.pi / self.along.speed
            turns = numbers.get("worm_turns_per_cycle", result.worm_turns_per_cycle)
            days = rotator.worm_ratio / turns * cycle / DAY
            numbers |= {"string_turn_days": days, "string_turns_per_day": 1 / days}
        if result.worm_torque is not None:
            torque = rotator.string_torque / (rotator.worm_ratio * rotator.worm_efficiency)
            numbers["worm_torque"] = torque
            if result.link_force_max is not None:
                numbers["link_force_max"] = self._force(torque, numbers)
        return numbers

    # -- over the stroke ---------------------------------------------------------------------------------

    def _diagonal(self) -> dict[str, Any]:
        """Extremes of the distance from pin to hanger."""

        def slope(share: Floats) -> Floats:
            rate: Floats = self.still.stroke(TangentArray(share, np.ones((len(share), 1)))).distance.d[..., 0]
            return rate

        shares = zeros_of_stroke(slope)
        distance = self._array(self.along.stroke(shares).distance[0])
        return {
            f"diagonal_{end}": self._extreme(f"diagonal_{end}", distance, sign)
            for end, sign in (("min", -1), ("max", 1))
        }

    def _way(self) -> dict[str, Any]:
        """Range of the lever's angle, and revolutions of the worm."""
        if self.result.lever_turns_per_cycle:
            return {}
        still, along = self.still, self.along
        shares = turning_shares(still.unit, still.rotator, still.lengths.lever, still.excess)
        angle = self._array(along.stroke(shares).angle(along.lengths.lever, along.excess)[0])
        high, low = (self._extreme("lever_swing", angle, sign) for sign in (1, -1))
        if still.rotator.regime == "continuous":
            return {"lever_swing": high - low}
        # What goes forward in one stroke comes back in the other.
        turns: Any = np.abs(angle[1:] - angle[:-1]).sum() / (2 * np.pi)
        return {"lever_swing": high - low, "worm_turns_per_cycle": turns}

    def _force(self, torque: Any, numbers: dict[str, Any]) -> Any:
        """Maximum force in the link: at one end of the diagonal its arm l_5 sin(φ_4 − φ_5) is smallest."""
        link, lever = self.along.lengths
        distances = [numbers[f"diagonal_{end}"] for end in ("min", "max")]
        forces = [torque * link / (d * lever * _sine(d, link, lever)) for d in distances]
        row = self._array(np.stack([lifted(force, len(self.entries)) for force in forces]))
        return self._extreme("link_force_max", row, 1)

    # -- over the revolution -----------------------------------------------------------------------------

    def _transfer(self, end: str, sign: int) -> Any:
        """An extreme of the transfer function of the lever."""
        curve = turn_curve(
            lambda at: self.lever.motion(at).lever_d1[None], np.array([0.0, 2 * np.pi]), "motion"
        )
        angles: list[float] = []
        for angle in (curve.extreme(sign)[1], *curve.extremes(sign, 0, _TIE).tolist()):
            if all(abs(np.sin(0.5 * (angle - other))) > 0.5 * _APART for other in angles):
                angles.append(angle)
        rates = np.stack([self._rate_at(angle) for angle in angles])
        return self._extreme(f"transfer_{end}", self._array(rates), sign)

    def _rate_at(self, angle: float) -> Any:
        """The transfer function at a crank angle."""
        for change in self.result.change_points:
            if abs(np.sin(0.5 * (angle - change))) < 0.5 * _NEAR:
                off = (angle - change + np.pi) % (2 * np.pi) - np.pi
                nodes = 2 * _NEAR * np.polynomial.chebyshev.chebpts1(_NODES)
                rates = self._rates(change + nodes)
                return (rates * _lagrange(nodes, off)).sum()
        return self._rates(np.array([angle]))[0]

    def _rates(self, angles: Floats) -> Any:
        """The transfer function at crank angles off the change points."""
        unit, rotator, (link, lever) = self.along.unit, self.along.rotator, self.along.lengths
        rise, rise_d1, _ = self.rod.motion(angles)
        front = unit.front_angle(unit.psi_bottom) + rise / unit.A
        dx, dy = diagonal(unit, rotator, front)
        distance = np.hypot(dx, dy)
        lean = np.arctan2(dx, dy) * (-1.0 if unit.is_mirrored else 1.0)
        # +1 for a joint on the left of the diagonal, as drawn.
        side = np.sign(np.sin(0.5 * np.pi + primal(lean) - self.lever.motion(angles).lever))
        l_3 = rotator.pin_distance
        lean_d1 = (l_3 * np.sin(front) * dy + dx * dx) / distance**2 * (-1.0 if unit.is_mirrored else 1.0)
        distance_d1 = -dx * (dy - l_3 * np.sin(front)) / distance
        cosine_d1 = distance_d1 * (distance**2 + self.along.excess) / (2 * lever * distance**2)
        return (lean_d1 + side * cosine_d1 / _sine(distance, link, lever)) * (rise_d1 / unit.A)

    # -- what extremes have in common ---------------------------------------------------------------------

    def _array(self, x: Any) -> Any:
        return lifted(x, len(self.entries))

    def _extreme(self, name: str, row: Any, sign: int) -> Any:
        """The maximum (+1) or minimum (−1) of some values; NaN by entries that its rivals follow otherwise."""
        values = sign * row.value
        best = int(values.argmax())
        rivals = np.flatnonzero(values >= values[best] - _TIE * np.abs(values).max())
        d = row.d[rivals]
        differs = np.ptp(d, axis=0) > _SAME * np.abs(d).max(initial=0.0)
        if differs.any():
            by = ", ".join(entry for entry, yes in zip(self.entries, differs, strict=True) if yes)
            self.ties[name] = f"it is reached at {len(rivals)} places, with other derivatives by {by}"
        return TangentArray(row.value[best], np.where(differs, np.nan, row.d[best]))


def _sine(distance: Any, link: Any, lever: Any) -> Any:
    """sin γ between lever and diagonal, by the sides of their triangle: its differences vanish in line."""
    reach, apart = link + lever, link - lever
    product = (reach - distance) * (distance - apart) * (reach + distance) * (distance + apart)
    return np.sqrt(product) / (2 * distance * lever)


def _lagrange(nodes: Floats, at: float) -> Floats:
    """Weights of values at nodes in the polynomial through them, at a place."""
    others = [np.delete(nodes, k) for k in range(len(nodes))]
    return np.array([np.prod((at - o) / (x - o)) for x, o in zip(nodes, others, strict=True)])
